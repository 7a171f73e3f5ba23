// The launch that takes a short chain up and down its tree (short_chain.cuh).
#pragma once

#include <cuda_runtime.h>

#include "cuda/owners.hpp"
#include "cuda/short_chain.cuh"

namespace catena::cuda {

namespace short_chain {

struct Config {
    template <class Sweep>
    Config(kernels::ShortChain const& chain, Sweep const&, cudaStream_t stream) : grid(kernels::grid_of_short<Sweep>(chain)) {
        attributes[0].id = cudaLaunchAttributeClusterDimension;
        attributes[0].val.clusterDim = {grid.blocks, 1, 1};
        attributes[1].id = cudaLaunchAttributeProgrammaticStreamSerialization;
        attributes[1].val.programmaticStreamSerializationAllowed = 1;
        launch.gridDim = {grid.blocks};
        launch.blockDim = {grid.threads};
        launch.dynamicSmemBytes = grid.shared_bytes;
        launch.stream = stream;
        launch.attrs = attributes;
        constexpr int graphs_know_early_launches = 12030;
        launch.numAttrs = CUDART_VERSION >= graphs_know_early_launches ? 2 : 1;
    }
    Config(Config const&) = delete;
    Config& operator=(Config const&) = delete;
    bool large() const { return grid.blocks > kernels::most_in_cluster; }
    kernels::ShortGrid grid;
    cudaLaunchAttribute attributes[2]{};
    cudaLaunchConfig_t launch{};
};

}  // namespace short_chain

/// Whether the GPU takes it in one cluster; else nothing is done. `most_bytes`: of shared memory that it gives a block. What follows in the
/// stream finds everything as after any launch.
template <class Sweep>
bool launch_short(kernels::ShortChain const& chain, int most_bytes, Sweep const& sweep, cudaStream_t stream) {
    if (chain.warps == 0) return false;
    void (*const kernel)(kernels::ShortChain, Sweep) = kernels::turn_short<Sweep>;
    auto const set = [&](cudaFuncAttribute what, std::size_t to) {
        check(cudaFuncSetAttribute(reinterpret_cast<void const*>(kernel), what, static_cast<int>(to)), "have enough room");
    };
    short_chain::Config const config(chain, sweep, stream);
    if (config.grid.shared_bytes > static_cast<std::size_t>(most_bytes)) return false;
    set(cudaFuncAttributeMaxDynamicSharedMemorySize, config.grid.shared_bytes);
    if (config.large()) {  // more than any GPU that has clusters takes
        set(cudaFuncAttributeNonPortableClusterSizeAllowed, 1);
        int clusters = 0;
        if (cudaOccupancyMaxActiveClusters(&clusters, kernel, &config.launch) != cudaSuccess || clusters == 0) {
            static_cast<void>(cudaGetLastError());
            return false;
        }
    }
    check(cudaLaunchKernelEx(&config.launch, kernel, chain, sweep), "start a kernel");
    return true;
}

}  // namespace catena::cuda
