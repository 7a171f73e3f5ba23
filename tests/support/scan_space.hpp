// The host's Space, but scans climb and descend by the GPU's kernels.
#pragma once

#include <algorithm>

#include "dca/host_space.hpp"
#include "tests/support/cuda_on_host.hpp"

// After CUDA's words.
#include "cuda/scan_kernels.cuh"

namespace catena::test {

class ScanSpace : public HostSpace {
  public:
    using HostSpace::HostSpace;
    SimdLevel simd() const = delete;  // as a GPU

    /// Items of a block in trees made from now on, and the most stages that any has had.
    static inline std::int64_t most = cuda::kernels::most_of_scan;
    static inline std::size_t most_stages = 0;

    class ScanTree {
      public:
        ScanTree(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels, std::vector<dca::Root> const& roots,
                 std::int64_t slots)
            : plan_(dca::plan_scan(runs, levels, roots, slots, most)) {
            most_stages = std::max(most_stages, plan_.size());
            for (dca::ScanStage const& stage : plan_)
                stages_.push_back({static_cast<unsigned>(stage.blocks.size()), stage.levels, static_cast<int>(stage.width),
                                   stage.of_runs ? runs.data() : nullptr, stage.slot.data(), stage.merges.data(), stage.tops.data(),
                                   stage.blocks.data(), stage.level_end.data()});
        }

      private:
        friend class ScanSpace;
        std::vector<dca::ScanStage> plan_;
        std::vector<cuda::kernels::DeviceScanStage> stages_;
    };
    template <class Scan>
    void climb(ScanTree const& tree, Scan const& scan) const {
        climb_below(tree, tree.stages_.size(), scan);
    }
    template <class Scan>
    void descend(ScanTree const& tree, Scan const& scan) const {
        descend_below(tree, tree.stages_.size(), scan);
    }
    template <class Scan>
    void climb_and_descend(ScanTree const& tree, Scan const& scan) const {
        if (tree.stages_.empty()) return;
        climb_below(tree, tree.stages_.size() - 1, scan);
        launch(cuda::kernels::turn_scan<Scan>, tree.stages_.back(), scan);
        descend_below(tree, tree.stages_.size() - 1, scan);
    }

  private:
    template <class Scan>
    static void launch(void (*kernel)(cuda::kernels::DeviceScanStage, Scan), cuda::kernels::DeviceScanStage const& stage,
                       Scan const& scan) {
        auto const threads = static_cast<unsigned>((stage.width + 31) / 32 * 32);
        auto const numbers = static_cast<std::size_t>(cuda::kernels::BlockOfScan<Scan>::size(stage));
        cuda_on_host::launch({stage.blocks, threads, numbers}, kernel, stage, scan);
    }
    template <class Scan>
    static void climb_below(ScanTree const& tree, std::size_t stages, Scan const& scan) {
        for (std::size_t i = 0; i < stages; ++i) launch(cuda::kernels::climb_scan<Scan>, tree.stages_[i], scan);
    }
    template <class Scan>
    static void descend_below(ScanTree const& tree, std::size_t stages, Scan const& scan) {
        for (std::size_t i = stages; i-- > 0;) launch(cuda::kernels::descend_scan<Scan>, tree.stages_[i], scan);
    }
};

}  // namespace catena::test
