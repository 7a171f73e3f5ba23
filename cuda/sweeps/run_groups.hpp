// Groups of runs that one warp merges itself: the lowest levels of a long chain's tree, without a
// launch of their own. One cluster takes the tree above them (group_lanes.cuh).
#pragma once

#include <vector>

#include "cuda/sweeps/runs_view.hpp"
#include "tree/stages.hpp"

namespace catena::cuda {

/// Number of runs per group, one per lane of a warp, and number of tree levels within a group.
constexpr int runs_of_group = 32, levels_of_group = 5;
static_assert(runs_of_group == 1 << levels_of_group);
/// Number of bodies per group; the last group may have fewer.
constexpr std::int64_t bodies_of_group = runs_of_group * dca::longest_run;
/// True if sweeps with such records can use groups: those with handles of one direction. A lane
/// then merges its segment with another lane's in registers.
constexpr bool go_by_groups(dca::StageRecords const& records) { return records.state == 1; }

/// Returns the groups in the form of runs. The result is empty unless the tree's lowest levels
/// merge runs 0 to 31, the next 32 runs and so on, and no others. That fails, for example, if a
/// chain begins within a group.
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

/// View of a list of groups. Group i begins with body i * bodies_of_group. Each of the first
/// `inner` groups is followed by the next group's first joint.
struct GroupsView {
    dca::Run const* list = nullptr;
    std::int64_t inner = 0;
    explicit CATENA_HD operator bool() const { return list != nullptr; }
    /// Slot of the group's segment.
    CATENA_HD std::int64_t slot(std::int64_t i) const { return list[i].slot; }
    /// First body of the group.
    CATENA_HD std::int64_t first(std::int64_t i) const { return i * bodies_of_group; }
    /// Joint after the group.
    CATENA_HD std::int64_t next(std::int64_t i) const {
        return i < inner ? first(i + 1) : list[i].next;
    }
};
/// Returns the view of `groups`; `list` is the address of a copy of them.
inline GroupsView view_of_groups(std::vector<dca::Run> const& groups, dca::Run const* list) {
    GroupsView view{groups.empty() ? nullptr : list};
    while (view.inner < std::ssize(groups) &&
           groups[static_cast<std::size_t>(view.inner)].next == view.first(view.inner + 1))
        ++view.inner;
    return view;
}

}  // namespace catena::cuda
