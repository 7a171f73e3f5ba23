// Scans along chains on a GPU: a launch a stage upwards, a launch a stage downwards, one for both at the top.
#pragma once

#include <vector>

#include "cuda/owners.hpp"
#include "cuda/scan_kernels.cuh"

namespace catena::cuda {

/// HostSpace::ScanTree says what it promises.
class DeviceScan {
  public:
    DeviceScan(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels, std::vector<dca::Root> const& roots,
               std::int64_t slots)
        : runs_(runs) {
        for (dca::ScanStage const& stage : dca::plan_scan(runs, levels, roots, slots, kernels::most_of_scan))
            stages_.emplace_back(stage, runs_.data());
    }
    template <class Scan>
    void climb(Scan const& scan, cudaStream_t stream) const {
        climb_below(stages_.size(), scan, stream);
    }
    template <class Scan>
    void descend(Scan const& scan, cudaStream_t stream) const {
        descend_below(stages_.size(), scan, stream);
    }
    template <class Scan>
    void climb_and_descend(Scan const& scan, cudaStream_t stream) const {
        if (stages_.empty()) return;
        climb_below(stages_.size() - 1, scan, stream);
        launch(kernels::turn_scan<Scan>, stages_.back(), scan, stream);
        descend_below(stages_.size() - 1, scan, stream);
    }

  private:
    struct Stage {
        Stage(dca::ScanStage const& stage, dca::Run const* runs)
            : slot(stage.slot),
              merges(stage.merges),
              tops(stage.tops),
              block(stage.blocks),
              level_end(stage.level_end),
              view{static_cast<unsigned>(stage.blocks.size()),
                   stage.levels,
                   static_cast<int>(stage.width),
                   stage.of_runs ? runs : nullptr,
                   slot.data(),
                   merges.data(),
                   tops.data(),
                   block.data(),
                   level_end.data()} {}
        Buffer<std::int32_t> slot;
        Buffer<dca::ScanMerge> merges;
        Buffer<dca::ScanTop> tops;
        Buffer<dca::ScanBlock> block;
        Buffer<std::int32_t> level_end;
        kernels::DeviceScanStage view;
    };
    template <class Scan>
    void launch(void (*kernel)(kernels::DeviceScanStage, Scan), Stage const& stage, Scan const& scan, cudaStream_t stream) const {
        auto const threads = static_cast<unsigned>((stage.view.width + 31) / 32 * 32);
        std::size_t const bytes = sizeof(double) * static_cast<std::size_t>(kernels::BlockOfScan<Scan>::size(stage.view));
        kernel<<<stage.view.blocks, threads, bytes, stream>>>(stage.view, scan);
        check(cudaGetLastError(), "start a kernel");
    }
    template <class Scan>
    void climb_below(std::size_t stages, Scan const& scan, cudaStream_t stream) const {
        for (std::size_t i = 0; i < stages; ++i) launch(kernels::climb_scan<Scan>, stages_[i], scan, stream);
    }
    template <class Scan>
    void descend_below(std::size_t stages, Scan const& scan, cudaStream_t stream) const {
        for (std::size_t i = stages; i-- > 0;) launch(kernels::descend_scan<Scan>, stages_[i], scan, stream);
    }

    Buffer<dca::Run> runs_;
    std::vector<Stage> stages_;
};

}  // namespace catena::cuda
