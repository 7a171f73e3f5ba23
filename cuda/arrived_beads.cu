#include "cuda/gpu_path.hpp"
#include "cuda/kernels.cuh"

namespace catena::cuda {

void put(std::int64_t count, ArrivedBeads const& arrived, cudaStream_t stream) {
    if (count == 0) return;
    auto const blocks = static_cast<unsigned>((gpu_order::padded(count) + kernels::threads - 1) / kernels::threads);
    kernels::for_each<<<blocks, kernels::threads, 0, stream>>>(count, arrived);
    check(cudaGetLastError(), "start a kernel");
}

}  // namespace catena::cuda
