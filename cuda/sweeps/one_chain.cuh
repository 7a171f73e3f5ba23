// One whole chain that a launch of one cluster takes up and down its tree: how warps' lanes share
// it, and what its blocks give each other.
#pragma once

#include <bit>
#include <vector>

#include "cuda/device/cluster.cuh"
#include "tree/tree.hpp"

namespace catena::cuda::kernels {

constexpr unsigned whole_warp = 0xffffffff;
constexpr int lanes_of_warp = 32, most_joining_warps = 4, most_blocks_of_chain = 16;
/// Of those at the top every lane takes one or two.
constexpr int most_warps_of_chain = 2 * lanes_of_warp;
static_assert(most_warps_of_chain <= most_blocks_of_chain * most_joining_warps);
static_assert(std::has_single_bit(static_cast<unsigned>(lanes_of_warp)));
/// Of a tree of pairs with so many leaves, a power of two.
constexpr int levels_above(int leaves) { return std::bit_width(static_cast<unsigned>(leaves)) - 1; }

/// `warps`, that join what their lanes hold; none: there is no such chain, or one that is too long.
struct OneChain {
    int bodies = 0, warps = 0;
};
/// That of a tree of one whole chain whose tip is free, in runs as long as they get. A lane has
/// `of_lane` bodies.
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

struct ClusterGrid {
    unsigned blocks = 0, threads = 0;
    std::size_t shared_bytes = 0;
};
/// As few warps a block as there may be: each then has more of a multiprocessor. `most`: blocks of
/// a cluster. `Warp`: of those that join, with warps_for_each(joining) and numbers(joining, warps)
/// as ShortLanes'. Precondition: with four warps a block they are enough.
template <class Warp>
ClusterGrid grid_of_cluster(OneChain const& chain, int most) {
    int const joining = (chain.warps + most - 1) / most,
              blocks = (chain.warps + joining - 1) / joining;
    return {static_cast<unsigned>(blocks),
            static_cast<unsigned>(lanes_of_warp * joining * Warp::warps_for_each(joining)),
            sizeof(double) * Warp::numbers(joining, chain.warps)};
}
/// Of a block of the launch.
__device__ inline int joining_warps(OneChain const& chain) {
    return (chain.warps + static_cast<int>(gridDim.x) - 1) / static_cast<int>(gridDim.x);
}

/// One warp that joins keeps what it gives: its block is alone in its cluster, and NVIDIA's checker
/// of memory refuses messages of a block to itself there.
__device__ inline bool is_alone(OneChain const& chain) { return chain.warps == 1; }

/// A record of `numbers` numbers to all blocks of the cluster, by a warp: its number n to at(n).
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
            if (int const block = first + lane / lanes_of_block; block < blocks) inbox.send(block, at(n), number);
    }
}

}  // namespace catena::cuda::kernels
