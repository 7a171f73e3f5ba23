// What threads of a warp and blocks of a cluster (compute capability 9.0) give each other.
#pragma once

#include <cstdint>

#include "dca/linear.hpp"

namespace catena::cuda::kernels {

constexpr int most_in_cluster = 8;  // any GPU that has clusters takes so many blocks

template <class T>
inline constexpr int numbers_of = static_cast<int>(sizeof(T) / sizeof(double));
template <class T>
using NumbersOf = Vector<double, numbers_of<T>>;

/// What lane `from` of the warp has. All lanes must come here.
template <class T>
__device__ T from_lane(T const& value, int from) {
    auto numbers = __builtin_bit_cast(NumbersOf<T>, value);
    CATENA_UNROLL
    for (double& v : numbers.data) v = __shfl_sync(0xffffffffu, v, from);
    return __builtin_bit_cast(T, numbers);
}

#if defined(__CUDACC__)

/// A place in a block's shared memory where other blocks of its cluster leave numbers, and which knows when all of them have come.
class Inbox {
  public:
    __device__ explicit Inbox(std::uint64_t* arrived) : arrived_(address(arrived)) {}
    /// By one thread, before any block sends.
    __device__ void open(int bytes) const {
#if __CUDA_ARCH__ >= 900
        asm volatile("mbarrier.init.shared::cta.b64 [%0], 1;\n\tfence.mbarrier_init.release.cluster;" ::"r"(arrived_) : "memory");
        asm volatile("mbarrier.arrive.expect_tx.shared::cta.b64 _, [%0], %1;" ::"r"(arrived_), "r"(bytes) : "memory");
#endif
    }
    /// To the same place `at` in a block's memory.
    __device__ void send(int block, double* at, double value) const {
#if __CUDA_ARCH__ >= 900
        asm volatile(
            "{\n\t.reg .b32 to, arrived;\n\tmapa.shared::cluster.u32 to, %0, %2;\n\tmapa.shared::cluster.u32 arrived, %1, %2;\n\t"
            "st.async.shared::cluster.mbarrier::complete_tx::bytes.b64 [to], %3, [arrived];\n\t}" ::"r"(address(at)),
            "r"(arrived_), "r"(block), "l"(__double_as_longlong(value))
            : "memory");
#endif
    }
    __device__ void wait() const {
#if __CUDA_ARCH__ >= 900
        asm volatile(
            "{\n\t.reg .pred all;\n\tWAIT:\n\tmbarrier.try_wait.parity.acquire.cluster.shared::cta.b64 all, [%0], 0;\n\t@!all bra WAIT;\n\t}" ::"r"(
                arrived_)
            : "memory");
#endif
    }

  private:
    __device__ static std::uint32_t address(void const* shared) { return static_cast<std::uint32_t>(__cvta_generic_to_shared(shared)); }
    std::uint32_t arrived_;
};

/// In two halves, so that there is work between them.
__device__ inline void arrive_at_cluster() {
#if __CUDA_ARCH__ >= 900
    asm volatile("barrier.cluster.arrive.release.aligned;" ::: "memory");
#endif
}
__device__ inline void wait_for_cluster() {
#if __CUDA_ARCH__ >= 900
    asm volatile("barrier.cluster.wait.acquire.aligned;" ::: "memory");
#endif
}
/// Other launches of the stream that say so may start before the last one has ended: what it wrote is there after wait_for_launch().
__device__ inline void let_next_launch_start() {
#if __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.launch_dependents;" ::: "memory");
#endif
}
__device__ inline void wait_for_launch() {
#if __CUDA_ARCH__ >= 900
    asm volatile("griddepcontrol.wait;" ::: "memory");
#endif
}

#endif

/// All blocks of a cluster have come here, and see what the others wrote before.
__device__ inline void meet_cluster() {
    __syncthreads();
    arrive_at_cluster();
    wait_for_cluster();
}

}  // namespace catena::cuda::kernels
