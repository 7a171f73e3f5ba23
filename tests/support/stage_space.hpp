// The host's Space, but sweeps climb and descend stages by the GPU's kernels.
#pragma once

#include <algorithm>
#include <limits>
#include <set>

#include "dca/tree_solver.hpp"
#include "tests/support/cuda_on_host.hpp"

// After CUDA's words.
#include "cuda/hinge_teams.cuh"
#include "cuda/short_chain.cuh"
#include "cuda/stage_walk.cuh"

namespace catena::test {

struct StagedGpu {
    dca::StageSizes sizes;
    bool runs_apart = false;               // also where they are few, and a thread each
    std::int64_t threads = sizes.threads;  // of a block without runs at most: fewer than planned take what they have to do in turns
    bool short_chains = false;             // by themselves
    std::size_t shared_bytes = cuda_on_host::most_shared_bytes;  // of a block that takes runs apart downwards
};
/// In launches so far.
struct StagesSeen {
    std::set<unsigned> blocks_of_clusters;
    std::size_t most_stages = 0;
    std::set<unsigned> blocks_of_short_chains;
    int turns_alone = 0, runs_apart = 0, runs_in_stages = 0, teams = 0;
};

class StageSpace : public HostSpace {
  public:
    using HostSpace::HostSpace;
    SimdLevel simd() const = delete;  // as a GPU

    /// That trees are made for from now on.
    static inline StagedGpu gpu;
    static inline StagesSeen seen;

    class Tree {
      public:
        Tree(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels, std::vector<dca::Root> const& roots,
             std::int64_t slots, std::span<std::uint8_t const> restricted, dca::StageRecords const& records)
            : runs_(runs), sizes_(gpu.sizes), threads_(static_cast<int>(gpu.threads)) {
            sizes_.threads = std::min<std::int64_t>(sizes_.threads, records.threads);
            sizes_.runs_apart = records.whole_runs;
            plan_ = dca::plan_stages(runs, levels, roots, slots, restricted, sizes_);
            if (gpu.runs_apart && !runs.empty()) {
                plan_.runs_apart = true;
                plan_.stages.front().of_runs = false;
            }
            if (gpu.short_chains) short_ = cuda::kernels::short_chain_of(runs, levels, roots);
            for (dca::Stage const& stage : plan_.stages) {
                blocks_.push_back(dca::blocks_of(stage));
                level_ends_.push_back(dca::level_ends_of(stage));
                kept_.emplace_back(dca::kept_numbers(stage, records));
            }
        }

      private:
        friend class StageSpace;
        std::span<dca::Run const> runs_;
        dca::StageSizes sizes_;
        int threads_;
        std::size_t shared_bytes_ = gpu.shared_bytes;
        dca::StagePlan plan_;
        cuda::kernels::ShortChain short_;
        std::vector<std::vector<dca::StageBlock>> blocks_;  // of every stage
        std::vector<std::vector<std::int32_t>> level_ends_;
        mutable std::vector<std::vector<double>> kept_;
    };

    template <class Sweep>
    void climb(Tree const& tree, Sweep const& sweep) const {
        for (std::vector<double>& kept : tree.kept_) std::fill(kept.begin(), kept.end(), std::numeric_limits<double>::quiet_NaN());
        walk(tree).climb(sweep);
    }
    template <class Sweep>
    void descend(Tree const& tree, Sweep const& sweep) const {
        walk(tree).descend(sweep);
    }
    template <class Sweep>
    void climb_and_descend(Tree const& tree, Sweep const& sweep) const {
        if (tree.plan_.stages.empty()) return;
        if constexpr (Sweep::goes_short)
            if (tree.short_.warps > 0 && turn_short(tree.short_, sweep)) return;
        walk(tree).climb_and_descend(sweep);
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
                tree.level_ends_[which].data(),
                tree.kept_[which].data()};
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
    /// Of StageWalk.
    struct Launches {
        Tree const& tree;

        std::size_t stages() const { return tree.plan_.stages.size(); }
        bool runs_apart() const { return tree.plan_.runs_apart; }
        bool together() const {
            auto const& stages = tree.plan_.stages;
            return stages.size() > 1 && stages[stages.size() - 2].blocks() <= tree.sizes_.together && stages.back().blocks() == 1;
        }
        bool takes_runs(std::size_t i) const { return stage(i).of_runs; }
        template <class Sweep>
        void climb(std::size_t i, Sweep const& sweep) const {
            launch(cuda::kernels::climb<Sweep>, stage(i), sweep);
        }
        template <class Sweep>
        void descend(std::size_t i, Sweep const& sweep) const {
            launch(cuda::kernels::descend<Sweep>, stage(i), sweep);
        }
        template <class Sweep>
        void turn(std::size_t i, Sweep const& sweep) const {
            see_stages();
            bool const two = together();
            int const threads = cuda::kernels::threads_for<Sweep>(std::max(threads_for(stage(i)), two ? threads_for(stage(i + 1)) : 0),
                                                                  cuda::kernels::threads_of_turn<Sweep>);
            auto const here = view(tree, stage(i)), above = two ? view(tree, stage(i + 1)) : cuda::kernels::DeviceStage{};
            if (two)
                seen.blocks_of_clusters.insert(here.blocks);
            else
                ++seen.turns_alone;
            cuda_on_host::launch({here.blocks, static_cast<unsigned>(threads),
                                  numbers<Sweep>(here, threads) + (two ? numbers<Sweep>(above, threads) : 0), two ? here.blocks : 1},
                                 cuda::kernels::turn<Sweep>, here, above, sweep);
        }
        template <class Sweep>
        void climb_runs(Sweep const& sweep) const {
            std::int64_t const runs = std::ssize(tree.runs_);
            if constexpr (dca::takes_whole_runs<Sweep>)
                if (cuda::kernels::go_by_teams<Sweep>(runs) && !gpu.runs_apart) {
                    ++seen.teams;
                    return over_runs(cuda::kernels::climb_runs_by_teams<Sweep>,
                                     cuda::kernels::grid_of_teams<cuda::kernels::BodyAhead>(runs), sweep);
                }
            over_runs(cuda::kernels::climb_runs<Sweep>, cuda::kernels::grid_of_climb<Sweep>(runs), sweep);
        }
        template <class Sweep>
        void descend_runs(Sweep const& sweep) const {
            std::int64_t const runs = std::ssize(tree.runs_);
            if constexpr (dca::takes_whole_runs<Sweep>)
                if (cuda::kernels::go_by_teams<Sweep>(runs) && !gpu.runs_apart)
                    return over_runs(cuda::kernels::descend_runs_by_teams<Sweep>,
                                     cuda::kernels::grid_of_teams<cuda::kernels::HingeBehind>(runs), sweep);
            over_runs(cuda::kernels::descend_runs<Sweep>, cuda::kernels::grid_of_descent<Sweep>(runs, tree.shared_bytes_), sweep);
        }

      private:
        dca::Stage const& stage(std::size_t i) const { return tree.plan_.stages[i]; }
        int threads_for(dca::Stage const& stage) const {
            int const wanted = dca::threads_for(stage, tree.sizes_);
            return stage.of_runs ? wanted : std::min(wanted, tree.threads_);
        }
        void see_stages() const {
            ++(tree.plan_.runs_apart ? seen.runs_apart : seen.runs_in_stages);
            seen.most_stages = std::max(seen.most_stages, stages());
        }
        template <class Sweep>
        static std::size_t numbers(cuda::kernels::DeviceStage const& stage, int of_threads) {
            return static_cast<std::size_t>(cuda::kernels::BlockOfStage<Sweep>::size(stage, of_threads));
        }
        template <class Sweep>
        void launch(void (*kernel)(cuda::kernels::DeviceStage, Sweep), dca::Stage const& stage, Sweep const& sweep) const {
            see_stages();
            int const threads = cuda::kernels::threads_for<Sweep>(threads_for(stage), cuda::kernels::threads_of<Sweep>);
            auto const here = view(tree, stage);
            cuda_on_host::launch({here.blocks, static_cast<unsigned>(threads), numbers<Sweep>(here, threads)}, kernel, here, sweep);
        }
        template <class Sweep>
        void over_runs(void (*kernel)(dca::Run const*, std::int64_t, Sweep), cuda::kernels::RunsGrid const& grid,
                       Sweep const& sweep) const {
            cuda_on_host::launch({grid.blocks, grid.threads, grid.shared_bytes / sizeof(double)}, kernel, tree.runs_.data(), grid.runs,
                                 sweep);
        }
    };
    static cuda::StageWalk<Launches> walk(Tree const& tree) { return cuda::StageWalk<Launches>({tree}); }
};

}  // namespace catena::test
