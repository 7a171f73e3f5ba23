// One chain that fits into one cluster of blocks, up and down its tree in one launch: a warp joins eight runs, and what all warps hold is
// joined once more in every block.
#pragma once

#include "cuda/short_lanes.cuh"
#include "cuda/short_teams.cuh"

namespace catena::cuda::kernels {

template <class Sweep>
using ShortWarp = std::conditional_t<Sweep::K == 1, ShortLanes<Sweep>, ShortTeams<Sweep>>;

struct ShortGrid {
    unsigned blocks = 0, threads = 0;
    std::size_t shared_bytes = 0;
};
/// As few warps a block as there may be: each then has more of a multiprocessor. `most`: blocks of a cluster.
/// Precondition: with four warps a block they are enough.
template <class Sweep>
ShortGrid grid_of_short(ShortChain const& chain, int most) {
    int const joining = (chain.warps + most - 1) / most, blocks = (chain.warps + joining - 1) / joining;
    return {static_cast<unsigned>(blocks), static_cast<unsigned>(lanes_of_warp * joining * ShortWarp<Sweep>::warps_for_each(joining)),
            sizeof(double) * ShortWarp<Sweep>::numbers(joining, chain.warps)};
}
/// The next early launch may start before this one has ended; what it reads and writes waits.
template <class Sweep>
__global__ void __launch_bounds__(ShortWarp<Sweep>::most_threads) turn_short(ShortChain chain, Sweep sweep) {
    let_next_launch_start();
    ShortWarp<Sweep> warp(chain, sweep, shared_numbers);
    touch(sweep);
    warp.open();
    wait_for_launch();
    warp.turn();
}

}  // namespace catena::cuda::kernels
