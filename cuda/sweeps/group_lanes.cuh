// The tree above groups of runs (run_groups.cuh) of one chain, up and down in one launch: a lane
// has a group.
#pragma once

#include "cuda/sweeps/joined_lanes.cuh"
#include "cuda/sweeps/run_groups.cuh"

namespace catena::cuda::kernels {

/// Of one warp, in its block's shared memory.
template <class Sweep>
class GroupLanes {
    using Segment = typename Sweep::Segment;
    using Lanes = JoinedLanes<Sweep, bodies_of_group, 1>;

  public:
    static constexpr int most_threads = most_joining_warps * lanes_of_warp;
    static constexpr int warps_for_each(int /*joining*/) { return 1; }
    /// As ShortLanes'.
    static constexpr std::size_t numbers(int joining, int warps) {
        return static_cast<std::size_t>(Lanes::of_block(warps) + joining * Lanes::of_warp);
    }
    __device__ GroupLanes(OneChain const& chain, GroupsView const& groups, Sweep const& sweep,
                          double* memory)
        : sweep_(sweep),
          group_(static_cast<std::int64_t>(blockIdx.x) * blockDim.x + threadIdx.x),
          first_(groups.first(group_)),
          exists_(first_ < chain.bodies),
          slot_(exists_ ? groups.slot(group_) : 0),
          restricted_(exists_ ? sweep.s.restricted[first_] : 0),
          lanes_(chain, sweep, static_cast<int>(threadIdx.x) % lanes_of_warp,
                 static_cast<int>(group_ / lanes_of_warp), memory,
                 memory + Lanes::of_block(chain.warps) +
                     threadIdx.x / lanes_of_warp * Lanes::of_warp) {}

    /// While the launch before may still go on: nothing is read here, nor when it is made, that a
    /// launch writes.
    __device__ void open() { lanes_.open(true); }
    __device__ void turn() const {
        Segment const segment = exists_ ? sweep_.load(slot_) : Segment::zero();
        __syncwarp();  // all at once to the barrier
        wait_for_cluster();
        lanes_.turn(segment, restricted_, [&](auto const& ends) {
            if (exists_) sweep_.s.forces.store(first_, ends.first);
        });
    }

  private:
    Sweep const& sweep_;
    std::int64_t group_, first_;  // the lane's, and its first body
    bool exists_;
    std::int64_t slot_;
    int restricted_;
    Lanes lanes_;
};

/// Sweeps that go this way.
template <class Sweep>
constexpr bool turns_groups = Sweep::goes_short && by_groups<Sweep>;
template <class Sweep>
__global__ void __launch_bounds__(GroupLanes<Sweep>::most_threads)
    turn_groups(OneChain chain, GroupsView groups, Sweep sweep) {
    let_next_launch_start();
    GroupLanes<Sweep> warp(chain, groups, sweep, shared_numbers);
    touch(sweep);
    warp.open();
    wait_for_launch();
    warp.turn();
}

}  // namespace catena::cuda::kernels
