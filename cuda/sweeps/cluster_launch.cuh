// Launches of one cluster that take one chain up and down its tree (one_chain.cuh).
#pragma once

#include <map>

#include "cuda/device/clusters.hpp"
#include "cuda/device/launch.cuh"
#include "cuda/sweeps/one_chain.cuh"

namespace catena::cuda {

/// Of a tree, whose GPU and context it belongs to: what these say is asked for once.
class ClusterLaunch {
  public:
    ClusterLaunch() = default;
    /// `most_bytes`: of shared memory that the GPU gives a block.
    ClusterLaunch(kernels::OneChain const& chain, int most_bytes)
        : chain_(chain), most_bytes_(most_bytes) {}
    explicit operator bool() const { return chain_.warps > 0; }
    /// The grid of a kernel whose blocks join by such warps (grid_of_cluster()); of no blocks where
    /// the GPU does not take the chain in one cluster.
    template <class Warp, class... Parameters>
    Grid const& grid(void (*kernel)(kernels::OneChain, Parameters...)) const {
        auto const [known, is_new] = grids_.try_emplace(reinterpret_cast<void const*>(kernel));
        if (is_new && *this) known->second = found<Warp>(kernel);
        return known->second;
    }
    /// What follows in the stream finds everything as after any launch.
    template <class... Parameters>
    void launch(Grid const& grid, cudaStream_t stream,
                void (*kernel)(kernels::OneChain, Parameters...),
                std::type_identity_t<Parameters> const&... arguments) const {
        EarlyLaunch(grid, stream)(kernel, chain_, arguments...);
    }

  private:
    /// Large clusters at first.
    template <class Warp, class Kernel>
    Grid found(Kernel* kernel) const {
        for (int const most : {kernels::most_blocks_of_chain, kernels::most_in_cluster}) {
            if (chain_.warps > most * kernels::most_joining_warps) continue;
            kernels::ClusterGrid const of = kernels::grid_of_cluster<Warp>(chain_, most);
            Grid const grid{of.blocks, of.threads, of.shared_bytes, of.blocks};
            if (takes(kernel, EarlyLaunch(grid, nullptr).config())) return grid;
        }
        return {};
    }
    template <class Kernel>
    bool takes(Kernel* kernel, cudaLaunchConfig_t const& config) const {
        if (config.dynamicSmemBytes > static_cast<std::size_t>(most_bytes_)) return false;
        allow_shared(
            kernel,
            static_cast<std::size_t>(
                most_bytes_));  // always all: another tree's launch may need more than this one
        if (config.gridDim.x <= kernels::most_in_cluster) return true;
        // More than any GPU that has clusters takes.
        check(cudaFuncSetAttribute(reinterpret_cast<void const*>(kernel),
                                   cudaFuncAttributeNonPortableClusterSizeAllowed, 1),
              "have large clusters");
        int clusters = 0;
        if (cudaOccupancyMaxActiveClusters(&clusters, kernel, &config) == cudaSuccess)
            return clusters > 0;
        static_cast<void>(cudaGetLastError());
        return false;
    }

    kernels::OneChain chain_;
    int most_bytes_ = 0;
    mutable std::map<void const*, Grid> grids_;  // of each kernel
};

}  // namespace catena::cuda
