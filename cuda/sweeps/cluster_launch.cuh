// Launches of one cluster that perform both passes of one chain (one_chain.cuh).
#pragma once

#include <map>

#include "cuda/device/clusters.hpp"
#include "cuda/device/launch.cuh"
#include "cuda/sweeps/one_chain.cuh"

namespace catena::cuda {

/// Grids of such launches for one tree. The answers are cached and valid for the tree's GPU and
/// context.
class ClusterLaunch {
  public:
    ClusterLaunch() = default;
    /// `most_bytes`: largest shared memory of a block.
    ClusterLaunch(kernels::OneChain const& chain, int most_bytes)
        : chain_(chain), most_bytes_(most_bytes) {}
    explicit operator bool() const { return chain_.warps > 0; }
    /// Returns the grid of a kernel whose blocks consist of such warps (grid_of_cluster()). It has
    /// no blocks if the GPU cannot hold the chain in one cluster.
    template <class Warp, class... Parameters>
    Grid const& grid(void (*kernel)(kernels::OneChain, Parameters...)) const {
        auto const [known, is_new] = grids_.try_emplace(reinterpret_cast<void const*>(kernel));
        if (is_new && *this) known->second = found<Warp>(kernel);
        return known->second;
    }
    /// Launches the kernel. Later work of the stream sees its results as after any other launch.
    template <class... Parameters>
    void launch(Grid const& grid, cudaStream_t stream,
                void (*kernel)(kernels::OneChain, Parameters...),
                std::type_identity_t<Parameters> const&... arguments) const {
        EarlyLaunch(grid, stream)(kernel, chain_, arguments...);
    }

  private:
    /// Finds the grid, trying large clusters first.
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
    /// True if the GPU can run the configuration.
    template <class Kernel>
    bool takes(Kernel* kernel, cudaLaunchConfig_t const& config) const {
        if (config.dynamicSmemBytes > static_cast<std::size_t>(most_bytes_)) return false;
        // The limit is always the maximum, because another tree's launch of this kernel may need
        // more.
        allow_shared(kernel, static_cast<std::size_t>(most_bytes_));
        if (config.gridDim.x <= kernels::most_in_cluster) return true;
        // Clusters of this size are not portable: not every GPU with clusters supports them.
        check(cudaFuncSetAttribute(reinterpret_cast<void const*>(kernel),
                                   cudaFuncAttributeNonPortableClusterSizeAllowed, 1),
              "provide large clusters");
        int clusters = 0;
        if (cudaOccupancyMaxActiveClusters(&clusters, kernel, &config) == cudaSuccess)
            return clusters > 0;
        static_cast<void>(cudaGetLastError());
        return false;
    }

    kernels::OneChain chain_;
    int most_bytes_ = 0;
    mutable std::map<void const*, Grid> grids_;  // grids found, by kernel
};

}  // namespace catena::cuda
