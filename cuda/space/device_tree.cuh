// Trees of chains on a GPU, as the Space has them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "cuda/space/tree_launches.cuh"

namespace catena::cuda {

/// Tree of sweeps; it behaves as HostSpace::Tree specifies.
class DeviceTree {
  public:
    /// The arguments are those of PlannedTree.
    DeviceTree(std::vector<dca::Run> const& runs,
               std::vector<std::vector<dca::Merge>> const& levels,
               std::vector<dca::Root> const& roots, std::int64_t slots,
               std::span<std::uint8_t const> restricted, dca::StageRecords const& records)
        : planned_(runs, levels, roots, slots, restricted, records) {}

    /// Performs the inward pass.
    template <class Sweep>
    void climb(Sweep const& sweep, cudaStream_t stream) const {
        walk(stream).climb(sweep);
    }
    /// Performs the outward pass.
    template <class Sweep>
    void descend(Sweep const& sweep, cudaStream_t stream) const {
        walk(stream).descend(sweep);
    }
    /// Performs both passes, in a single launch for a short chain.
    template <class Sweep>
    void climb_and_descend(Sweep const& sweep, cudaStream_t stream) const {
        if (planned_.stages.empty()) return;
        if constexpr (Sweep::supports_short_chains)
            if (Grid const& grid = planned_.short_chain.grid<kernels::ShortWarp<Sweep>>(
                    kernels::turn_short<Sweep>);
                grid.blocks > 0) {
                planned_.short_chain.launch(grid, stream, kernels::turn_short<Sweep>, sweep);
                ++short_launches;
                return;
            }
        walk(stream).climb_and_descend(sweep);
    }
    /// Performs both passes of a tree shared by ranks in one launch; see StageWalk::shared_passes.
    template <class Sweep, class Numbers>
    bool shared_passes(Sweep const& sweep, ExchangeInTurn<Numbers> const& exchange,
                       DeviceTree const& top, cudaStream_t stream) const {
        return walk(stream).shared_passes(sweep, exchange, TreeLaunches{top.planned_, stream});
    }

  private:
    StageWalk<TreeLaunches> walk(cudaStream_t stream) const {
        return StageWalk<TreeLaunches>({planned_, stream});
    }

    PlannedTree planned_;
};

}  // namespace catena::cuda
