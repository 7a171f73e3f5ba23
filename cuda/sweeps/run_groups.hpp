// Runs that the warp which has them joins itself: the lowest levels of a long chain's tree, without
// a launch of their own.
#pragma once

#include <algorithm>
#include <vector>

#include "cuda/sweeps/runs_view.hpp"
#include "tree/stages.hpp"

namespace catena::cuda {

/// A warp has a lane for each.
constexpr int runs_of_group = 32, levels_of_group = 5;
static_assert(runs_of_group == 1 << levels_of_group);
constexpr std::int64_t bodies_of_group = runs_of_group * dca::longest_run;  // but of the last one
/// With fewer, the runs' launches would lose more by them than those of the stages above gain.
constexpr std::int64_t fewest_groups_below_stages = 4096;

/// Whether sweeps with such records can, those of handles with one direction: a lane joins what it
/// holds to what another lane has, in registers.
constexpr bool go_by_groups(dca::StageRecords const& records) { return records.state == 1; }

/// As if they were runs. None where the tree's lowest levels do not join the first 32 runs, the
/// next ones and so on, and nothing else, as where chains begin in between.
inline std::vector<dca::Run> groups_of(std::vector<dca::Run> const& runs,
                                       std::vector<std::vector<dca::Merge>> const& levels,
                                       dca::StageRecords const& records) {
    if (!go_by_groups(records) || runs.empty() || levels.size() < levels_of_group) return {};
    for (std::size_t i = 0; i < runs.size(); ++i)
        if (runs[i].body != static_cast<std::int64_t>(i) * dca::longest_run) return {};
    std::vector<dca::Run> parts = runs;
    for (int l = 0; l < levels_of_group; ++l) {
        std::vector<dca::Merge> const& merges = levels[static_cast<std::size_t>(l)];
        if (merges.size() != parts.size() / 2) return {};
        for (std::size_t i = 0; i < merges.size(); ++i) {
            dca::Run const &a = parts[2 * i], &b = parts[2 * i + 1];
            dca::Merge const& m = merges[i];
            if (m.inboard != a.slot || m.outboard != b.slot || m.first != a.body ||
                m.joint != b.body || m.next != b.next)
                return {};
            parts[i] = {a.body, a.count + b.count, m.slot, b.next};
        }
        if (parts.size() % 2 == 1) parts[merges.size()] = parts.back();
        parts.resize((parts.size() + 1) / 2);
    }
    return parts;
}

/// Group i begins with body i bodies_of_group; the first `inner` ones go on to the next one's.
struct GroupsView {
    dca::Run const* list = nullptr;
    std::int64_t inner = 0;
    explicit CATENA_HD operator bool() const { return list != nullptr; }
    CATENA_HD std::int64_t slot(std::int64_t i) const { return list[i].slot; }
    CATENA_HD std::int64_t first(std::int64_t i) const { return i * bodies_of_group; }
    CATENA_HD std::int64_t next(std::int64_t i) const {
        return i < inner ? first(i + 1) : list[i].next;
    }
};
inline GroupsView view_of_groups(std::vector<dca::Run> const& groups, dca::Run const* list) {
    GroupsView view{groups.empty() ? nullptr : list};
    while (view.inner < std::ssize(groups) &&
           groups[static_cast<std::size_t>(view.inner)].next == view.first(view.inner + 1))
        ++view.inner;
    return view;
}

/// A tree's groups and stages.
struct PlanByGroups {
    std::vector<dca::Run> groups;      // groups_of()
    bool stages_above_groups = false;  // else above runs
    dca::StagePlan stages;
};
/// From `fewest` groups on stages stand above these, with blocks as narrow as one launch that takes
/// all up and down again allows.
inline PlanByGroups plan_by_groups(std::vector<dca::Run> const& runs,
                                   std::vector<std::vector<dca::Merge>> const& levels,
                                   std::vector<dca::Root> const& roots, std::int64_t slots,
                                   std::span<std::uint8_t const> restricted,
                                   dca::StageRecords const& records, dca::StageSizes sizes,
                                   std::int64_t fewest) {
    PlanByGroups plan;
    plan.groups = groups_of(runs, levels, records);
    plan.stages_above_groups = !plan.groups.empty() && std::ssize(plan.groups) >= fewest;
    if (!plan.stages_above_groups) {
        plan.stages = dca::plan_stages(runs, levels, roots, slots, restricted, sizes);
        return plan;
    }
    std::int64_t const most = sizes.threads;
    sizes.runs_apart = true;
    for (sizes.threads = 32;
         sizes.threads < most && std::ssize(plan.groups) > 2 * sizes.threads * sizes.together;)
        sizes.threads *= 2;
    plan.stages = dca::plan_stages(plan.groups, {levels.begin() + levels_of_group, levels.end()},
                                   roots, slots, restricted, sizes);
    return plan;
}

}  // namespace catena::cuda
