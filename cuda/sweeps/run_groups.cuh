// Passes of a group of runs (run_groups.hpp) by a warp whose lane i has run i of the group. In the
// outward pass several warps may compute the same. tests/support/cuda_on_host.hpp, included first,
// makes this file compile on the host.
#pragma once

#include "cuda/device/cluster.cuh"
#include "cuda/sweeps/run_groups.hpp"
#include "cuda/sweeps/run_parts.cuh"

namespace catena::cuda::kernels {

/// True for sweeps that have launches by groups.
template <class Sweep>
constexpr bool by_groups = go_by_groups(Sweep::Sweeps::in_stage);

/// One group of runs, as seen by a lane.
class GroupOfRuns {
  public:
    /// `group`: number of the group.
    __device__ GroupOfRuns(GroupsView const& groups, RunsView const& runs, std::int64_t group)
        : groups_(groups),
          group_(group),
          first_(groups.first(group)),
          runs_(runs.count - group * runs_of_group),
          lane_(static_cast<int>(threadIdx.x) % runs_of_group) {}

    /// Merges the lanes' segments into the group's segment and stores it. Lanes beyond the last run
    /// pass any segment.
    template <class Sweep>
    __device__ void climb(Sweep const& sweep, typename Sweep::Segment segment) const {
        int const restricted = lane_ < runs_ ? sweep.s.restricted[joint(lane_)] : 0;
        CATENA_UNROLL
        for (int distance = 1; distance < runs_of_group; distance *= 2) {
            int const middle = lane_ - distance + 1,
                      of_joint = __shfl_sync(0xffffffffu, restricted, middle);
            typename Sweep::Segment const inboard = from_lane(segment, lane_ - distance);
            if ((lane_ & (2 * distance - 1)) != 2 * distance - 1) continue;
            if (middle >= runs_) {
                segment = inboard;
                continue;
            }
            dca::JointAt const at{joint(middle), of_joint};
            typename Sweep::Node node;
            segment = joined_quickly(sweep, inboard, segment, at, node);
            sweep.keep(at.k, node);
        }
        if (lane_ == runs_of_group - 1) sweep.store(groups_.slot(group_), segment);
    }

    /// Forces at a run's first joint and at the joint after it.
    template <class Sweep>
    struct Ends {
        typename Sweep::Sweeps::State first, next;
    };
    /// Returns the forces at the ends of each lane's run, if it has one.
    template <class Sweep>
    __device__ Ends<Sweep> descend(Sweep const& sweep) const {
        typename Sweep::Sweeps::Node node[levels_of_group];
        CATENA_UNROLL
        for (int l = 0; l < levels_of_group; ++l)
            if (middle(l) < runs_) node[l] = sweep.node(joint(middle(l)));
        Ends<Sweep> ends{sweep.s.forces.load(first_), sweep.s.forces.load(groups_.next(group_))};
        CATENA_UNROLL
        for (int l = levels_of_group - 1; l >= 0; --l) {
            if (middle(l) >= runs_) continue;
            auto const there = sweep.force(node[l], ends.first, ends.next);
            (lane_ < middle(l) ? ends.next : ends.first) = there;
        }
        return ends;
    }

  private:
    /// Joint inboard of run i.
    __device__ std::int64_t joint(int i) const { return first_ + i * dca::longest_run; }
    /// First run of the outboard half of the pair that contains this lane's run.
    __device__ int middle(int level) const { return (lane_ & ~((2 << level) - 1)) + (1 << level); }

    GroupsView const& groups_;
    std::int64_t group_, first_, runs_;  // `first_`: body
    int lane_;
};

}  // namespace catena::cuda::kernels
