// Which blocks the present GPU runs at once: clusters (compute capability 9.0) and whole launches,
// and what became of them.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace catena::cuda {

/// Whether the present GPU and the kernels that it runs know them: these may be of a build for
/// older GPUs. Precondition: there is a GPU, and they run.
bool knows_clusters();
/// Of a block's shared memory, at most.
std::size_t most_shared_bytes();
/// Multiprocessors, and blocks that one launch surely has at once where they find room on one each;
/// 0: a launch cannot ask for that, or other programs have blocks there at the same time (MPS).
int multiprocessors();
int blocks_at_once();

/// Launches so far that took a short chain up and down its tree (cuda/short/short_chain.cuh).
inline std::atomic<std::int64_t> short_launches = 0;
/// And those whose blocks waited for the block above them (cuda/sweeps/top_launch.cuh).
inline std::atomic<std::int64_t> turns_together = 0;
/// Sweeps' and scans' launches so far in which ranks met between the ways up and down.
inline std::atomic<std::int64_t> turns_shared = 0, scans_shared = 0;
/// And of these scans those by a thread a body.
inline std::atomic<std::int64_t> shared_scans_by_bodies = 0;
/// Sweeps' launches so far in which warps joined groups of runs (cuda/sweeps/run_groups.hpp).
inline std::atomic<std::int64_t> launches_by_groups = 0;
/// And those of one cluster that took the tree above such groups up and down
/// (cuda/sweeps/group_lanes.cuh).
inline std::atomic<std::int64_t> groups_turned = 0;

}  // namespace catena::cuda
