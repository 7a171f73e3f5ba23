// One chain that fits into one cluster of blocks, up and down its tree in one launch: a warp joins
// eight runs, and what all warps hold is joined once more in every block.
#pragma once

#include "cuda/short/short_lanes.cuh"
#include "cuda/short/short_teams.cuh"

namespace catena::cuda::kernels {

template <class Sweep>
using ShortWarp = std::conditional_t<Sweep::K == 1, ShortLanes<Sweep>, ShortTeams<Sweep>>;

/// The next early launch may start before this one has ended; what it reads and writes waits.
template <class Sweep>
__global__ void __launch_bounds__(ShortWarp<Sweep>::most_threads)
    turn_short(OneChain chain, Sweep sweep) {
    let_next_launch_start();
    ShortWarp<Sweep> warp(chain, sweep, shared_numbers);
    touch(sweep);
    warp.open();
    wait_for_launch();
    warp.turn();
}

}  // namespace catena::cuda::kernels
