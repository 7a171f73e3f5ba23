// Single launch with both passes of a chain that fits into one cluster of blocks. A warp
// merges eight runs; then every block merges the segments of all warps.
#pragma once

#include "cuda/short/short_lanes.cuh"
#include "cuda/short/short_teams.cuh"

namespace catena::cuda::kernels {

/// Implementation of a warp by the number of directions of the handles.
template <class Sweep>
using ShortWarp = std::conditional_t<Sweep::K == 1, ShortLanes<Sweep>, ShortTeams<Sweep>>;

/// Kernel of both passes of a short chain. The next launch may start before this one has ended, but
/// waits before it accesses memory.
template <class Sweep>
__global__ void __launch_bounds__(ShortWarp<Sweep>::most_threads)
    turn_short(OneChain chain, Sweep sweep) {
    let_next_launch_start();
    ShortWarp<Sweep> warp(chain, sweep, shared_numbers);
    touch(sweep);
    warp.open();
    wait_for_launch();
    warp.both_passes();
}

}  // namespace catena::cuda::kernels
