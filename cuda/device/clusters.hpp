// Limits of the present GPU on blocks that run concurrently: thread-block clusters (compute
// capability 9.0) and cooperative launches. Counters record how often the fused launches were used;
// tests read them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace catena::cuda {

/// True if the present GPU and the kernels that it runs support thread-block clusters. A build for
/// older architectures may run kernels without them on a newer GPU. Precondition: there is a GPU
/// and this build's kernels run on it.
bool knows_clusters();
/// Returns the largest shared memory of one block, bytes, after opting in.
std::size_t most_shared_bytes();
/// Returns the number of streaming multiprocessors of the present GPU.
int multiprocessors();
/// Returns the number of blocks that one cooperative launch can hold at once if each multiprocessor
/// has room for one. The result is 0 if the GPU has no cooperative launches or if other programs
/// share it (MPS).
int blocks_at_once();

/// Number of launches so far that took a short chain through both passes
/// (cuda/short/short_chain.cuh).
inline std::atomic<std::int64_t> short_launches = 0;
/// Number of launches so far whose blocks waited for the block above them
/// (cuda/sweeps/top_launch.cuh).
inline std::atomic<std::int64_t> turns_together = 0;
/// Number of launches so far of sweeps and of scans in which ranks exchanged between the inward and
/// the outward pass.
inline std::atomic<std::int64_t> turns_shared = 0, scans_shared = 0;
/// Number of launches so far in which one cluster took the tree above groups of runs through
/// both passes (cuda/sweeps/group_lanes.cuh).
inline std::atomic<std::int64_t> groups_turned = 0;

}  // namespace catena::cuda
