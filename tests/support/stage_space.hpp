// The host's Space, but sweeps climb and descend stages by the GPU's kernels.
#pragma once

#include <algorithm>
#include <set>

#include "dca/tree_solver.hpp"
#include "tests/support/cuda_on_host.hpp"

// After CUDA's words.
#include "cuda/short_chain.cuh"
#include "cuda/stage_kernels.cuh"

namespace catena::test {

struct StagedGpu {
    dca::StageSizes sizes;
    bool runs_apart = false;               // also where they are few
    std::int64_t threads = sizes.threads;  // of a block without runs at most: fewer than planned take what they have to do in turns
    bool short_chains = false;             // by themselves
};
/// In launches so far.
struct StagesSeen {
    std::set<unsigned> blocks_of_clusters;
    std::size_t most_stages = 0;
    std::set<unsigned> blocks_of_short_chains;
    int turns_alone = 0, runs_apart = 0, runs_in_stages = 0;
};

class StageSpace : public HostSpace {
  public:
    using HostSpace::HostSpace;
    SimdLevel simd() const = delete;  // as a GPU
    static constexpr bool by_launches = true;

    /// That trees are made for from now on.
    static inline StagedGpu gpu;
    static inline StagesSeen seen;

    class Tree {
      public:
        Tree(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels, std::vector<dca::Root> const& roots,
             std::int64_t slots, std::span<std::uint8_t const> restricted, dca::StageRecords const& records)
            : runs_(runs), sizes_(gpu.sizes), threads_(static_cast<int>(gpu.threads)) {
            sizes_.threads = std::min<std::int64_t>(sizes_.threads, records.threads);
            plan_ = dca::plan_stages(runs, levels, roots, slots, restricted, sizes_);
            if (gpu.runs_apart && !runs.empty()) {
                plan_.runs_apart = true;
                plan_.stages.front().of_runs = false;
            }
            if (gpu.short_chains) short_ = cuda::kernels::short_chain_of(runs, levels, roots);
            for (dca::Stage const& stage : plan_.stages) {
                blocks_.push_back(dca::blocks_of(stage));
                level_ends_.push_back(dca::level_ends_of(stage));
            }
        }

      private:
        friend class StageSpace;
        std::span<dca::Run const> runs_;
        dca::StageSizes sizes_;
        int threads_;
        dca::StagePlan plan_;
        cuda::kernels::ShortChain short_;
        std::vector<std::vector<dca::StageBlock>> blocks_;  // of every stage
        std::vector<std::vector<std::int32_t>> level_ends_;
    };

    template <class Sweep>
    void climb(Tree const& tree, Sweep const& sweep) const {
        climb_below(tree, tree.plan_.stages.size(), sweep);
    }
    template <class Sweep>
    void descend(Tree const& tree, Sweep const& sweep) const {
        descend_below(tree, tree.plan_.stages.size(), sweep);
    }
    template <class Sweep>
    void climb_and_descend(Tree const& tree, Sweep const& sweep) const {
        auto const& stages = tree.plan_.stages;
        if (stages.empty()) return;
        if constexpr (Sweep::goes_short)
            if (tree.short_.warps > 0 && turn_short(tree.short_, sweep)) return;
        bool const together =
            stages.size() > 1 && stages[stages.size() - 2].blocks() <= tree.sizes_.together && stages.back().blocks() == 1;
        std::size_t const apart = stages.size() - (together ? 2 : 1);
        climb_below(tree, apart, sweep);
        turn(tree, stages[apart], together ? &stages.back() : nullptr, sweep);
        descend_below(tree, apart, sweep);
    }

  private:
    static cuda::kernels::DeviceStage view(Tree const& tree, dca::Stage const& stage) {
        auto const which = static_cast<std::size_t>(&stage - tree.plan_.stages.data());
        return {static_cast<unsigned>(stage.blocks()),
                stage.levels,
                static_cast<int>(stage.width),
                static_cast<int>(stage.forces),
                stage.of_runs ? tree.runs_.data() : nullptr,
                stage.items.data(),
                stage.merges.data(),
                stage.roots.data(),
                stage.segments_up.data(),
                stage.forces_down.data(),
                tree.blocks_[which].data(),
                tree.level_ends_[which].data()};
    }
    static int threads_for(Tree const& tree, dca::Stage const& stage) {
        int const wanted = dca::threads_for(stage, tree.sizes_);
        return stage.of_runs ? wanted : std::min(wanted, tree.threads_);
    }
    template <class Sweep>
    static std::size_t numbers(cuda::kernels::DeviceStage const& stage, int of_threads) {
        return static_cast<std::size_t>(cuda::kernels::BlockOfStage<Sweep>::size(stage, of_threads));
    }
    template <class Sweep>
    static void launch_stage(void (*kernel)(cuda::kernels::DeviceStage, Sweep), Tree const& tree, dca::Stage const& stage,
                             Sweep const& sweep) {
        int const threads = threads_for(tree, stage);
        auto const here = view(tree, stage);
        cuda_on_host::launch({here.blocks, static_cast<unsigned>(threads), numbers<Sweep>(here, threads)}, kernel, here, sweep);
    }
    template <class Sweep>
    static void turn(Tree const& tree, dca::Stage const& lower, dca::Stage const* upper, Sweep const& sweep) {
        int const threads = std::max(threads_for(tree, lower), upper ? threads_for(tree, *upper) : 0);
        auto const here = view(tree, lower), above = upper ? view(tree, *upper) : cuda::kernels::DeviceStage{};
        if (upper)
            seen.blocks_of_clusters.insert(here.blocks);
        else
            ++seen.turns_alone;
        cuda_on_host::launch({here.blocks, static_cast<unsigned>(threads),
                              numbers<Sweep>(here, threads) + (upper ? numbers<Sweep>(above, threads) : 0), upper ? here.blocks : 1},
                             cuda::kernels::turn<Sweep>, here, above, sweep);
    }
    template <class Sweep>
    static bool turn_short(cuda::kernels::ShortChain const& chain, Sweep const& sweep) {
        cuda::kernels::ShortGrid const grid = cuda::kernels::grid_of_short<Sweep>(chain);
        if (grid.shared_bytes > cuda_on_host::most_shared_bytes) return false;
        seen.blocks_of_short_chains.insert(grid.blocks);
        cuda_on_host::launch({grid.blocks, grid.threads, grid.shared_bytes / sizeof(double), grid.blocks}, cuda::kernels::turn_short<Sweep>,
                             chain, sweep);
        return true;
    }
    template <class Sweep>
    static void climb_below(Tree const& tree, std::size_t stages, Sweep const& sweep) {
        if (tree.plan_.runs_apart)
            over_runs(tree, sweep, cuda::kernels::grid_of_climb<Sweep>(std::ssize(tree.runs_)), cuda::kernels::climb_runs<Sweep>);
        ++(tree.plan_.runs_apart ? seen.runs_apart : seen.runs_in_stages);
        seen.most_stages = std::max(seen.most_stages, tree.plan_.stages.size());
        for (std::size_t i = 0; i < stages; ++i) launch_stage(cuda::kernels::climb<Sweep>, tree, tree.plan_.stages[i], sweep);
    }
    template <class Sweep>
    static void descend_below(Tree const& tree, std::size_t stages, Sweep const& sweep) {
        for (std::size_t i = stages; i-- > 0;) launch_stage(cuda::kernels::descend<Sweep>, tree, tree.plan_.stages[i], sweep);
        if (tree.plan_.runs_apart)
            over_runs(tree, sweep, cuda::kernels::grid_of_descent<Sweep>(std::ssize(tree.runs_)), cuda::kernels::descend_runs<Sweep>);
    }
    template <class Sweep>
    static void over_runs(Tree const& tree, Sweep const& sweep, cuda::kernels::RunsGrid const& grid,
                          void (*kernel)(dca::Run const*, std::int64_t, Sweep)) {
        cuda_on_host::launch({grid.blocks, grid.threads, grid.shared_bytes / sizeof(double)}, kernel, tree.runs_.data(), grid.runs, sweep);
    }
};

}  // namespace catena::test
