// Encoding of stages into the words that blocks of a GPU load.
#include "tree/stage_encoding.hpp"

#include <algorithm>
#include <cstring>
#include <span>

namespace catena::dca {
namespace {

/// Length of the longest range.
int most(std::vector<Range> const& ranges) {
    std::int64_t found = 0;
    for (Range const& range : ranges) found = std::max(found, range.end - range.begin);
    return static_cast<int>(found);
}
/// Writes entry i of the array of T that begins at `word`.
template <class T>
void put(std::span<StageWord> words, int word, std::int64_t i, T const& value) {
    std::memcpy(
        reinterpret_cast<std::byte*>(words.data() + word) + static_cast<std::size_t>(i) * sizeof(T),
        &value, sizeof(T));
}
/// Calls action(index within the range, index) for every index of a range.
template <class Action>
void each(Range const& range, Action const& action) {
    for (std::int64_t i = range.begin; i < range.end; ++i)
        action(i - range.begin, static_cast<std::size_t>(i));
}

}  // namespace

StageLayout layout_of(Stage const& stage) {
    return {stage.levels, static_cast<int>(stage.width), most(stage.up), most(stage.down),
            stage.of_runs};
}

std::vector<StageWord> words_of(Stage const& stage, StagesTogether const& together) {
    PlacesAbove const *const below = &stage == together.lower ? &together.places : nullptr,
                             *const above = &stage == together.upper ? &together.places : nullptr;
    StageLayout const layout = layout_of(stage);
    auto const of_block = static_cast<std::size_t>(layout.words());
    std::vector<StageWord> all(of_block * static_cast<std::size_t>(stage.blocks()));
    std::vector<StageBlock> const blocks = blocks_of(stage);
    std::vector<std::int32_t> const level_end = level_ends_of(stage);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        std::span const words(all.data() + b * of_block, of_block);
        StageBlock const& block = blocks[b];
        auto const count = [](Range const& range) {
            return static_cast<std::int32_t>(range.end - range.begin);
        };
        put(words, 0, 0,
            BlockHead{block.item.begin, block.root.begin, count(block.item), count(block.root),
                      count(block.up), count(block.down),
                      count(block.root) > 0
                          ? stage.roots[static_cast<std::size_t>(block.root.begin)]
                          : StageRoot{}});
        each(block.merge, [&](std::int64_t i, std::size_t m) {
            StageMerge const& merge = stage.merges[m];
            auto const place = [](std::int32_t p) { return static_cast<std::uint16_t>(p); };
            put(words, layout.merges_at(), i,
                BlockMerge{place(merge.inboard), place(merge.outboard), place(merge.next),
                           place(merge.restricted), merge.joint});
        });
        each(block.item, [&](std::int64_t i, std::size_t s) {
            StageItem const& item = stage.items[s];
            if (stage.of_runs) return put(words, layout.items_at(), i, item.next);
            bool const by_letter = above && above->comes_from_below[s];
            put(words, layout.items_at(), i,
                BlockItem{by_letter ? ~item.slot : item.slot,
                          item.given ? ~item.joint : item.joint});
        });
        auto const hand = [&](int at, std::vector<StageTransfer> const& handed,
                              std::vector<std::int32_t> const* places) {
            return [&words, &handed, at, places](std::int64_t i, std::size_t h) {
                put(words, at, i,
                    BlockHanded{handed[h].place, places ? (*places)[h] : -1, handed[h].at});
            };
        };
        each(block.up, hand(layout.ups_at(), stage.segments_up, below ? &below->segment : nullptr));
        each(block.down,
             hand(layout.downs_at(), stage.forces_down, below ? &below->force : nullptr));
        for (int l = 0; l < stage.levels; ++l)
            put(words, layout.levels_at(), l,
                level_end[b * static_cast<std::size_t>(stage.levels) +
                          static_cast<std::size_t>(l)]);
    }
    return all;
}

}  // namespace catena::dca
