// Asynchronous copies from global memory to a block's shared memory, started by a thread and
// awaited later. Below compute capability 8.0 the copy is made at once.
#pragma once

#include "math/host_device.hpp"

#if defined(__CUDACC__)
namespace catena::cuda::kernels {

/// Starts a copy of one double.
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
/// Closes a group: the copies that this thread started since the last call.
__device__ inline void close_copies() {
#if __CUDA_ARCH__ >= 800
    asm volatile("cp.async.commit_group;" ::: "memory");
#endif
}
/// Waits until at most `left` of this thread's latest groups are still in flight. Copies of other
/// threads are not awaited.
template <int left>
__device__ void wait_for_copies() {
#if __CUDA_ARCH__ >= 800
    asm volatile("cp.async.wait_group %0;" ::"n"(left) : "memory");
#endif
}

}  // namespace catena::cuda::kernels
#endif
