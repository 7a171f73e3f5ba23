// The host's Space, but scans climb and descend by the GPU's kernels.
#pragma once

#include <algorithm>

#include "dca/host_space.hpp"
#include "tests/support/cuda_on_host.hpp"
#include "tests/support/shared_by_host.hpp"

// After CUDA's words.
#include "cuda/sweeps/scan_walk.cuh"

namespace catena::test {

class ScanSpace : public HostSpace {
  public:
    using HostSpace::HostSpace;
    SimdLevel simd() const = delete;  // as a GPU

    /// Items of a block in trees made from now on; the most stages that any has had.
    static inline std::int64_t most = cuda::kernels::most_of_scan;
    static inline std::size_t most_stages = 0;
    /// Scans among ranks so far that took one launch there.
    static inline int shared_turns = 0;
    /// That reach each other's memory; null: none do.
    static inline Communicator const* ranks = nullptr;
    using Direct = SharedByHost;
    Direct connect(dca::Schedule const& schedule, int width, int /*beside*/) const {
        return {ranks, schedule, width};
    }
    using HostSpace::exchange;
    template <class Numbers, int... D>
    void exchange(Direct const& direct, Numbers const& numbers,
                  BodyExchange<D> const&... beside) const {
        direct(numbers);
        (exchange(*direct.communicator(), beside), ...);
    }

    class ScanTree {
      public:
        ScanTree(std::vector<dca::Run> const& runs,
                 std::vector<std::vector<dca::Merge>> const& levels,
                 std::vector<dca::Root> const& roots, std::int64_t slots)
            : plan_(dca::plan_scan(runs, levels, roots, slots, most)) {
            most_stages = std::max(most_stages, plan_.size());
            for (dca::ScanStage const& stage : plan_)
                stages_.push_back(
                    {static_cast<unsigned>(stage.blocks.size()), stage.levels,
                     static_cast<int>(stage.width),
                     stage.of_runs ? cuda::view_of(runs, runs.data()) : cuda::RunsView{},
                     stage.slot.data(), stage.merges.data(), stage.tops.data(), stage.blocks.data(),
                     stage.level_end.data()});
        }

      private:
        friend class ScanSpace;
        std::vector<dca::ScanStage> plan_;
        std::vector<cuda::kernels::DeviceScanStage> stages_;
    };
    template <class Scan>
    void climb(ScanTree const& tree, Scan const& scan) const {
        walk(tree).climb(scan);
    }
    template <class Scan>
    void descend(ScanTree const& tree, Scan const& scan) const {
        walk(tree).descend(scan);
    }
    template <class Scan>
    void climb_and_descend(ScanTree const& tree, Scan const& scan) const {
        walk(tree).climb_and_descend(scan);
    }
    template <class Numbers, class Scan, int... D>
    bool shared_passes(Direct const& direct, Numbers const& numbers, ScanTree const& tree,
                       ScanTree const& top, Scan const& scan,
                       BodyExchange<D> const&... beside) const {
        auto const show = [&] {
            if (threadIdx.x == 0) exchange(direct, numbers, beside...);
        };
        return walk(tree).shared_passes(scan, show, Launches{top});
    }

  private:
    /// Of ScanWalk.
    struct Launches {
        ScanTree const& tree;

        std::size_t stages() const { return tree.stages_.size(); }
        unsigned blocks(std::size_t i) const { return tree.stages_[i].blocks; }
        template <class Scan>
        void climb(std::size_t i, Scan const& scan) const {
            launch(cuda::kernels::climb_scan<Scan>, i, scan);
        }
        template <class Scan>
        void both_passes(std::size_t i, Scan const& scan) const {
            launch(cuda::kernels::turn_scan<Scan>, i, scan);
        }
        template <class Scan>
        void descend(std::size_t i, Scan const& scan) const {
            launch(cuda::kernels::descend_scan<Scan>, i, scan);
        }
        template <class Scan, class Exchange>
        void shared_passes(Scan const& scan, Exchange const& exchange, Launches const& top) const {
            auto const &own = tree.stages_.back(), &above = top.tree.stages_.back();
            ++shared_turns;
            cuda_on_host::launch(
                {1, cuda::kernels::most_of_scan, numbers<Scan>(own) + numbers<Scan>(above)},
                cuda::kernels::shared_passes_of_scan<Scan, Exchange>, own, above, exchange, scan);
        }

      private:
        template <class Scan>
        static std::size_t numbers(cuda::kernels::DeviceScanStage const& stage) {
            return static_cast<std::size_t>(cuda::kernels::BlockOfScan<Scan>::size(stage));
        }
        template <class Scan>
        void launch(void (*kernel)(cuda::kernels::DeviceScanStage, Scan), std::size_t i,
                    Scan const& scan) const {
            auto const& stage = tree.stages_[i];
            cuda_on_host::launch(
                {stage.blocks, cuda::kernels::threads_of_scan(stage), numbers<Scan>(stage)}, kernel,
                stage, scan);
        }
    };
    static cuda::ScanWalk<Launches> walk(ScanTree const& tree) {
        return cuda::ScanWalk<Launches>({tree});
    }
};

}  // namespace catena::test
