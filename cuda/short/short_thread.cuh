// Who the threads of a short chain's launch are (short_chain.cuh).
#pragma once

#include "cuda/sweeps/one_chain.cuh"
#include "cuda/sweeps/run_parts.cuh"

namespace catena::cuda::kernels {

/// A lane of a warp that joins what `lanes_of_warp` parts of runs hold, or of one beside it: what
/// needs no neighbour is done for all bodies at once.
struct ShortThread {
    int bodies, lane, joining, warps_beside, group, beside,
        warp;            // `joining` warps of a block join; this one, the block's `group`-th
    std::int64_t first;  // body of what the lane joins

    /// `apart`: none of the warps that join has bodies, `beside` is -1.
    __device__ explicit ShortThread(OneChain const& chain, bool apart = false)
        : bodies(chain.bodies),
          lane(static_cast<int>(threadIdx.x) % lanes_of_warp),
          joining(joining_warps(chain)),
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
    __device__ bool is_here(int i, std::int64_t k) const {
        return i < dca::part_length && k < bodies;
    }
};

}  // namespace catena::cuda::kernels
