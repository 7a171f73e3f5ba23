// The choice of bodies and runs to place side by side in vector lanes.
#include "dynamics/joint/joint_lanes.hpp"

#include "joints/joint_models.hpp"

namespace catena {
namespace {

/// True if bodies k to k + lanes - 1 may be placed side by side. They need the same operations,
/// without branches on their data. Their neighbours are in the same chain on this rank: none is the
/// chain's first or last body, so none is a run by itself.
bool go_side_by_side(ChainGroup const& group, bool springs, std::int64_t k, int lanes) {
    if (k == 0 || k + lanes >= group.size) return false;
    JointType const type = group.joints.type[static_cast<std::size_t>(k)];
    if (numbers_of_joint(type) == 0 || (springs && is_ball(type))) return false;
    for (std::int64_t i = k; i <= k + lanes;
         // Includes the joint after them, whose motion moves their handle 2.
         ++i) {
        auto const at = static_cast<std::size_t>(i);
        if (group.joints.type[at] != type || group.ends.is_first[at]) return false;
    }
    return true;
}

/// Sorts bodies [begin, end) into groups and others.
template <class Bodies>
void deal_out(ChainGroup const& group, bool springs, std::int64_t begin, std::int64_t end,
              int lanes, Bodies& bodies) {
    for (std::int64_t k = begin; k < end;) {
        if (k + lanes <= end && go_side_by_side(group, springs, k, lanes)) {
            bodies.first.push_back(k);
            k += lanes;
        } else {
            bodies.others.push_back(k);
            ++k;
        }
    }
}

/// Returns all loops of an instruction set.
JointLoops loops_of(SimdLevel level, bool positions) {
    if (level == SimdLevel::avx512)
        return {avx512_kinematic_loops(positions), avx512_step_loops(positions)};
    return {avx2_kinematic_loops(positions), avx2_step_loops(positions)};
}

}  // namespace

JointLanes::JointLanes(ChainGroup const& group, bool springs, bool revolutes, SimdLevel level) {
    if (level == SimdLevel::off || !rounds_as_vectors() || !group.joints.drives.empty() ||
        group.carried.in_scene || !group.joints.implicit.empty())
        return;
    for (bool const positions : {false, true})
        loops_[positions ? 1 : 0] = loops_of(level, positions);
    int const lanes = lanes_of(level);
    asks_ahead_ = dca::prefetches(group);
    deal_out(group, springs, 0, group.size, lanes, bodies_);
    runs_ = dca::deal_out_runs(group, lanes, {true, false});
    if (!any()) {
        bodies_ = {};
        return;
    }
    tree_.emplace(runs_.others, group.schedule.levels, group.schedule.roots, group.schedule.slots);
    if (!revolutes) return;
    for (dca::RunsInLanes const& item : runs_.items)
        for (int lane = 0; lane < lanes; ++lane)
            if (group.ends.is_first[static_cast<std::size_t>(item.body[lane])] &&
                (lane == 0 || item.body[lane] != item.body[0]))
                chains_begin_.push_back(item.body[lane]);
    constants_ = dca::constants_in_lanes(runs_.items, lanes, revolute_constants,
                                         [&group](std::int64_t k, double* place) {
                                             auto const axes = group.bodies.axes1[k];
                                             auto const rotation = group.joints.rotation[k];
                                             for (int i = 0; i < 3; ++i) *place++ = axes[3 + i];
                                             for (int i = 0; i < 4; ++i) *place++ = rotation[i];
                                         });
}

}  // namespace catena
