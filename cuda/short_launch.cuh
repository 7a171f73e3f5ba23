// The launch that takes a short chain up and down its tree (short_chain.cuh).
#pragma once

#include <cuda_runtime.h>

#include <map>

#include "cuda/clusters.hpp"
#include "cuda/owners.hpp"
#include "cuda/short_chain.cuh"

namespace catena::cuda {

template <class... Parameters>
void allow_shared(void (*kernel)(Parameters...), std::size_t bytes) {
    constexpr std::size_t without_asking = 48 << 10;
    if (bytes > without_asking)
        check(cudaFuncSetAttribute(reinterpret_cast<void const*>(kernel), cudaFuncAttributeMaxDynamicSharedMemorySize,
                                   static_cast<int>(bytes)),
              "have enough shared memory");
}

/// Of a tree, whose GPU and context it belongs to: what these say is asked for once.
class ShortLaunch {
  public:
    ShortLaunch() = default;
    /// `most_bytes`: of shared memory that the GPU gives a block.
    ShortLaunch(kernels::ShortChain const& chain, int most_bytes) : chain_(chain), most_bytes_(most_bytes) {}
    /// Whether the GPU takes it in one cluster; else nothing is done. What follows in the stream finds everything as after any launch.
    template <class Sweep>
    bool operator()(Sweep const& sweep, cudaStream_t stream) const {
        if (chain_.warps == 0) return false;
        void (*const kernel)(kernels::ShortChain, Sweep) = kernels::turn_short<Sweep>;
        Config const config(kernels::grid_of_short<Sweep>(chain_), stream);
        auto const [known, is_new] = fits_.try_emplace(reinterpret_cast<void const*>(kernel));
        if (is_new) known->second = fits(kernel, config);
        if (!known->second) return false;
        check(cudaLaunchKernelEx(&config.launch, kernel, chain_, sweep), "start a kernel");
        ++short_launches;
        return true;
    }

  private:
    struct Config {
        Config(kernels::ShortGrid const& grid, cudaStream_t stream) {
            attributes[0].id = cudaLaunchAttributeClusterDimension;
            attributes[0].val.clusterDim = {grid.blocks, 1, 1};
            attributes[1].id = cudaLaunchAttributeProgrammaticStreamSerialization;
            attributes[1].val.programmaticStreamSerializationAllowed = 1;
            launch.gridDim = {grid.blocks};
            launch.blockDim = {grid.threads};
            launch.dynamicSmemBytes = grid.shared_bytes;
            launch.stream = stream;
            launch.attrs = attributes;
            launch.numAttrs = graphs_know_early_launches() ? 2 : 1;
        }
        Config(Config const&) = delete;
        Config& operator=(Config const&) = delete;
        cudaLaunchAttribute attributes[2]{};
        cudaLaunchConfig_t launch{};
    };
    /// The toolkit's and the driver's.
    static bool graphs_know_early_launches() {
        constexpr int since = 12030;
        static bool const known = [] {
            int driver = 0;
            check(cudaDriverGetVersion(&driver), "say how new its driver is");
            return CUDART_VERSION >= since && driver >= since;
        }();
        return known;
    }
    template <class Kernel>
    bool fits(Kernel* kernel, Config const& config) const {
        if (config.launch.dynamicSmemBytes > static_cast<std::size_t>(most_bytes_)) return false;
        allow_shared(kernel, static_cast<std::size_t>(most_bytes_));  // always all: another tree's launch may need more than this one
        if (config.launch.gridDim.x <= kernels::most_in_cluster) return true;
        // More than any GPU that has clusters takes.
        check(cudaFuncSetAttribute(reinterpret_cast<void const*>(kernel), cudaFuncAttributeNonPortableClusterSizeAllowed, 1),
              "have large clusters");
        int clusters = 0;
        if (cudaOccupancyMaxActiveClusters(&clusters, kernel, &config.launch) == cudaSuccess) return clusters > 0;
        static_cast<void>(cudaGetLastError());
        return false;
    }

    kernels::ShortChain chain_;
    int most_bytes_ = 0;
    mutable std::map<void const*, bool> fits_;  // of each kind of sweep
};

}  // namespace catena::cuda
