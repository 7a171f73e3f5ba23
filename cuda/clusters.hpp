// Clusters of blocks (compute capability 9.0), and what became of them.
#pragma once

#include <atomic>
#include <cstdint>

namespace catena::cuda {

/// Whether the present GPU and the kernels that it runs know them: these may be of a build for older GPUs. Precondition: there is a GPU,
/// and they run.
bool knows_clusters();

/// Launches so far that took a short chain up and down its tree (cuda/short_launch.cuh).
inline std::atomic<std::int64_t> short_launches = 0;

}  // namespace catena::cuda
