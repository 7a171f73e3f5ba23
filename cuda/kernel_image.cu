#include "cuda/kernel_image.hpp"

namespace catena::cuda {
namespace {

__global__ void nothing() {}

}  // namespace

cudaError_t status_of_kernel_image() {
    cudaFuncAttributes attributes;
    return cudaFuncGetAttributes(&attributes, nothing);
}

bool kernels_know_clusters() {
    cudaFuncAttributes attributes;
    return cudaFuncGetAttributes(&attributes, nothing) == cudaSuccess && attributes.ptxVersion >= 90;
}

}  // namespace catena::cuda
