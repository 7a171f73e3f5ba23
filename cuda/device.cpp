#include <cuda_runtime_api.h>

#include "cuda/owners.hpp"
#include "cuda/solver.hpp"
#include "error.hpp"

namespace catena::cuda {

std::string const& why_not() {
    static std::string const reason = [] {
        int devices = 0;
        cudaError_t const status = cudaGetDeviceCount(&devices);
        if (status != cudaSuccess) return std::string("no GPU can be used: ") + cudaGetErrorString(status);
        return std::string(devices == 0 ? "there is no GPU" : "");
    }();
    return reason;
}

std::string version() {
    return std::to_string(CUDART_VERSION / 1000) + "." + std::to_string(CUDART_VERSION % 1000 / 10) + ", " +
           (why_not().empty() ? device_name() : why_not());
}

std::string device_name() {
    int device = 0;
    check(cudaGetDevice(&device), "say which it is");
    cudaDeviceProp properties;
    check(cudaGetDeviceProperties(&properties, device), "say what it is");
    return properties.name;
}

}  // namespace catena::cuda
