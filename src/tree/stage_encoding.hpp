// Description of a block's work in a stage, laid out as in the block's shared memory: one copy
// loads all of it.
#pragma once

#include <cstdint>
#include <vector>

#include "tree/stages.hpp"

namespace catena::dca {

/// Unit of a block's loads: 16 bytes.
struct alignas(16) StageWord {
    std::uint64_t half[2];
};
/// Head of a block's description.
struct alignas(16) BlockHead {
    std::int64_t first_item = 0, first_root = 0;
    std::int32_t items = 0, roots = 0, ups = 0, downs = 0;
    /// The first root. It is stored here because a single chain has no other and would wait for its
    /// load.
    StageRoot root;
};
/// Merge by places, as StageMerge. Places fit in 16 bits because a block has fewer.
struct alignas(16) BlockMerge {
    std::uint16_t inboard = 0, outboard = 0, next = 0, restricted = 0;
    std::int64_t joint = 0;
};
/// Slot of an item's segment and storage index of its inboard joint. ~slot: another block of the
/// same launch sends the segment in a message. ~joint: the stage above supplies the force.
struct alignas(16) BlockItem {
    std::int64_t slot = 0, joint = 0;
    /// True if the segment arrives in a message from another block of the launch.
    CATENA_HD bool comes_by_letter() const { return slot < 0; }
    CATENA_HD std::int64_t own_slot() const { return slot < 0 ? ~slot : slot; }
    /// True if the stage above supplies the inboard force.
    CATENA_HD bool is_given() const { return joint < 0; }
};
/// Segment or force passed between stages, as StageTransfer. `above`: its place in the stage above,
/// or -1 if it has none there.
struct alignas(16) BlockHanded {
    std::int32_t place = 0, above = -1;
    std::int64_t at = 0;
};

/// Offsets of the parts of a block's description, in words. All blocks of a stage have the same
/// offsets.
struct StageLayout {
    /// Largest numbers of a block; it has at most as many merges as items.
    int levels = 0, items = 0, ups = 0, downs = 0;
    bool of_runs = false;

    static constexpr int of_word = sizeof(StageWord);
    CATENA_HD int merges_at() const { return static_cast<int>(sizeof(BlockHead)) / of_word; }
    CATENA_HD int items_at() const { return merges_at() + items; }
    /// Offset of the transfers to the stage above. Items are 32-bit places of the forces after
    /// runs, else BlockItem.
    CATENA_HD int ups_at() const { return items_at() + (of_runs ? (items + 3) / 4 : items); }
    CATENA_HD int downs_at() const { return ups_at() + ups; }
    /// Offset of the ends of every level's merges.
    CATENA_HD int levels_at() const { return downs_at() + downs; }
    /// Number of words per block.
    CATENA_HD int words() const { return levels_at() + (levels + 3) / 4; }
};
StageLayout layout_of(Stage const&);
/// Returns the words of all blocks of a stage, one block after the other. The stage may be one of a
/// pair in one launch.
std::vector<StageWord> words_of(Stage const&, StagesTogether const&);

/// Reader of one block's words.
class BlockEncoding {
  public:
    CATENA_HD BlockEncoding(StageLayout const& layout, StageWord const* words)
        : layout_(layout), words_(words) {}
    CATENA_HD BlockHead const& head() const { return at<BlockHead>(0)[0]; }
    CATENA_HD BlockMerge const& merge(int i) const {
        return at<BlockMerge>(layout_.merges_at())[i];
    }
    CATENA_HD BlockItem const& item(int i) const { return at<BlockItem>(layout_.items_at())[i]; }
    CATENA_HD int next_of_run(int i) const { return at<std::int32_t>(layout_.items_at())[i]; }
    CATENA_HD BlockHanded const& up(int i) const { return at<BlockHanded>(layout_.ups_at())[i]; }
    CATENA_HD BlockHanded const& down(int i) const {
        return at<BlockHanded>(layout_.downs_at())[i];
    }
    /// End of a level's merges; they are [end_of_level(level - 1), end_of_level(level)).
    CATENA_HD int end_of_level(int level) const {
        return level < 0 ? 0 : at<std::int32_t>(layout_.levels_at())[level];
    }

  private:
    template <class T>
    CATENA_HD T const* at(int word) const {
        return reinterpret_cast<T const*>(words_ + word);
    }
    StageLayout const& layout_;
    StageWord const* words_;
};

}  // namespace catena::dca
