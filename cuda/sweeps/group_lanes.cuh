// Single launch with both passes of the tree above groups of runs (run_groups.cuh) of one chain:
// one lane per group.
#pragma once

#include "cuda/sweeps/joined_lanes.cuh"
#include "cuda/sweeps/run_groups.cuh"

namespace catena::cuda::kernels {

/// Work of one warp, in its block's shared memory.
template <class Sweep>
class GroupLanes {
    using Segment = typename Sweep::Segment;
    using Lanes = JoinedLanes<Sweep, bodies_of_group, 1>;

  public:
    static constexpr int most_threads = most_joining_warps * lanes_of_warp;
    static constexpr int warps_for_each(int /*joining*/) { return 1; }
    /// Returns the size of a block's shared memory in doubles; see ShortLanes::numbers().
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

    /// Prepares the launch while the previous one may still run. Neither this call nor the
    /// constructor reads memory that a launch writes.
    __device__ void open() { lanes_.open(true); }
    /// Performs both passes and stores the forces at the first joint of each group.
    __device__ void both_passes() const {
        Segment const segment = exists_ ? sweep_.load(slot_) : Segment::zero();
        __syncwarp();  // all lanes arrive at the barrier together
        wait_for_cluster();
        lanes_.both_passes(segment, restricted_, [&](auto const& ends) {
            if (exists_) sweep_.s.forces.store(first_, ends.first);
        });
    }

  private:
    Sweep const& sweep_;
    std::int64_t group_, first_;  // the lane's group and its first body
    bool exists_;
    std::int64_t slot_;
    int restricted_;
    Lanes lanes_;
};

/// True for sweeps that use this launch.
template <class Sweep>
constexpr bool turns_groups = Sweep::supports_short_chains && by_groups<Sweep>;
/// Kernel of both passes above the groups of one chain.
template <class Sweep>
__global__ void __launch_bounds__(GroupLanes<Sweep>::most_threads)
    turn_groups(OneChain chain, GroupsView groups, Sweep sweep) {
    let_next_launch_start();
    GroupLanes<Sweep> warp(chain, groups, sweep, shared_numbers);
    touch(sweep);
    warp.open();
    wait_for_launch();
    warp.both_passes();
}

}  // namespace catena::cuda::kernels
