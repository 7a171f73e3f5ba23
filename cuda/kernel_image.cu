#include "cuda/kernel_image.hpp"

#include "cuda/clusters.hpp"
#include "cuda/owners.hpp"

namespace catena::cuda {
namespace {

__global__ void nothing() {}

}  // namespace

cudaError_t status_of_kernel_image() {
    cudaFuncAttributes attributes;
    return cudaFuncGetAttributes(&attributes, nothing);
}

bool knows_clusters() {
    int device = 0, clusters = 0;
    check(cudaGetDevice(&device), "say which it is");
    check(cudaDeviceGetAttribute(&clusters, cudaDevAttrClusterLaunch, device), "say whether it has clusters");
    cudaFuncAttributes attributes;
    return clusters != 0 && cudaFuncGetAttributes(&attributes, nothing) == cudaSuccess && attributes.ptxVersion >= 90;
}

}  // namespace catena::cuda
