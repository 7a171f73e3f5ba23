// Compatibility check between this build's kernels and the present GPU.
#pragma once

#include <driver_types.h>

namespace catena::cuda {

/// Returns cudaErrorNoKernelImageForDevice if this build was compiled for other architectures.
cudaError_t status_of_kernel_image();

}  // namespace catena::cuda
