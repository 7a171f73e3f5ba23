// Kernel launches that may start before the previous launch of their stream has ended (programmatic
// dependent launch).
#pragma once

#include <cuda_runtime.h>

#include <cstddef>
#include <type_traits>

#include "cuda/device/clusters.hpp"
#include "cuda/device/owners.hpp"

namespace catena::cuda {

/// Dimensions and properties of one launch.
struct Grid {
    unsigned blocks = 0, threads = 0;
    std::size_t shared_bytes = 0;
    unsigned of_cluster = 0;   // blocks per cluster; 0: no clusters
    bool all_at_once = false;  // cooperative launch: blocks wait for each other
};

/// True if the GPU, its driver and the kernels support early launches (compute capability 9.0) and
/// CUDA graphs keep them. CUDA and its driver must be 12.3 or newer.
inline bool early_launches_are_known() {
    constexpr int since = 12030;
    static bool const known = [] {
        int driver = 0;
        check(cudaDriverGetVersion(&driver), "report its driver version");
        return CUDART_VERSION >= since && driver >= since && knows_clusters();
    }();
    return known;
}

/// Launch configuration of a grid for cudaLaunchKernelEx and for occupancy queries.
class EarlyLaunch {
  public:
    EarlyLaunch(Grid const& grid, cudaStream_t stream) {
        auto const add = [&]() -> cudaLaunchAttribute& { return attributes_[config_.numAttrs++]; };
        if (grid.of_cluster > 0) {
            cudaLaunchAttribute& cluster = add();
            cluster.id = cudaLaunchAttributeClusterDimension;
            cluster.val.clusterDim = {grid.of_cluster, 1, 1};
        }
        if (grid.all_at_once) {
            cudaLaunchAttribute& at_once = add();
            at_once.id = cudaLaunchAttributeCooperative;
            at_once.val.cooperative = 1;
        }
        if (early_launches_are_known()) {
            cudaLaunchAttribute& early = add();
            early.id = cudaLaunchAttributeProgrammaticStreamSerialization;
            early.val.programmaticStreamSerializationAllowed = 1;
        }
        config_.gridDim = {grid.blocks};
        config_.blockDim = {grid.threads};
        config_.dynamicSmemBytes = grid.shared_bytes;
        config_.stream = stream;
        config_.attrs = attributes_;
    }
    EarlyLaunch(EarlyLaunch const&) = delete;
    EarlyLaunch& operator=(EarlyLaunch const&) = delete;
    cudaLaunchConfig_t const& config() const { return config_; }

    /// Launches the kernel. Precondition: every thread of the kernel calls wait_for_launch()
    /// (cuda/device/cluster.cuh). It does so before it reads what other launches write, before it
    /// writes what they read, and before it ends.
    template <class... Parameters>
    void operator()(void (*kernel)(Parameters...),
                    std::type_identity_t<Parameters> const&... arguments) const {
        check(cudaLaunchKernelEx(&config_, kernel, arguments...), "start a kernel");
    }

  private:
    cudaLaunchAttribute attributes_[3]{};
    cudaLaunchConfig_t config_{};
};

/// Launches `kernel` on `stream`, with the precondition of EarlyLaunch::operator().
template <class... Parameters>
void launch(Grid const& grid, cudaStream_t stream, void (*kernel)(Parameters...),
            std::type_identity_t<Parameters> const&... arguments) {
    EarlyLaunch(grid, stream)(kernel, arguments...);
}

/// Permits `kernel` to use `bytes` of dynamic shared memory; above 48 KiB CUDA requires this.
template <class... Parameters>
void allow_shared(void (*kernel)(Parameters...), std::size_t bytes) {
    constexpr std::size_t without_asking = 48 << 10;
    if (bytes > without_asking)
        check(cudaFuncSetAttribute(reinterpret_cast<void const*>(kernel),
                                   cudaFuncAttributeMaxDynamicSharedMemorySize,
                                   static_cast<int>(bytes)),
              "provide enough shared memory");
}

}  // namespace catena::cuda
