#include "dca/stages.hpp"

#include <algorithm>
#include <bit>

namespace catena::dca {
namespace {

/// So many runs keep a GPU busy with one thread each and no help from others.
constexpr std::int64_t many_runs = 16384;
/// What the last stage's only block may be left with: blocks of the first stage.
constexpr std::uint64_t blocks_of_first_stage = 512;

class Planner {
  public:
    Planner(std::vector<std::vector<Merge>> const& levels, std::vector<Root> const& roots, std::int64_t slots)
        : levels_(levels), roots_(roots), up_(static_cast<std::size_t>(slots), -1), level_(up_.size(), -1), block_(up_.size(), -1) {
        offset_.push_back(0);
        for (auto const& level : levels) {
            for (Merge const& m : level) {
                up_[m.inboard] = up_[m.outboard] = m.slot;
                level_[m.slot] = static_cast<int>(offset_.size()) - 1;
            }
            offset_.push_back(offset_.back() + std::ssize(level));
        }
        closed_.assign(roots.size(), false);
    }

    /// From level `first` on. `bottom`: the slots of what is dealt out, runs or the first level's merges, `width` to a block.
    Stage stage(std::size_t first, std::vector<std::int64_t> const& bottom, std::int64_t width, int most_levels, StagePlan& plan) {
        Stage s;
        s.levels = std::min(static_cast<int>(levels_.size() - first), most_levels);
        std::vector<Range> const dealt = deal(bottom, width, static_cast<int>(first) + s.levels);
        s.run = dealt;
        s.merge.resize(dealt.size() * static_cast<std::size_t>(s.levels));
        for (int l = 0; l < s.levels; ++l) add_level(s, l, first + static_cast<std::size_t>(l));
        add_roots(s, static_cast<int>(first) + s.levels, plan);
        return s;
    }

  private:
    /// Blocks of neighbours: what meets below level `end` stays together.
    std::vector<Range> deal(std::vector<std::int64_t> const& bottom, std::int64_t width, int end_level) {
        std::vector<Range> blocks;
        for (std::int64_t i = 0; i < std::ssize(bottom);) {
            std::int64_t end = i;
            std::int64_t const top = ancestor(bottom[i], end_level);
            while (end < std::ssize(bottom) && ancestor(bottom[end], end_level) == top) ++end;
            if (blocks.empty() || end - blocks.back().begin > width) blocks.push_back({i, i});
            blocks.back().end = end;
            for (; i < end; ++i) block_[bottom[i]] = std::ssize(blocks) - 1;
        }
        return blocks;
    }
    std::int64_t ancestor(std::int64_t slot, int end_level) const {
        while (up_[slot] >= 0 && level_[up_[slot]] < end_level) slot = up_[slot];
        return slot;
    }
    void add_level(Stage& s, int l, std::size_t level) {
        std::int64_t at = offset_[level];
        for (Merge const& m : levels_[level]) {
            // The lowest merges of a later stage were dealt out themselves.
            if (block_[m.slot] < 0) block_[m.slot] = block_[m.inboard];
            Range& range = s.merge[static_cast<std::size_t>(block_[m.slot] * s.levels + l)];
            if (range.begin == range.end) range.begin = at;
            range.end = ++at;
        }
    }
    /// Roots whose segments are there once the levels below `end_level` are.
    void add_roots(Stage& s, int end_level, StagePlan& plan) {
        std::vector<std::vector<Root>> of_block(s.run.size());
        for (std::size_t i = 0; i < roots_.size(); ++i) {
            if (closed_[i] || up_[roots_[i].slot] >= 0 || block_[roots_[i].slot] < 0 || level_[roots_[i].slot] >= end_level) continue;
            closed_[i] = true;
            of_block[static_cast<std::size_t>(block_[roots_[i].slot])].push_back(roots_[i]);
        }
        for (std::vector<Root> const& roots : of_block) {
            s.root.push_back({std::ssize(plan.roots), std::ssize(plan.roots) + std::ssize(roots)});
            plan.roots.insert(plan.roots.end(), roots.begin(), roots.end());
        }
    }

    std::vector<std::vector<Merge>> const& levels_;
    std::vector<Root> const& roots_;
    std::vector<bool> closed_;
    std::vector<std::int64_t> up_;  // the slot of the merge that takes a slot
    std::vector<int> level_;        // of the merge that makes a slot; -1: a run does
    std::vector<std::int64_t> block_, offset_;
};

}  // namespace

StagePlan plan_stages(std::vector<Run> const& runs, std::vector<std::vector<Merge>> const& levels, std::vector<Root> const& roots,
                      std::int64_t slots, std::int64_t threads) {
    Planner planner(levels, roots, slots);
    StagePlan plan;
    plan.runs_apart = std::ssize(runs) > many_runs;
    std::size_t level = 0;
    if (!runs.empty()) {
        std::vector<std::int64_t> bottom;
        for (Run const& run : runs) bottom.push_back(run.slot);
        std::int64_t const at_once = std::max<std::int64_t>(1, threads / parts_of_run);  // of a block
        auto const shared = static_cast<std::int64_t>(std::bit_ceil(static_cast<std::uint64_t>(bottom.size()) / blocks_of_first_stage));
        bool const one_block = std::ssize(bottom) <= threads;
        std::int64_t const width = one_block ? std::ssize(bottom) : std::max(plan.runs_apart ? 2 * threads : at_once, shared);
        int const most_levels = one_block ? static_cast<int>(levels.size()) : std::bit_width(static_cast<std::uint64_t>(width)) - 1;
        plan.stages.push_back(planner.stage(0, bottom, width, most_levels, plan));
        if (plan.runs_apart) plan.stages.back().run.clear();
        level = static_cast<std::size_t>(plan.stages.back().levels);
    }
    while (level < levels.size() && levels[level].empty()) ++level;
    if (level == levels.size()) return plan;
    std::vector<std::int64_t> bottom;
    for (Merge const& m : levels[level]) bottom.push_back(m.slot);
    plan.stages.push_back(planner.stage(level, bottom, std::ssize(bottom), static_cast<int>(levels.size()), plan));
    plan.stages.back().run.clear();
    return plan;
}

BlockPlan plan_blocks(Schedule const& schedule, std::vector<std::int64_t> const& tip, std::int64_t width) {
    BlockPlan plan;
    if (schedule.runs.empty()) return plan;
    std::vector<std::int64_t> bottom;
    for (Run const& run : schedule.runs) bottom.push_back(run.slot);
    StagePlan of_stage;
    plan.stage = Planner(schedule.levels, schedule.roots, schedule.slots)
                     .stage(0, bottom, width, static_cast<int>(schedule.levels.size()), of_stage);
    plan.roots = std::move(of_stage.roots);
    for (Range const& runs : plan.stage.run) {
        Run const &first = schedule.runs[static_cast<std::size_t>(runs.begin)],
                  &last = schedule.runs[static_cast<std::size_t>(runs.end - 1)];
        plan.body.push_back({first.body, last.body + last.count});
        auto const place = [&](std::int64_t body) { return std::lower_bound(tip.begin(), tip.end(), body) - tip.begin(); };
        plan.tip.push_back({place(plan.body.back().begin), place(plan.body.back().end)});
    }
    return plan;
}

}  // namespace catena::dca
