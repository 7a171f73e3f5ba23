// Copies from memory to a block's shared memory that a thread starts and later waits for (compute
// capability 8.0; else made at once).
#pragma once

#include "math/host_device.hpp"

#if defined(__CUDACC__)
namespace catena::cuda::kernels {

__device__ inline void start_copy(double* to_shared, double const* from) {
#if __CUDA_ARCH__ >= 800
    asm volatile("cp.async.ca.shared.global [%0], [%1], 8;" ::"r"(
                     static_cast<unsigned>(__cvta_generic_to_shared(to_shared))),
                 "l"(from)
                 : "memory");
#else
    *to_shared = *from;
#endif
}
/// Those started since the last call go together.
__device__ inline void close_copies() {
#if __CUDA_ARCH__ >= 800
    asm volatile("cp.async.commit_group;" ::: "memory");
#endif
}
/// Until only so many of the last ones that went together are still on their way. For the thread
/// itself, not for others.
template <int left>
__device__ void wait_for_copies() {
#if __CUDA_ARCH__ >= 800
    asm volatile("cp.async.wait_group %0;" ::"n"(left) : "memory");
#endif
}

}  // namespace catena::cuda::kernels
#endif
