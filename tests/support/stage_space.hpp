// The host's Space, but sweeps climb and descend stages by the GPU's kernels.
#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "dca/tree_solver.hpp"
#include "tests/support/cuda_on_host.hpp"

// After CUDA's words.
#include "cuda/hinge_teams.cuh"
#include "cuda/short_chain.cuh"
#include "cuda/stage_walk.cuh"

namespace catena::test {
namespace kernels = cuda::kernels;

struct StagedGpu {
    dca::StageSizes sizes;
    bool runs_apart = false;               // also where they are few, and a thread each
    std::int64_t threads = sizes.threads;  // of a block without runs at most: fewer than planned take what they have to do in turns
    bool short_chains = false;             // by themselves
    std::size_t shared_bytes = cuda_on_host::most_shared_bytes;  // of a block that takes runs apart
};
/// In launches so far.
struct StagesSeen {
    std::set<unsigned> blocks_that_turn;
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
            if (gpu.short_chains) short_ = kernels::short_chain_of(runs, levels, roots);
            together_.emplace(plan_, sizes_);
            for (dca::Stage const& stage : plan_.stages) {
                words_.push_back(dca::words_of(stage, *together_));
                kept_.emplace_back(dca::kept_numbers(stage, records));
            }
            if (!*together_) return;
            up_ = std::vector<kernels::LetterBox>(together_->numbers_up(records));
            down_ = std::vector<kernels::LetterBox>(together_->numbers_down(records));
            launches_.resize(together_->blocks());
        }
        Tree(Tree&&) = default;  // what is of the plan stays where it is
        Tree& operator=(Tree&&) = delete;

      private:
        friend class StageSpace;
        std::span<dca::Run const> runs_;
        dca::StageSizes sizes_;
        int threads_;
        std::size_t shared_bytes_ = gpu.shared_bytes;
        dca::StagePlan plan_;
        kernels::ShortChain short_;
        std::optional<dca::StagesTogether> together_;
        std::vector<std::vector<dca::StageWord>> words_;  // of every stage
        mutable std::vector<std::vector<double>> kept_;
        mutable std::vector<kernels::LetterBox> up_, down_;
        mutable std::vector<unsigned> launches_;
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
    static kernels::DeviceStage view(Tree const& tree, dca::Stage const& stage) {
        auto const which = static_cast<std::size_t>(&stage - tree.plan_.stages.data());
        return {static_cast<unsigned>(stage.blocks()),
                static_cast<int>(stage.forces),
                dca::layout_of(stage),
                stage.of_runs ? tree.runs_.data() : nullptr,
                tree.words_[which].data(),
                stage.roots.data(),
                tree.kept_[which].data()};
    }
    template <class Sweep>
    static bool turn_short(kernels::ShortChain const& chain, Sweep const& sweep) {
        kernels::ShortGrid const grid = kernels::grid_of_short<Sweep>(chain, kernels::most_blocks_of_short);
        if (grid.shared_bytes > cuda_on_host::most_shared_bytes) return false;
        seen.blocks_of_short_chains.insert(grid.blocks);
        cuda_on_host::launch({grid.blocks, grid.threads, grid.shared_bytes / sizeof(double), grid.blocks}, kernels::turn_short<Sweep>,
                             chain, sweep);
        return true;
    }
    /// Of StageWalk.
    struct Launches {
        Tree const& tree;

        std::size_t stages() const { return tree.plan_.stages.size(); }
        bool runs_apart() const { return tree.plan_.runs_apart; }
        bool takes_runs(std::size_t i) const { return stage(i).of_runs; }
        template <class Sweep>
        bool together(Sweep const&) const {
            return static_cast<bool>(*tree.together_);
        }
        template <class Sweep>
        void climb(std::size_t i, Sweep const& sweep) const {
            launch(kernels::climb<Sweep>, stage(i), sweep);
        }
        template <class Sweep>
        void descend(std::size_t i, Sweep const& sweep) const {
            launch(kernels::descend<Sweep>, stage(i), sweep);
        }
        template <class Sweep>
        void turn(std::size_t i, Sweep const& sweep) const {
            see_stages();
            ++seen.turns_alone;
            int const threads = kernels::threads_for<Sweep>(threads_for(stage(i)), kernels::threads_of_turn<Sweep>);
            auto const here = view(tree, stage(i));
            cuda_on_host::launch({here.blocks, static_cast<unsigned>(threads), numbers<Sweep>(here, threads)}, kernels::turn<Sweep>, here,
                                 sweep);
        }
        template <class Sweep>
        void turn_together(Sweep const& sweep) const {
            see_stages();
            dca::Stage const &lower = *tree.together_->lower, &upper = *tree.together_->upper;
            auto const of = [&](dca::Stage const& one) {
                return kernels::threads_for<Sweep>(threads_for(one), kernels::threads_of_turn<Sweep>);
            };
            int const threads = std::max(of(lower), of(upper));
            auto const here = view(tree, lower), above = view(tree, upper);
            seen.blocks_that_turn.insert(here.blocks);
            kernels::TurnLetters const letters{
                {tree.up_.data(), above.layout.items}, {tree.down_.data(), above.forces}, tree.launches_.data()};
            cuda_on_host::launch({here.blocks + 1, static_cast<unsigned>(threads),
                                  std::max(numbers<Sweep>(here, threads), numbers<Sweep>(above, threads)), 1, true},
                                 kernels::turn_together<Sweep>, here, above, letters, sweep);
        }
        template <class Sweep>
        void climb_runs(Sweep const& sweep) const {
            std::int64_t const runs = std::ssize(tree.runs_);
            if constexpr (dca::takes_whole_runs<Sweep>)
                if (kernels::go_by_teams<Sweep>(runs) && !gpu.runs_apart) {
                    ++seen.teams;
                    return over_runs(kernels::climb_runs_by_teams<Sweep>, kernels::grid_of_teams<kernels::BodyAhead>(runs), sweep);
                }
            over_runs(kernels::climb_runs<Sweep>, kernels::grid_of_climb<Sweep>(runs, tree.shared_bytes_), sweep);
        }
        template <class Sweep>
        void descend_runs(Sweep const& sweep) const {
            std::int64_t const runs = std::ssize(tree.runs_);
            if constexpr (dca::takes_whole_runs<Sweep>)
                if (kernels::go_by_teams<Sweep>(runs) && !gpu.runs_apart)
                    return over_runs(kernels::descend_runs_by_teams<Sweep>, kernels::grid_of_teams<kernels::HingeBehind>(runs), sweep);
            over_runs(kernels::descend_runs<Sweep>, kernels::grid_of_descent<Sweep>(runs, tree.shared_bytes_), sweep);
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
        static std::size_t numbers(kernels::DeviceStage const& stage, int of_threads) {
            return static_cast<std::size_t>(kernels::BlockOfStage<Sweep>::size(stage, of_threads));
        }
        template <class Sweep>
        void launch(void (*kernel)(kernels::DeviceStage, Sweep), dca::Stage const& stage, Sweep const& sweep) const {
            see_stages();
            int const threads = kernels::threads_for<Sweep>(threads_for(stage), kernels::threads_of<Sweep>);
            auto const here = view(tree, stage);
            cuda_on_host::launch({here.blocks, static_cast<unsigned>(threads), numbers<Sweep>(here, threads)}, kernel, here, sweep);
        }
        template <class Sweep>
        void over_runs(void (*kernel)(dca::Run const*, std::int64_t, Sweep), kernels::RunsGrid const& grid, Sweep const& sweep) const {
            cuda_on_host::launch({grid.blocks, grid.threads, grid.shared_bytes / sizeof(double)}, kernel, tree.runs_.data(), grid.runs,
                                 sweep);
        }
    };
    static cuda::StageWalk<Launches> walk(Tree const& tree) { return cuda::StageWalk<Launches>({tree}); }
};

}  // namespace catena::test
