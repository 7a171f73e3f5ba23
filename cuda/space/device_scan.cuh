// Scans along chains on a GPU: one launch per stage inwards and one per stage outwards. A single
// launch does both passes of the top stage.
#pragma once

#include <algorithm>
#include <vector>

#include "cuda/device/clusters.hpp"
#include "cuda/device/launch.cuh"
#include "cuda/device/owners.hpp"
#include "cuda/exchange/peer_exchange.cuh"
#include "cuda/sweeps/scan_walk.cuh"

namespace catena::cuda {

/// Tree of scans; it behaves as HostSpace::ScanTree specifies.
class DeviceScan {
  public:
    /// Plans the stages and copies them to the GPU.
    DeviceScan(std::vector<dca::Run> const& runs,
               std::vector<std::vector<dca::Merge>> const& levels,
               std::vector<dca::Root> const& roots, std::int64_t slots)
        : run_list_(runs), runs_(view_of(runs, run_list_.data())) {
        for (dca::ScanStage const& stage :
             dca::plan_scan(runs, levels, roots, slots, kernels::most_of_scan))
            stages_.emplace_back(stage, runs_);
    }
    /// Performs the inward pass.
    template <class Scan>
    void climb(Scan const& scan, cudaStream_t stream) const {
        walk(stream).climb(scan);
    }
    /// Performs the outward pass.
    template <class Scan>
    void descend(Scan const& scan, cudaStream_t stream) const {
        walk(stream).descend(scan);
    }
    /// Performs both passes.
    template <class Scan>
    void climb_and_descend(Scan const& scan, cudaStream_t stream) const {
        walk(stream).climb_and_descend(scan);
    }
    /// Performs both passes with an exchange between ranks in one launch; see
    /// ScanWalk::shared_passes.
    template <class Scan, class Numbers>
    bool shared_passes(Scan const& scan, ExchangeInTurn<Numbers> const& exchange,
                       DeviceScan const& top, cudaStream_t stream) const {
        return walk(stream).shared_passes(scan, exchange, Launches{top, stream});
    }

  private:
    /// A stage's lists in the GPU's memory.
    struct Stage {
        Stage(dca::ScanStage const& stage, RunsView const& runs)
            : slot(stage.slot),
              merges(stage.merges),
              tops(stage.tops),
              block(stage.blocks),
              level_end(stage.level_end),
              view{static_cast<unsigned>(stage.blocks.size()),
                   stage.levels,
                   static_cast<int>(stage.width),
                   stage.of_runs ? runs : RunsView{},
                   slot.data(),
                   merges.data(),
                   tops.data(),
                   block.data(),
                   level_end.data()} {}
        /// Lists of items, merges, complete segments, blocks and ends of levels (dca::ScanStage).
        Buffer<std::int32_t> slot;
        Buffer<dca::ScanMerge> merges;
        Buffer<dca::ScanTop> tops;
        Buffer<dca::ScanBlock> block;
        Buffer<std::int32_t> level_end;
        kernels::DeviceScanStage view;
    };
    /// Launches that ScanWalk requests; see there.
    struct Launches {
        DeviceScan const& tree;
        cudaStream_t stream;

        std::size_t stages() const { return tree.stages_.size(); }
        unsigned blocks(std::size_t i) const { return tree.stages_[i].view.blocks; }
        template <class Scan>
        void climb(std::size_t i, Scan const& scan) const {
            launch(kernels::climb_scan<Scan>, i, scan);
        }
        template <class Scan>
        void both_passes(std::size_t i, Scan const& scan) const {
            launch(kernels::turn_scan<Scan>, i, scan);
        }
        template <class Scan>
        void descend(std::size_t i, Scan const& scan) const {
            launch(kernels::descend_scan<Scan>, i, scan);
        }
        /// Launches both passes of the last stage with an exchange and the passes of `top`.
        template <class Scan, class Numbers>
        void shared_passes(Scan const& scan, ExchangeInTurn<Numbers> const& exchange,
                           Launches const& top) const {
            kernels::DeviceScanStage const &own = tree.stages_.back().view,
                                           &above = top.tree.stages_.back().view;
            std::size_t const all = bytes<Scan>(own) + bytes<Scan>(above);
            auto* const kernel =
                kernels::shared_passes_of_scan<Scan, kernels::ExchangeByBlock<Numbers>>;
            allow_shared(kernel, all);
            cuda::launch({1, kernels::most_of_scan, all}, stream, kernel, own, above,
                         exchange.next(), scan);
            ++scans_shared;
        }

      private:
        /// Returns the bytes of shared memory of a stage's block.
        template <class Scan>
        static std::size_t bytes(kernels::DeviceScanStage const& stage) {
            return sizeof(double) *
                   static_cast<std::size_t>(kernels::BlockOfScan<Scan>::size(stage));
        }
        template <class Scan>
        void launch(void (*kernel)(kernels::DeviceScanStage, Scan), std::size_t i,
                    Scan const& scan) const {
            kernels::DeviceScanStage const& stage = tree.stages_[i].view;
            cuda::launch({stage.blocks, kernels::threads_of_scan(stage), bytes<Scan>(stage)},
                         stream, kernel, stage, scan);
        }
    };
    ScanWalk<Launches> walk(cudaStream_t stream) const {
        return ScanWalk<Launches>({*this, stream});
    }

    Buffer<dca::Run> run_list_;
    RunsView runs_;
    std::vector<Stage> stages_;
};

}  // namespace catena::cuda
