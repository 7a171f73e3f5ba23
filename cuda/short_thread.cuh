// A short chain's launch (short_chain.cuh): who its threads are, and what its blocks give each other.
#pragma once

#include <bit>
#include <vector>

#include "cuda/cluster.cuh"
#include "cuda/quick.cuh"
#include "cuda/run_parts.cuh"

namespace catena::cuda::kernels {

constexpr unsigned whole_warp = 0xffffffff;
constexpr int lanes_of_warp = 32, most_joining_warps = 4, most_blocks_of_short = 16;
constexpr int bodies_of_warp = lanes_of_warp * dca::part_length;
/// Of those at the top every lane takes one or two.
constexpr int most_warps_of_short = 2 * lanes_of_warp;
static_assert(most_warps_of_short <= most_blocks_of_short * most_joining_warps);
static_assert(std::has_single_bit(static_cast<unsigned>(lanes_of_warp)));
/// Of a tree of pairs with so many leaves, a power of two.
constexpr int levels_above(int leaves) { return std::bit_width(static_cast<unsigned>(leaves)) - 1; }

/// `warps`, that join; none: there is none, or one that is not short.
struct ShortChain {
    int bodies = 0, warps = 0;
};
/// That of a tree of one whole chain whose tip is free, in runs as long as they get.
inline ShortChain short_chain_of(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels,
                                 std::vector<dca::Root> const& roots) {
    if (runs.empty() || roots.size() != 1 || roots.front().tip != dca::TipTo::nothing) return {};
    std::int64_t const bodies = runs.back().body + runs.back().count;
    std::size_t joined = 1;
    for (std::vector<dca::Merge> const& level : levels) joined += level.size();
    bool const whole = runs.front().body == 0 && joined == runs.size();
    bool const longest = (bodies + dca::longest_run - 1) / dca::longest_run == std::ssize(runs);
    if (!whole || !longest || bodies > most_warps_of_short * bodies_of_warp) return {};
    return {static_cast<int>(bodies), static_cast<int>((bodies + bodies_of_warp - 1) / bodies_of_warp)};
}

/// A lane of a warp that joins what `lanes_of_warp` parts of runs hold, or of one beside it: what needs no neighbour is done for all bodies
/// at once.
struct ShortThread {
    int bodies, lane, joining, warps_beside, group, beside, warp;  // `joining` warps of a block join; this one, the block's `group`-th
    std::int64_t first;                                            // body of what the lane joins

    /// `apart`: none of the warps that join has bodies, `beside` is -1.
    __device__ explicit ShortThread(ShortChain const& chain, bool apart = false)
        : bodies(chain.bodies),
          lane(static_cast<int>(threadIdx.x) % lanes_of_warp),
          joining((chain.warps + static_cast<int>(gridDim.x) - 1) / static_cast<int>(gridDim.x)),
          warps_beside(static_cast<int>(blockDim.x) / lanes_of_warp / joining - (apart ? 1 : 0)),
          group(static_cast<int>(threadIdx.x) / lanes_of_warp % joining),
          beside(static_cast<int>(threadIdx.x) / lanes_of_warp / joining - (apart ? 1 : 0)),
          warp(static_cast<int>(blockIdx.x) * joining + group),
          first((static_cast<std::int64_t>(warp) * lanes_of_warp + lane) * dca::part_length) {}

    /// Of what lane `l` joins.
    __device__ int bodies_of(int l) const {
        int const left = bodies - first_of(l);
        return left < 0 ? 0 : left < dca::part_length ? left : dca::part_length;
    }
    __device__ int first_of(int l) const { return (warp * lanes_of_warp + l) * dca::part_length; }
    __device__ bool is_here(int i, std::int64_t k) const { return i < dca::part_length && k < bodies; }
};

/// A record of `numbers` numbers to all blocks of the cluster, by a warp: its number n to at(n).
template <int numbers, class At>
__device__ void send_to_all(Inbox const& inbox, int lane, double const* record, At const& at) {
    constexpr int lanes_of_block = numbers <= lanes_of_warp / 4 ? lanes_of_warp / 4 : lanes_of_warp,
                  at_once = lanes_of_warp / lanes_of_block;
    auto const blocks = static_cast<int>(gridDim.x);
    for (int n = lane % lanes_of_block; n < numbers; n += lanes_of_block) {
        double const number = record[n];
    CATENA_UNROLL
        for (int first = 0; first < most_blocks_of_short; first += at_once)
            if (int const block = first + lane / lanes_of_block; block < blocks) inbox.send(block, at(n), number);
    }
}

}  // namespace catena::cuda::kernels
