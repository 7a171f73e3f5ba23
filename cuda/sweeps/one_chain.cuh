// One whole chain whose two passes are performed by a launch of one cluster. This file divides the
// chain among the lanes of warps and defines what blocks exchange.
#pragma once

#include <bit>
#include <vector>

#include "cuda/device/cluster.cuh"
#include "tree/tree.hpp"

namespace catena::cuda::kernels {

/// Mask of all lanes of a warp.
constexpr unsigned whole_warp = 0xffffffff;
/// Lanes per warp, and limits of a cluster: merging warps per block and blocks per chain.
constexpr int lanes_of_warp = 32, most_joining_warps = 4, most_blocks_of_chain = 16;
/// Largest number of merging warps of a chain. At the top every lane holds the segments of one or
/// two of them.
constexpr int most_warps_of_chain = 2 * lanes_of_warp;
static_assert(most_warps_of_chain <= most_blocks_of_chain * most_joining_warps);
static_assert(std::has_single_bit(static_cast<unsigned>(lanes_of_warp)));
/// Number of levels of a pairwise tree with `leaves` leaves, a power of two.
constexpr int levels_above(int leaves) { return std::bit_width(static_cast<unsigned>(leaves)) - 1; }

/// Chain of a launch: its bodies and the number of warps that merge what their lanes hold. No
/// warps: there is no single chain, or it is too long.
struct OneChain {
    int bodies = 0, warps = 0;
};
/// Returns the chain of a tree that consists of one whole chain with a free tip and runs of maximal
/// length. A lane holds `of_lane` bodies.
inline OneChain one_chain_of(std::vector<dca::Run> const& runs,
                             std::vector<std::vector<dca::Merge>> const& levels,
                             std::vector<dca::Root> const& roots, std::int64_t of_lane) {
    if (runs.empty() || roots.size() != 1 || roots.front().tip != dca::TipTo::nothing) return {};
    std::int64_t const bodies = runs.back().body + runs.back().count,
                       of_warp = lanes_of_warp * of_lane;
    std::size_t joined = 1;
    for (std::vector<dca::Merge> const& level : levels) joined += level.size();
    bool const whole = runs.front().body == 0 && joined == runs.size();
    bool const longest = (bodies + dca::longest_run - 1) / dca::longest_run == std::ssize(runs);
    if (!whole || !longest || bodies > most_warps_of_chain * of_warp) return {};
    return {static_cast<int>(bodies), static_cast<int>((bodies + of_warp - 1) / of_warp)};
}

/// Dimensions of a launch of one cluster.
struct ClusterGrid {
    unsigned blocks = 0, threads = 0;
    std::size_t shared_bytes = 0;
};
/// Returns the grid with as few warps per block as possible, so that each has a larger share of a
/// multiprocessor. `most`: blocks per cluster. `Warp`: type of the merging warps, with
/// warps_for_each(joining) and numbers(joining, warps) like ShortLanes. Precondition: four merging
/// warps per block are enough.
template <class Warp>
ClusterGrid grid_of_cluster(OneChain const& chain, int most) {
    int const joining = (chain.warps + most - 1) / most,
              blocks = (chain.warps + joining - 1) / joining;
    return {static_cast<unsigned>(blocks),
            static_cast<unsigned>(lanes_of_warp * joining * Warp::warps_for_each(joining)),
            sizeof(double) * Warp::numbers(joining, chain.warps)};
}
/// Number of merging warps of a block of the launch.
__device__ inline int joining_warps(OneChain const& chain) {
    return (chain.warps + static_cast<int>(gridDim.x) - 1) / static_cast<int>(gridDim.x);
}

/// True if one warp merges the whole chain. It then writes its segment to its own shared memory.
/// Its block is alone in its cluster, and NVIDIA's memory checker rejects a block's messages to
/// itself there.
__device__ inline bool is_alone(OneChain const& chain) { return chain.warps == 1; }

/// Sends a record of `numbers` numbers from a warp to all blocks of the cluster: number n to at(n).
template <int numbers, class At>
__device__ void send_to_all(OneChain const& chain, Inbox const& inbox, int lane,
                            double const* record, At const& at) {
    constexpr int lanes_of_block = numbers <= lanes_of_warp / 4 ? lanes_of_warp / 4 : lanes_of_warp,
                  at_once = lanes_of_warp / lanes_of_block;
    if (is_alone(chain)) {
        for (int n = lane; n < numbers; n += lanes_of_warp) *at(n) = record[n];
        __syncwarp();
        return;
    }
    auto const blocks = static_cast<int>(gridDim.x);
    for (int n = lane % lanes_of_block; n < numbers; n += lanes_of_block) {
        double const number = record[n];
        CATENA_UNROLL
        for (int first = 0; first < most_blocks_of_chain; first += at_once)
            if (int const block = first + lane / lanes_of_block; block < blocks)
                inbox.send(block, at(n), number);
    }
}

}  // namespace catena::cuda::kernels
