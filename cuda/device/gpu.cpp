// Implements the selection of a GPU and the queries of its properties.
#include <cuda_runtime_api.h>

#include "cuda/device/gpu.hpp"
#include "cuda/device/kernel_image.hpp"
#include "cuda/device/owners.hpp"
#include "error.hpp"

namespace catena::cuda {
namespace {

cudaDeviceProp properties() {
    int device = 0;
    check(cudaGetDevice(&device), "report its number");
    cudaDeviceProp found;
    check(cudaGetDeviceProperties(&found, device), "report its properties");
    return found;
}

std::string look_for_a_gpu() {
    int devices = 0;
    cudaError_t const status = cudaGetDeviceCount(&devices);
    if (status != cudaSuccess)
        return std::string("no GPU can be used: ") + cudaGetErrorString(status);
    return devices == 0 ? "there is no GPU" : "";
}

/// True if CUDA reports that the build has no kernels for this architecture.
bool lacks_kernels(cudaError_t status) {
    return status == cudaErrorNoKernelImageForDevice || status == cudaErrorInvalidKernelImage ||
           status == cudaErrorUnsupportedPtxVersion;
}

}  // namespace

std::string const& why_not() {
    static std::string const reason = look_for_a_gpu();
    return reason;
}

std::string version() {
    return std::to_string(CUDART_VERSION / 1000) + "." +
           std::to_string(CUDART_VERSION % 1000 / 10) + ", " +
           (why_not().empty() ? device_name() : why_not());
}

std::string device_name() { return properties().name; }

int devices() {
    int found = 0;
    check(cudaGetDeviceCount(&found), "be counted");
    return found;
}

std::string choose_device(Communicator const& communicator) {
    cudaError_t status = cudaSetDevice(communicator.rank_on_host() % devices());
    if (status == cudaSuccess) status = status_of_kernel_image();
    if (status == cudaSuccess) return "";
    cudaGetLastError();  // otherwise the next call would report this error
    std::string const reason = "no use of " + device_name() + ": " + cudaGetErrorString(status);
    if (!lacks_kernels(status)) return reason;
    cudaDeviceProp const gpu = properties();
    return reason + "; configure with -DCATENA_CUDA_ARCHITECTURES=" +
           std::to_string(10 * gpu.major + gpu.minor);
}

std::int64_t free_memory(Communicator const& communicator) {
    std::size_t free = 0, all = 0;
    check(cudaMemGetInfo(&free, &all), "report its free memory");
    int const gpus = devices(), sharing = (communicator.ranks_on_host() + gpus - 1) / gpus;
    return static_cast<std::int64_t>(free) / sharing;
}

std::int64_t stacks(std::int64_t bytes_of_thread) {
    int device = 0, multiprocessors = 0, threads = 0;
    check(cudaGetDevice(&device), "report its number");
    check(cudaDeviceGetAttribute(&multiprocessors, cudaDevAttrMultiProcessorCount, device),
          "report its size");
    check(cudaDeviceGetAttribute(&threads, cudaDevAttrMaxThreadsPerMultiProcessor, device),
          "report its size");
    return bytes_of_thread * multiprocessors * threads;
}

}  // namespace catena::cuda
