// The launch that takes a short chain up and down its tree (short_chain.cuh).
#pragma once

#include <map>

#include "cuda/clusters.hpp"
#include "cuda/launch.cuh"
#include "cuda/short_chain.cuh"

namespace catena::cuda {

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
        auto const [known, is_new] = fitting_.try_emplace(reinterpret_cast<void const*>(kernel));
        if (is_new) known->second = fitting<Sweep>(kernel, stream);
        if (known->second.blocks == 0) return false;
        EarlyLaunch(known->second, stream)(kernel, chain_, sweep);
        ++short_launches;
        return true;
    }

  private:
    /// Large clusters at first; none: there is no such grid.
    template <class Sweep, class Kernel>
    Grid fitting(Kernel* kernel, cudaStream_t stream) const {
        for (int const most : {kernels::most_blocks_of_short, kernels::most_in_cluster}) {
            if (chain_.warps > most * kernels::most_joining_warps) continue;
            kernels::ShortGrid const of = kernels::grid_of_short<Sweep>(chain_, most);
            Grid const grid{of.blocks, of.threads, of.shared_bytes, of.blocks};
            if (fits(kernel, EarlyLaunch(grid, stream).config())) return grid;
        }
        return {};
    }
    template <class Kernel>
    bool fits(Kernel* kernel, cudaLaunchConfig_t const& config) const {
        if (config.dynamicSmemBytes > static_cast<std::size_t>(most_bytes_)) return false;
        allow_shared(kernel, static_cast<std::size_t>(most_bytes_));  // always all: another tree's launch may need more than this one
        if (config.gridDim.x <= kernels::most_in_cluster) return true;
        // More than any GPU that has clusters takes.
        check(cudaFuncSetAttribute(reinterpret_cast<void const*>(kernel), cudaFuncAttributeNonPortableClusterSizeAllowed, 1),
              "have large clusters");
        int clusters = 0;
        if (cudaOccupancyMaxActiveClusters(&clusters, kernel, &config) == cudaSuccess) return clusters > 0;
        static_cast<void>(cudaGetLastError());
        return false;
    }

    kernels::ShortChain chain_;
    int most_bytes_ = 0;
    mutable std::map<void const*, Grid> fitting_;  // of each kind of sweep
};

}  // namespace catena::cuda
