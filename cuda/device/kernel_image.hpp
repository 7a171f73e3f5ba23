// Whether this build's kernels can run on the present GPU.
#pragma once

#include <driver_types.h>

namespace catena::cuda {

/// cudaErrorNoKernelImageForDevice where the build is for other architectures.
cudaError_t status_of_kernel_image();

}  // namespace catena::cuda
