// Planning of stages: distribution of a tree's runs and merges over the blocks of a GPU.
#include "tree/stages.hpp"

#include <algorithm>
#include <bit>
#include <unordered_map>
#include <utility>

#include "tree/segments.hpp"

namespace catena::dca {
namespace {

/// Number of runs that keep a GPU busy with one thread for each.
constexpr std::int64_t many_runs = 16384;
/// Smallest number of runs for a block, if blocks have that many threads.
constexpr std::int64_t fewest_of_block = 32;

/// Returns the smallest power of two that is at least n, and at least 1.
std::int64_t bit_ceil(std::int64_t n) {
    return static_cast<std::int64_t>(
        std::bit_ceil(static_cast<std::uint64_t>(std::max<std::int64_t>(n, 1))));
}
/// Number of levels of merges above so many items.
int levels_above(std::int64_t items) {
    return std::bit_width(static_cast<std::uint64_t>(items)) - 1;
}

/// Returns the slots of the runs.
std::vector<std::int64_t> slots_of(std::vector<Run> const& runs) {
    std::vector<std::int64_t> slots;
    for (Run const& run : runs) slots.push_back(run.slot);
    return slots;
}

/// True if merges need segments that are neither runs nor merged before.
bool needs_others(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels,
                  std::int64_t slots) {
    std::vector<std::uint8_t> is_here(static_cast<std::size_t>(slots), 0);
    auto const here = [&](std::int64_t slot) -> std::uint8_t& {
        return is_here[static_cast<std::size_t>(slot)];
    };
    for (Run const& run : runs) here(run.slot) = 1;
    for (std::vector<Merge> const& level : levels)
        for (Merge const& m : level) {
            if (!here(m.inboard) || !here(m.outboard)) return true;
            here(m.slot) = 1;
        }
    return false;
}

/// Sorts the merges by block, then by level.
void sort_by_block(Stage& s) {
    std::vector<StageMerge> sorted;
    sorted.reserve(s.merges.size());
    for (Range& range : s.merge) {
        auto const begin = std::ssize(sorted);
        sorted.insert(sorted.end(), s.merges.begin() + range.begin, s.merges.begin() + range.end);
        range = {begin, std::ssize(sorted)};
    }
    s.merges = std::move(sorted);
}

/// Builds stages from the runs, merges and roots of a schedule.
class Planner {
  public:
    Planner(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels,
            std::vector<Root> const& roots, std::int64_t slots,
            std::span<std::uint8_t const> restricted)
        : segments_(runs, levels, slots),
          levels_(levels),
          roots_(roots),
          restricted_(restricted),
          root_of_(static_cast<std::size_t>(slots), -1),
          seats_(static_cast<std::size_t>(slots)),
          needs_others_(needs_others(runs, levels, slots)) {
        for (std::size_t i = 0; i < roots.size(); ++i)
            root_of_[static_cast<std::size_t>(roots[i].slot)] = static_cast<std::int64_t>(i);
    }
    /// Number of levels of merges.
    int end() const { return static_cast<int>(levels_.size()); }

    /// Returns the runs and the segments of other trees that the levels before `end_level` need,
    /// along the chains.
    std::vector<std::int64_t> leaves(std::vector<Run> const& runs, int end_level) const {
        std::vector<std::int64_t> items = slots_of(runs);
        if (!needs_others_) return items;
        std::vector<std::uint8_t> is_run(seats_.size(), 0);
        for (std::int64_t const slot : items) is_run[static_cast<std::size_t>(slot)] = 1;
        for (std::int64_t const slot : segments_.needed(0, end_level))
            if (!is_run[static_cast<std::size_t>(slot)]) items.push_back(slot);
        segments_.sort(items);
        return items;
    }
    /// Appends stages for all levels from `level` on, with up to `most` items per block. Larger
    /// sets are reduced by several levels, by up to `together` narrower blocks if these suffice.
    /// The last stage also loads segments of earlier stages that other ranks need. If one block has
    /// all of these, it can exchange them with the other ranks.
    void add_upper(int level, std::int64_t most, std::int64_t together,
                   std::vector<Stage>& stages) {
        for (std::vector<std::int64_t> left = segments_.needed(level, end()); !left.empty();
             left = segments_.needed(level, end())) {
            std::int64_t width = most;
            for (std::int64_t half = most / 2;
                 half * half >= std::ssize(left) && half * together >= std::ssize(left); half /= 2)
                width = half;
            int const end_level =
                std::ssize(left) <= most ? end() : std::min(end(), level + levels_above(width));
            std::vector<std::int64_t> items = segments_.needed(level, end_level);
            if (std::vector<std::int64_t> all = items; end_level == end()) {
                add_units(stages, all);
                if (std::ssize(all) <= most) items = std::move(all);
            }
            stages.push_back(stage(items, end_level == end() ? most : width, level, end_level));
            level = end_level;
        }
    }
    /// Appends a stage of one block if several blocks of the last stage produce units that other
    /// ranks need.
    void gather_units(std::int64_t most, std::vector<Stage>& stages) {
        if (stages.empty() || stages.back().blocks() == 1) return;
        std::vector<std::int64_t> units;
        add_units(stages, units);
        if (units.empty() || std::ssize(units) > most) return;
        stages.push_back(stage(units, most, end(), end()));
        stages.back().gathers = true;
    }
    /// Returns the stage of levels `first` to `end_level` - 1 above `items`, with up to `width` of
    /// them per block.
    Stage stage(std::vector<std::int64_t> const& items, std::int64_t width, int first,
                int end_level) {
        Stage s;
        s.levels = end_level - first;
        deal(items, width, end_level, s);
        for (std::size_t b = 0; b < s.item.size(); ++b) place_items(s, b);
        s.merge.resize(s.item.size() * static_cast<std::size_t>(s.levels));
        for (int l = first; l < end_level; ++l) add_level(s, l, l - first);
        sort_by_block(s);
        hand_over(s, items, first, end_level);
        for (Range const& item : s.item) s.width = std::max(s.width, item.end - item.begin);
        return s;
    }

  private:
    /// Place of a segment and of the force at its outboard joint, in the stage planned last.
    struct Seat {
        std::int64_t block = -1;
        std::int32_t place = 0, next_place = 0;
    };
    /// Adds to `items` the segments of these stages that other ranks need, each once and along the
    /// chains.
    void add_units(std::vector<Stage> const& stages, std::vector<std::int64_t>& items) const {
        for (Stage const& s : stages)
            for (StageTransfer const& up : s.segments_up)
                if (segments_.of(up.at).met < 0) items.push_back(up.at);
        segments_.sort(items);
        items.erase(std::unique(items.begin(), items.end()), items.end());
    }
    /// Assigns neighbouring items to blocks; items that are merged below `end_level` share a block.
    void deal(std::vector<std::int64_t> const& items, std::int64_t width, int end_level, Stage& s) {
        for (std::int64_t i = 0; i < std::ssize(items);) {
            std::int64_t next = i;
            std::int64_t const top =
                segments_.ancestor(items[static_cast<std::size_t>(i)], end_level);
            while (next < std::ssize(items) &&
                   segments_.ancestor(items[static_cast<std::size_t>(next)], end_level) == top)
                ++next;
            if (s.item.empty() || next - s.item.back().begin > width) s.item.push_back({i, i});
            s.item.back().end = next;
            i = next;
        }
        for (std::int64_t const slot : items)
            s.items.push_back({slot, segments_.of(slot).joint, 0, false});
    }
    /// Assigns places to a block's items and forces. The force after an item comes from another
    /// stage if it is not the inboard force of the block's next item.
    void place_items(Stage& s, std::size_t b) {
        Range const range = s.item[b];
        std::vector<StageTransfer> from_elsewhere;
        for (std::int64_t i = range.begin; i < range.end; ++i) {
            StageItem& item = s.items[static_cast<std::size_t>(i)];
            std::int64_t const next = segments_.of(item.slot).next;
            Seat& seat = seat_of(item.slot);
            seat.block = static_cast<std::int64_t>(b);
            seat.place = static_cast<std::int32_t>(i - range.begin);
            if (i + 1 < range.end && s.items[static_cast<std::size_t>(i + 1)].joint == next) {
                item.next = seat.place + 1;
            } else {
                auto found = std::find_if(from_elsewhere.rbegin(), from_elsewhere.rend(),
                                          [&](StageTransfer const& h) { return h.at == next; });
                if (found == from_elsewhere.rend()) {
                    from_elsewhere.push_back({static_cast<std::int32_t>(range.end - range.begin +
                                                                        std::ssize(from_elsewhere)),
                                              next});
                    found = from_elsewhere.rbegin();
                }
                item.next = found->place;
            }
            seat.next_place = item.next;
        }
        s.down.push_back({std::ssize(s.forces_down), 0});
        s.forces_down.insert(s.forces_down.end(), from_elsewhere.begin(), from_elsewhere.end());
        s.down.back().end = std::ssize(s.forces_down);
        s.forces = std::max(s.forces, range.end - range.begin + std::ssize(from_elsewhere));
    }
    /// Appends the merges of one level, in the blocks of their inboard segments.
    void add_level(Stage& s, int level, int l) {
        for (Merge const& m : levels_[static_cast<std::size_t>(level)]) {
            Seat const inboard = seat_of(m.inboard), outboard = seat_of(m.outboard);
            Seat& joined = seat_of(m.slot);
            joined.block = inboard.block, joined.place = inboard.place,
            joined.next_place = outboard.next_place;
            Range& range = s.merge[static_cast<std::size_t>(joined.block * s.levels + l)];
            if (range.begin == range.end) range.begin = range.end = std::ssize(s.merges);
            ++range.end;
            s.merges.push_back({inboard.place, outboard.place, outboard.next_place,
                                restricted_at(m.joint), m.joint});
        }
    }
    Seat& seat_of(std::int64_t slot) { return seats_[static_cast<std::size_t>(slot)]; }
    std::int32_t restricted_at(std::int64_t joint) const {
        return restricted_.empty() ? 0 : restricted_[static_cast<std::size_t>(joint)];
    }
    /// Determines what a stage passes on below `end_level`. Roots are closed; all other complete
    /// segments are stored for later stages. The forces at the first joints of both come from there
    /// in the outward pass.
    void hand_over(Stage& s, std::vector<std::int64_t> const& items, int first, int end_level) {
        std::vector<std::vector<std::int64_t>> tops(s.item.size());
        auto const see = [&](std::int64_t slot) {
            if (segments_.is_top(slot, end_level))
                tops[static_cast<std::size_t>(seat_of(slot).block)].push_back(slot);
        };
        for (std::int64_t const slot : items) see(slot);
        for (int l = first; l < end_level; ++l)
            for (Merge const& m : levels_[static_cast<std::size_t>(l)]) see(m.slot);
        std::vector<StageTransfer> down;
        for (std::size_t b = 0; b < tops.size(); ++b) {
            Range root{std::ssize(s.roots), 0}, up{std::ssize(s.segments_up), 0};
            auto const begin = std::ssize(down);
            down.insert(down.end(), s.forces_down.begin() + s.down[b].begin,
                        s.forces_down.begin() + s.down[b].end);
            for (std::int64_t const slot : tops[b]) {
                std::int32_t const place = seat_of(slot).place;
                std::int64_t const joint = segments_.of(slot).joint;
                std::int64_t const closed = root_of_[static_cast<std::size_t>(slot)];
                if (closed >= 0)
                    s.roots.push_back(
                        {place, restricted_at(joint), roots_[static_cast<std::size_t>(closed)]});
                else
                    s.segments_up.push_back({place, slot});
                down.push_back({place, joint});
                s.items[static_cast<std::size_t>(s.item[b].begin + place)].given = true;
            }
            root.end = std::ssize(s.roots);
            up.end = std::ssize(s.segments_up);
            s.root.push_back(root);
            s.up.push_back(up);
            s.down[b] = {begin, std::ssize(down)};
        }
        s.forces_down = std::move(down);
    }

    Segments segments_;
    std::vector<std::vector<Merge>> const& levels_;
    std::vector<Root> const& roots_;
    std::span<std::uint8_t const> restricted_;
    std::vector<std::int64_t> root_of_;  // index of the root that a slot closes; -1: none
    std::vector<Seat> seats_;            // indexed by slot
    bool needs_others_ = false;          // needs_others()
};

/// Number of runs of a block with one thread for every part.
std::int64_t runs_at_once(StageSizes const& sizes) {
    return std::max<std::int64_t>(1, sizes.threads / parts_of_run);
}
/// True if a tree of so many levels fits in one block.
bool are_low(int levels, StageSizes const& sizes) {
    return levels <= levels_above(std::min(sizes.most, runs_at_once(sizes)));
}
/// Largest number of runs within a stage; more of them are processed by a separate launch.
std::int64_t most_in_stage(int levels, StageSizes const& sizes) {
    return sizes.together == 0 || are_low(levels, sizes)
               ? many_runs
               : std::min(many_runs, sizes.together * runs_at_once(sizes));
}
/// Number of items per block of the first stage, below so many levels of merges. `apart`: a
/// separate launch has processed the runs.
std::int64_t width_of_runs(std::int64_t runs, bool apart, int levels, StageSizes const& sizes) {
    if (apart) {
        if (sizes.at_once > 0 && runs <= sizes.most)
            return std::max<std::int64_t>(2, bit_ceil(runs));
        std::int64_t width =
            std::min(sizes.most, 2 * (sizes.at_once > 0 ? sizes.at_once : sizes.threads));
        while (width < sizes.most && runs / width > sizes.most * sizes.together) width *= 2;
        return width;
    }
    std::int64_t const at_once = runs_at_once(sizes);
    bool const few = runs <= sizes.together * at_once && !are_low(levels, sizes);
    std::int64_t const of_block =
        few ? std::max(fewest_of_block, bit_ceil((runs - 1) / sizes.together + 1)) : at_once;
    return std::min({sizes.most, at_once, of_block});
}

/// Returns the scan's counterpart of a stage.
ScanStage scan_stage_of(Stage const& stage) {
    ScanStage s;
    s.levels = stage.levels, s.of_runs = stage.of_runs, s.width = stage.width;
    for (StageItem const& item : stage.items)
        s.slot.push_back(static_cast<std::int32_t>(item.slot));
    for (StageMerge const& m : stage.merges) s.merges.push_back({m.inboard, m.outboard});
    for (StageBlock const& block : blocks_of(stage)) {
        Range top{std::ssize(s.tops), 0};
        for (std::int64_t i = block.root.begin; i < block.root.end; ++i) {
            StageRoot const& closed = stage.roots[static_cast<std::size_t>(i)];
            s.tops.push_back({closed.place, static_cast<std::int32_t>(closed.root.slot)});
        }
        for (std::int64_t i = block.up.begin; i < block.up.end; ++i) {
            StageTransfer const& up = stage.segments_up[static_cast<std::size_t>(i)];
            s.tops.push_back({up.place, static_cast<std::int32_t>(up.at)});
        }
        top.end = std::ssize(s.tops);
        s.blocks.push_back({block.item, block.merge, top});
    }
    s.level_end = level_ends_of(stage);
    return s;
}

/// Finds the lower stage's segments and forces among the places of the upper stage.
PlacesAbove places_above(Stage const& lower, Stage const& upper) {
    std::unordered_map<std::int64_t, std::int32_t> item_of, place_of;
    for (std::size_t i = 0; i < upper.items.size(); ++i) {
        item_of[upper.items[i].slot] = static_cast<std::int32_t>(i);
        place_of[upper.items[i].joint] = static_cast<std::int32_t>(i);
    }
    for (StageTransfer const& down : upper.forces_down) place_of[down.at] = down.place;
    auto const place = [](auto const& places, std::int64_t at) {
        auto const found = places.find(at);
        return found == places.end() ? -1 : found->second;
    };
    PlacesAbove above;
    for (StageTransfer const& up : lower.segments_up)
        above.segment.push_back(place(item_of, up.at));
    for (StageTransfer const& down : lower.forces_down)
        above.force.push_back(place(place_of, down.at));
    above.comes_from_below.resize(upper.items.size());
    for (std::int32_t const item : above.segment)
        if (item >= 0) above.comes_from_below[static_cast<std::size_t>(item)] = 1;
    return above;
}

}  // namespace

StagePlan plan_stages(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels,
                      std::vector<Root> const& roots, std::int64_t slots,
                      std::span<std::uint8_t const> restricted, StageSizes const& sizes) {
    Planner planner(runs, levels, roots, slots, restricted);
    StagePlan plan;
    std::int64_t const leaves = std::ssize(planner.leaves(runs, planner.end()));
    plan.runs_apart = !runs.empty() && (sizes.runs_apart || leaves > std::ssize(runs) ||
                                        leaves > most_in_stage(planner.end(), sizes));
    int level = 0;
    if (!runs.empty()) {
        std::int64_t const width = width_of_runs(leaves, plan.runs_apart, planner.end(), sizes);
        level = leaves <= width ? planner.end() : std::min(planner.end(), levels_above(width));
        plan.stages.push_back(planner.stage(planner.leaves(runs, level), width, 0, level));
        plan.stages.back().of_runs = !plan.runs_apart;
    }
    planner.add_upper(level, sizes.most, sizes.together, plan.stages);
    planner.gather_units(sizes.most, plan.stages);
    return plan;
}

StagesTogether::StagesTogether(StagePlan const& plan, StageSizes const& sizes) {
    if (plan.stages.size() < 2 || plan.stages.back().blocks() != 1) return;
    Stage const& below = plan.stages[plan.stages.size() - 2];
    if (below.blocks() > sizes.together) return;
    places = places_above(below, plan.stages.back());
    // An earlier stage may need the units that other ranks need; then one launch does not suffice.
    if (std::find(places.segment.begin(), places.segment.end(), -1) != places.segment.end()) return;
    lower = &below, upper = &plan.stages.back();
}

std::vector<ScanStage> plan_scan(std::vector<Run> const& runs,
                                 std::vector<std::vector<Merge>> const& levels,
                                 std::vector<Root> const& roots, std::int64_t slots,
                                 std::int64_t most) {
    Planner planner(runs, levels, roots, slots, {});
    std::vector<Stage> stages;
    int level = 0;
    if (!runs.empty()) {
        level =
            std::ssize(runs) <= most ? planner.end() : std::min(planner.end(), levels_above(most));
        stages.push_back(planner.stage(slots_of(runs), most, 0, level));
        stages.back().of_runs = true;
    }
    planner.add_upper(level, most, 0, stages);
    std::vector<ScanStage> plan;
    for (Stage const& stage : stages) plan.push_back(scan_stage_of(stage));
    return plan;
}

std::vector<StageBlock> blocks_of(Stage const& stage) {
    std::vector<StageBlock> blocks;
    for (std::size_t b = 0; b < stage.item.size(); ++b) {
        auto const* const level = stage.merge.data() + b * static_cast<std::size_t>(stage.levels);
        Range const merge =
            stage.levels > 0 ? Range{level[0].begin, level[stage.levels - 1].end} : Range{};
        blocks.push_back({stage.item[b], merge, stage.root[b], stage.up[b], stage.down[b]});
    }
    return blocks;
}

std::vector<std::int32_t> level_ends_of(Stage const& stage) {
    std::vector<std::int32_t> ends;
    for (std::size_t i = 0; i < stage.merge.size(); ++i)
        ends.push_back(static_cast<std::int32_t>(
            stage.merge[i].end -
            stage.merge[i - i % static_cast<std::size_t>(stage.levels)].begin));
    return ends;
}

StageSizes stage_sizes(StageRecords const& records, std::int64_t shared_bytes,
                       std::int64_t at_once) {
    StageSizes sizes{records.threads, 2, std::max<std::int64_t>(0, at_once - 1), records.whole_runs,
                     records.at_once};
    // `words` counts the description of a merge, an item and a transfer; `heads` that of the block.
    auto const bytes = [&](std::int64_t items) {
        constexpr std::int64_t words = 10, heads = 24;
        return 8 * (packed_numbers(records.segment, items) +
                    2 * packed_numbers(records.state, items) + words * items + heads);
    };
    while (bytes(2 * sizes.most) <= shared_bytes) sizes.most *= 2;
    // A stage of runs also stores one segment per thread, for the parts of runs.
    auto const of_runs = [&](std::int64_t threads) {
        constexpr std::int64_t ranges = 16;
        return bytes(threads / parts_of_run) +
               8 * (packed_numbers(records.segment, threads) + ranges);
    };
    constexpr std::int64_t fewest_threads = 32;
    while (sizes.threads > fewest_threads && of_runs(sizes.threads) > shared_bytes)
        sizes.threads /= 2;
    return sizes;
}

std::int64_t kept_numbers(Stage const& stage, StageRecords const& records) {
    return records.kept > 0 && !stage.of_runs
               ? stage.blocks() * packed_numbers(records.kept, stage.width)
               : 0;
}

int threads_for(Stage const& stage, StageSizes const& sizes) {
    constexpr std::int64_t fewest = 32;
    if (stage.of_runs)
        // one thread per part
        return static_cast<int>(std::max(fewest, bit_ceil(parts_of_run * stage.width)));
    return static_cast<int>(
        std::clamp(bit_ceil(stage.width / 2), fewest, std::max(fewest, sizes.threads)));
}

BlockPlan plan_blocks(Schedule const& schedule, std::vector<std::int64_t> const& tip) {
    BlockPlan plan;
    plan.levels = static_cast<int>(schedule.levels.size());
    std::int64_t run = 0;
    std::vector<std::size_t> next_merge(schedule.levels.size(), 0);
    for (std::int64_t r = 0; r < std::ssize(schedule.roots); ++r) {
        std::int64_t const begin = schedule.roots[static_cast<std::size_t>(r)].first;
        std::int64_t const end = r + 1 < std::ssize(schedule.roots)
                                     ? schedule.roots[static_cast<std::size_t>(r + 1)].first
                                     : schedule.bodies;
        plan.body.push_back({begin, end});
        auto const place = [&](std::int64_t body) {
            return std::lower_bound(tip.begin(), tip.end(), body) - tip.begin();
        };
        plan.tip.push_back({place(begin), place(end)});
        plan.root.push_back({r, r + 1});
        plan.run.push_back({run, run});
        for (std::int64_t& last = plan.run.back().end;
             last < std::ssize(schedule.runs) &&
             schedule.runs[static_cast<std::size_t>(last)].body < end;
             ++last) {
        }
        run = plan.run.back().end;
        std::int64_t offset = 0;
        for (std::size_t l = 0; l < schedule.levels.size(); ++l) {
            std::vector<Merge> const& merges = schedule.levels[l];
            std::size_t& next = next_merge[l];
            Range range{offset + static_cast<std::int64_t>(next), 0};
            while (next < merges.size() && merges[next].joint < end) ++next;
            range.end = offset + static_cast<std::int64_t>(next);
            plan.merge.push_back(range);
            offset += std::ssize(merges);
        }
    }
    return plan;
}

}  // namespace catena::dca
