// Roles of the threads of a short chain's launch (short_chain.cuh).
#pragma once

#include "cuda/sweeps/one_chain.cuh"
#include "cuda/sweeps/run_parts.cuh"

namespace catena::cuda::kernels {

/// Role of one thread: a lane of a warp that merges the parts of `lanes_of_warp` lanes, or of an
/// auxiliary warp. Auxiliary warps compute the terms that need no neighbours, for all bodies
/// concurrently.
struct ShortThread {
    /// Members in order: bodies of the chain; lane in the warp; merging warps per block; warps with
    /// bodies per merging warp. Then follow three numbers: of the merging warp in the block
    /// (`group`), of this warp among those with bodies (`beside`), and of the merging warp in the
    /// chain.
    int bodies, lane, joining, warps_beside, group, beside, warp;
    std::int64_t first;  // first body of those that the lane merges

    /// `apart`: merging warps have no bodies of their own; their `beside` is -1.
    __device__ explicit ShortThread(OneChain const& chain, bool apart = false)
        : bodies(chain.bodies),
          lane(static_cast<int>(threadIdx.x) % lanes_of_warp),
          joining(joining_warps(chain)),
          warps_beside(static_cast<int>(blockDim.x) / lanes_of_warp / joining - (apart ? 1 : 0)),
          group(static_cast<int>(threadIdx.x) / lanes_of_warp % joining),
          beside(static_cast<int>(threadIdx.x) / lanes_of_warp / joining - (apart ? 1 : 0)),
          warp(static_cast<int>(blockIdx.x) * joining + group),
          first((static_cast<std::int64_t>(warp) * lanes_of_warp + lane) * dca::part_length) {}

    /// Number of bodies that lane `l` merges.
    __device__ int bodies_of(int l) const {
        int const left = bodies - first_of(l);
        return left < 0 ? 0 : left < dca::part_length ? left : dca::part_length;
    }
    /// First body that lane `l` merges.
    __device__ int first_of(int l) const { return (warp * lanes_of_warp + l) * dca::part_length; }
    __device__ bool is_here(int i, std::int64_t k) const {
        return i < dca::part_length && k < bodies;
    }
};

}  // namespace catena::cuda::kernels
