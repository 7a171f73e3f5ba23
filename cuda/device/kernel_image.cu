// Implements the compatibility check and the device limits of clusters.hpp.
#include "cuda/device/kernel_image.hpp"

#include "cuda/device/clusters.hpp"
#include "cuda/device/owners.hpp"

namespace catena::cuda {
namespace {

/// Empty kernel whose attributes tell for which architecture the build was compiled.
__global__ void nothing() {}

}  // namespace

cudaError_t status_of_kernel_image() {
    cudaFuncAttributes attributes;
    return cudaFuncGetAttributes(&attributes, nothing);
}

bool knows_clusters() {
    int device = 0, clusters = 0;
    check(cudaGetDevice(&device), "report its number");
    check(cudaDeviceGetAttribute(&clusters, cudaDevAttrClusterLaunch, device),
          "report its clusters");
    cudaFuncAttributes attributes;
    return clusters != 0 && cudaFuncGetAttributes(&attributes, nothing) == cudaSuccess &&
           attributes.ptxVersion >= 90;
}

std::size_t most_shared_bytes() {
    int device = 0, bytes = 0;
    check(cudaGetDevice(&device), "report its number");
    check(cudaDeviceGetAttribute(&bytes, cudaDevAttrMaxSharedMemoryPerBlockOptin, device),
          "report its size");
    return static_cast<std::size_t>(bytes);
}

int multiprocessors() {
    int device = 0, count = 0;
    check(cudaGetDevice(&device), "report its number");
    check(cudaDeviceGetAttribute(&count, cudaDevAttrMultiProcessorCount, device),
          "report its size");
    return count;
}

int blocks_at_once() {
    int device = 0, can = 0;
    check(cudaGetDevice(&device), "report its number");
    check(cudaDeviceGetAttribute(&can, cudaDevAttrCooperativeLaunch, device),
          "report its cooperative launches");
    int shared = 0;
#if CUDART_VERSION >= 12050
    check(cudaDeviceGetAttribute(&shared, cudaDevAttrMpsEnabled, device),
          "report whether programs share it (MPS)");
#endif
    return can != 0 && shared == 0 ? multiprocessors() : 0;
}

}  // namespace catena::cuda
