// Whether this build's kernels can run on the present GPU.
#pragma once

#include <driver_types.h>

namespace catena::cuda {

/// cudaErrorNoKernelImageForDevice where the build is for other architectures.
cudaError_t status_of_kernel_image();
/// Whether the kernels that the present GPU runs know clusters of blocks: they may be of a build for older GPUs. Precondition: they run.
bool kernels_know_clusters();

}  // namespace catena::cuda
