// What a block of a stage is told, as it lies in the block's shared memory: one copy brings all of
// it.
#pragma once

#include <cstdint>
#include <vector>

#include "tree/stages.hpp"

namespace catena::dca {

/// What a block reads at once.
struct alignas(16) StageWord {
    std::uint64_t half[2];
};
struct alignas(16) BlockHead {
    std::int64_t first_item = 0, first_root = 0;
    std::int32_t items = 0, roots = 0, ups = 0, downs = 0;
    StageRoot root;  // the first one: a chain alone has no other, and would wait for it
};
/// As StageMerge. Places find room: a block has fewer than that.
struct alignas(16) BlockMerge {
    std::uint16_t inboard = 0, outboard = 0, next = 0, restricted = 0;
    std::int64_t joint = 0;
};
/// Where an item's segment and its inboard joint are for everybody. ~slot: a letter brings it where
/// stages turn together; ~joint: its force comes from above.
struct alignas(16) BlockItem {
    std::int64_t slot = 0, joint = 0;
    CATENA_HD bool comes_by_letter() const { return slot < 0; }
    CATENA_HD std::int64_t own_slot() const { return slot < 0 ? ~slot : slot; }
    CATENA_HD bool is_given() const { return joint < 0; }
};
/// As Handed. `above`: the place in the stage above, where it is there.
struct alignas(16) BlockHanded {
    std::int32_t place = 0, above = -1;
    std::int64_t at = 0;
};

/// Where the parts of a block's words begin; of every block of a stage the same.
struct StageLayout {
    int levels = 0, items = 0, ups = 0, downs = 0;  // most of a block; no more merges than items
    bool of_runs = false;

    static constexpr int of_word = sizeof(StageWord);
    CATENA_HD int merges_at() const { return static_cast<int>(sizeof(BlockHead)) / of_word; }
    CATENA_HD int items_at() const { return merges_at() + items; }
    /// Of runs the place of the force after each of them, else BlockItem.
    CATENA_HD int ups_at() const { return items_at() + (of_runs ? (items + 3) / 4 : items); }
    CATENA_HD int downs_at() const { return ups_at() + ups; }
    /// Where every level's merges end.
    CATENA_HD int levels_at() const { return downs_at() + downs; }
    CATENA_HD int words() const { return levels_at() + (levels + 3) / 4; }
};
StageLayout layout_of(Stage const&);
/// Of all blocks, one after the other, which may be one of those.
std::vector<StageWord> words_of(Stage const&, StagesTogether const&);

/// A block's words.
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
    /// Merges [begin, end) of a level.
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
