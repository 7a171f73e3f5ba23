#include <cuda_runtime_api.h>

#include "cuda/kernel_image.hpp"
#include "cuda/owners.hpp"
#include "cuda/solver.hpp"
#include "error.hpp"

namespace catena::cuda {
namespace {

cudaDeviceProp properties() {
    int device = 0;
    check(cudaGetDevice(&device), "say which it is");
    cudaDeviceProp found;
    check(cudaGetDeviceProperties(&found, device), "say what it is");
    return found;
}

std::string look_for_a_gpu() {
    int devices = 0;
    cudaError_t const status = cudaGetDeviceCount(&devices);
    if (status != cudaSuccess) return std::string("no GPU can be used: ") + cudaGetErrorString(status);
    if (devices == 0) return "there is no GPU";
    if (cudaError_t const image = status_of_kernel_image(); image != cudaSuccess) {
        cudaGetLastError();  // that it stays behind would fail the next call
        cudaDeviceProp const gpu = properties();
        return std::string("no kernels for ") + gpu.name + " (" + cudaGetErrorString(image) +
               "; configure with -DCATENA_CUDA_ARCHITECTURES=" + std::to_string(10 * gpu.major + gpu.minor) + ")";
    }
    return "";
}

}  // namespace

std::string const& why_not() {
    static std::string const reason = look_for_a_gpu();
    return reason;
}

std::string version() {
    return std::to_string(CUDART_VERSION / 1000) + "." + std::to_string(CUDART_VERSION % 1000 / 10) + ", " +
           (why_not().empty() ? device_name() : why_not());
}

std::string device_name() { return properties().name; }

void choose_device(Communicator const& communicator) {
    int devices = 0;
    check(cudaGetDeviceCount(&devices), "be counted");
    check(cudaSetDevice(communicator.rank_on_host() % devices), "be chosen");
}

}  // namespace catena::cuda
