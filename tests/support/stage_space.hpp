// The host's Space, but sweeps climb and descend stages by the GPU's kernels.
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <set>

#include "dca/solvers/tree_solver.hpp"
#include "tests/support/cuda_on_host.hpp"
#include "tests/support/shared_by_host.hpp"

// After CUDA's words.
#include "cuda/short/short_chain.cuh"
#include "cuda/sweeps/stage_walk.cuh"
#include "cuda/sweeps/team_launches.cuh"

namespace catena::test {
namespace kernels = cuda::kernels;

struct StagedGpu {
    dca::StageSizes sizes;
    bool runs_apart = false;               // also where they are few, and a thread each
    std::int64_t threads = sizes.threads;  // of a block without runs at most: fewer than planned
                                           // take what they have to do in turns
    bool short_chains = false;             // by themselves
    bool ranks_reach_each_other = false;
    std::size_t shared_bytes = cuda_on_host::most_shared_bytes;  // of a block that takes runs apart
    bool lanes_above_groups = false;                             // one cluster, wherever it can
    int most_blocks_of_cluster = kernels::most_blocks_of_chain;
};
/// In launches so far.
struct StagesSeen {
    std::set<unsigned> blocks_that_turn;
    std::size_t most_stages = 0;
    std::set<unsigned> blocks_of_short_chains;
    std::set<unsigned> blocks_that_turn_shared;  // below the one that speaks to other ranks
    std::set<unsigned> blocks_above_groups;
    int turns_alone = 0, runs_apart = 0, runs_in_stages = 0;
    int whole_runs_by_teams = 0, whole_runs_by_threads = 0;  // launches
};

class StageSpace : public HostSpace {
  public:
    using HostSpace::HostSpace;
    SimdLevel simd() const = delete;  // as a GPU

    /// That trees are made for from now on.
    static inline StagedGpu gpu;
    static inline StagesSeen seen;
    /// That reach each other's memory; null: none do.
    static inline Communicator const* ranks = nullptr;
    using Direct = SharedByHost;
    Direct connect(dca::Schedule const& schedule, int width, int /*beside*/) const {
        return {ranks, schedule, width};
    }
    template <class Numbers>
    void exchange(Direct const& direct, Numbers const& numbers) const {
        direct(numbers);
    }

    class Tree {
      public:
        Tree(std::vector<dca::Run> const& runs, std::vector<std::vector<dca::Merge>> const& levels,
             std::vector<dca::Root> const& roots, std::int64_t slots,
             std::span<std::uint8_t const> restricted, dca::StageRecords const& records)
            : runs_(cuda::view_of(runs, runs.data())),
              sizes_(gpu.sizes),
              threads_(static_cast<int>(gpu.threads)) {
            sizes_.threads = std::min<std::int64_t>(sizes_.threads, records.threads);
            sizes_.runs_apart = records.whole_runs;
            plan_ = dca::plan_stages(runs, levels, roots, slots, restricted, sizes_);
            if (gpu.runs_apart && !runs.empty()) {
                plan_.runs_apart = true;
                plan_.stages.front().of_runs = false;
            }
            by_teams_ = !gpu.runs_apart && std::ssize(runs) <= kernels::most_runs_of_teams;
            if (gpu.short_chains)
                short_ = kernels::one_chain_of(runs, levels, roots, dca::part_length);
            if (gpu.lanes_above_groups) groups_ = cuda::groups_of(runs, levels, records);
            if (!groups_.empty())
                above_groups_ = kernels::one_chain_of(runs, levels, roots, cuda::bodies_of_group);
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
        cuda::RunsView runs_;
        std::vector<dca::Run> groups_;
        dca::StageSizes sizes_;
        int threads_;
        std::size_t shared_bytes_ = gpu.shared_bytes;
        int most_blocks_of_cluster_ = gpu.most_blocks_of_cluster;
        bool by_teams_ = false;
        dca::StagePlan plan_;
        kernels::OneChain short_, above_groups_;
        std::optional<dca::StagesTogether> together_;
        std::vector<std::vector<dca::StageWord>> words_;  // of every stage
        mutable std::vector<std::vector<double>> kept_;
        mutable std::vector<kernels::LetterBox> up_, down_;
        mutable std::vector<unsigned> launches_;
    };

    template <class Sweep>
    void climb(Tree const& tree, Sweep const& sweep) const {
        for (std::vector<double>& kept : tree.kept_)
            std::fill(kept.begin(), kept.end(), std::numeric_limits<double>::quiet_NaN());
        walk(tree).climb(sweep);
    }
    template <class Sweep>
    void descend(Tree const& tree, Sweep const& sweep) const {
        walk(tree).descend(sweep);
    }
    template <class Sweep>
    void climb_and_descend(Tree const& tree, Sweep const& sweep) const {
        if (tree.plan_.stages.empty()) return;
        if constexpr (Sweep::supports_short_chains) {
            forget_earlier_sweeps(tree, sweep);
            if (tree.short_.warps > 0 && turn_short(tree, sweep)) return;
        }
        walk(tree).climb_and_descend(sweep);
    }

    template <class Numbers, class Sweep>
    bool shared_passes(Direct const& direct, Numbers const& numbers, Tree const& tree,
                       Tree const& top, Sweep const& sweep) const {
        return walk(tree).shared_passes(sweep, Exchange<Numbers>{direct, numbers}, Launches{top});
    }

  private:
    template <class Numbers>
    struct Exchange {
        Direct const& direct;
        Numbers numbers;
        void operator()() const {
            if (threadIdx.x == 0) direct(numbers);
        }
    };
    /// What is not written anew is seen.
    template <class Sweep>
    static void forget_earlier_sweeps(Tree const& tree, Sweep const& sweep) {
        auto const unknown = [](auto value) {
            std::memset(static_cast<void*>(&value), 0xff, sizeof(value));  // NaN
            return value;
        };
        for (std::int64_t i = 0; i < tree.runs_.count; ++i) {
            dca::Run const run = tree.runs_[i];
            for (std::int64_t k = run.body; k < run.body + run.count; ++k) {
                sweep.keep(k, unknown(typename Sweep::Node{}));
                sweep.s.forces.store(k, unknown(typename Sweep::Sweeps::State{}));
            }
        }
    }
    static kernels::DeviceStage view(Tree const& tree, dca::Stage const& stage) {
        auto const which = static_cast<std::size_t>(&stage - tree.plan_.stages.data());
        return {static_cast<unsigned>(stage.blocks()),
                static_cast<int>(stage.forces),
                dca::layout_of(stage),
                stage.of_runs ? tree.runs_ : cuda::RunsView{},
                tree.words_[which].data(),
                stage.roots.data(),
                tree.kept_[which].data(),
                stage.gathers};
    }
    template <class Sweep>
    static bool turn_short(Tree const& tree, Sweep const& sweep) {
        cuda_on_host::Launch const cluster =
            cluster_of<kernels::ShortWarp<Sweep>>(tree, tree.short_);
        if (cluster.numbers > cuda_on_host::most_shared_bytes / sizeof(double)) return false;
        seen.blocks_of_short_chains.insert(cluster.blocks);
        cuda_on_host::launch(cluster, kernels::turn_short<Sweep>, tree.short_, sweep);
        return true;
    }
    template <class Warp>
    static cuda_on_host::Launch cluster_of(Tree const& tree, kernels::OneChain const& chain) {
        kernels::ClusterGrid const grid =
            kernels::grid_of_cluster<Warp>(chain, tree.most_blocks_of_cluster_);
        return {grid.blocks, grid.threads, grid.shared_bytes / sizeof(double), grid.blocks};
    }
    /// Of StageWalk.
    struct Launches {
        Tree const& tree;

        std::size_t stages() const { return tree.plan_.stages.size(); }
        bool runs_apart() const { return tree.plan_.runs_apart; }
        bool gathers() const {
            return !tree.plan_.stages.empty() && tree.plan_.stages.back().gathers;
        }
        unsigned blocks(std::size_t i) const { return static_cast<unsigned>(stage(i).blocks()); }
        bool takes_runs(std::size_t i) const { return stage(i).of_runs; }
        template <class Sweep>
        void climb(std::size_t i, Sweep const& sweep) const {
            launch(kernels::climb<Sweep>, stage(i), sweep);
        }
        template <class Sweep>
        void descend(std::size_t i, Sweep const& sweep) const {
            launch(kernels::descend<Sweep>, stage(i), sweep);
        }
        template <class Sweep>
        bool can_turn(std::size_t first, Sweep const&) const {
            return first + 1 == stages() || *tree.together_;
        }
        template <class Sweep>
        void both_passes(std::size_t first, Sweep const& sweep) const {
            bool const together = first + 1 < stages();
            if (together)
                seen.blocks_that_turn.insert(view(tree, stage(first)).blocks);
            else
                ++seen.turns_alone;
            both_passes(first, sweep, kernels::NoExchange{}, nullptr);
        }
        /// As DeviceTree's.
        template <class Sweep, class Exchange>
        bool can_turn(std::size_t first, Sweep const& sweep, Exchange const&,
                      Launches const& top) const {
            return can_turn(first, sweep) && grid_of_both_passes<Sweep>(first, &top).numbers <=
                                                 cuda_on_host::most_shared_bytes / sizeof(double);
        }
        template <class Sweep, class Exchange>
        void both_passes(std::size_t first, Sweep const& sweep, Exchange const& exchange,
                         Launches const& top) const {
            seen.blocks_that_turn_shared.insert(
                first + 1 < stages() ? view(tree, stage(first)).blocks : 0);
            both_passes(first, sweep, exchange, &top);
        }
        template <class Sweep>
        void climb_runs(Sweep const& sweep) const {
            std::int64_t const runs = tree.runs_.count;
            if constexpr (dca::takes_whole_runs<Sweep>) {
                ++(tree.by_teams_ ? seen.whole_runs_by_teams : seen.whole_runs_by_threads);
                if (tree.by_teams_)
                    return over_runs(kernels::climb_runs_by_teams<Sweep>,
                                     kernels::grid_of_climb_by_teams(runs), sweep);
            }
            kernels::RunsGrid const grid = kernels::grid_of_climb<Sweep>(runs, tree.shared_bytes_);
            over_runs(kernels::climb_runs<Sweep>, grid, sweep);
        }
        template <class Sweep>
        void descend_runs(Sweep const& sweep) const {
            std::int64_t const runs = tree.runs_.count;
            if constexpr (dca::takes_whole_runs<Sweep>)
                if (tree.by_teams_)
                    return over_runs(kernels::descend_runs_by_teams<Sweep>,
                                     kernels::grid_of_descent_by_teams<Sweep>(runs), sweep);
            kernels::RunsGrid const grid =
                kernels::grid_of_descent<Sweep>(runs, tree.shared_bytes_);
            over_runs(kernels::descend_runs<Sweep>, grid, sweep);
        }
        template <class Sweep>
        void climb_groups(Sweep const& sweep) const {
            over_runs(kernels::climb_groups<Sweep>,
                      kernels::grid_of_climb<Sweep>(tree.runs_.count, tree.shared_bytes_), sweep);
        }
        template <class Sweep>
        void descend_groups(Sweep const& sweep) const {
            over_runs(kernels::descend_groups<Sweep>,
                      kernels::grid_of_descent<Sweep>(tree.runs_.count, tree.shared_bytes_), sweep);
        }
        template <class Sweep>
        bool can_turn_groups() const {
            return tree.above_groups_.warps > 0;
        }
        template <class Sweep>
        void turn_groups(Sweep const& sweep) const {
            cuda_on_host::Launch const cluster =
                cluster_of<kernels::GroupLanes<Sweep>>(tree, tree.above_groups_);
            seen.blocks_above_groups.insert(cluster.blocks);
            cuda_on_host::launch(cluster, kernels::turn_groups<Sweep>, tree.above_groups_,
                                 cuda::view_of_groups(tree.groups_, tree.groups_.data()), sweep);
        }

      private:
        dca::Stage const& stage(std::size_t i) const { return tree.plan_.stages[i]; }
        template <class Sweep>
        cuda_on_host::Launch grid_of_both_passes(std::size_t first, Launches const* top) const {
            bool const together = first + 1 < stages();
            dca::Stage const &lower = stage(first), &upper = tree.plan_.stages.back();
            auto const of = [&](dca::Stage const& one) {
                return kernels::threads_for<Sweep>(threads_for(one),
                                                   kernels::threads_of_turn<Sweep>);
            };
            int const threads =
                std::max({of(lower), of(upper), top ? kernels::threads_among_ranks<Sweep> : 0});
            EXPECT_LE(threads, kernels::threads_of_turn<Sweep>);
            std::size_t shared = numbers<Sweep>(view(tree, upper), threads);
            if (top) shared += numbers<Sweep>(view(top->tree, top->stage(0)), threads);
            if (together) shared = std::max(shared, numbers<Sweep>(view(tree, lower), threads));
            std::int64_t const blocks = upper.blocks() + (together ? lower.blocks() : 0);
            return {static_cast<unsigned>(blocks), static_cast<unsigned>(threads), shared, 1,
                    together};
        }
        /// `top`: null where nothing is above.
        template <class Sweep, class Exchange>
        void both_passes(std::size_t first, Sweep const& sweep, Exchange const& exchange,
                         Launches const* top) const {
            see_stages();
            bool const together = first + 1 < stages();
            kernels::DeviceStage const here = view(tree, tree.plan_.stages.back()),
                                       below = together ? view(tree, stage(first))
                                                        : kernels::DeviceStage{},
                                       above = top ? view(top->tree, top->stage(0))
                                                   : kernels::DeviceStage{};
            kernels::TopLaunchLetters letters;
            if (together)
                letters = {{tree.up_.data(), here.layout.items},
                           {tree.down_.data(), here.forces},
                           tree.launches_.data()};
            cuda_on_host::launch(grid_of_both_passes<Sweep>(first, top),
                                 kernels::both_passes<Sweep, Exchange>, below, here, above, letters,
                                 exchange, sweep);
        }
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
            return static_cast<std::size_t>(kernels::PlacesOfBlock<Sweep>::size(stage, of_threads));
        }
        template <class Sweep>
        void launch(void (*kernel)(kernels::DeviceStage, Sweep), dca::Stage const& stage,
                    Sweep const& sweep) const {
            see_stages();
            int const threads =
                kernels::threads_for<Sweep>(threads_for(stage), kernels::threads_of<Sweep>);
            auto const here = view(tree, stage);
            cuda_on_host::launch(
                {here.blocks, static_cast<unsigned>(threads), numbers<Sweep>(here, threads)},
                kernel, here, sweep);
        }
        template <class Sweep>
        void over_runs(void (*kernel)(cuda::RunsView, cuda::GroupsView, Sweep),
                       kernels::RunsGrid const& grid, Sweep const& sweep) const {
            cuda_on_host::launch({grid.blocks, grid.threads, grid.shared_bytes / sizeof(double)},
                                 kernel, tree.runs_,
                                 cuda::view_of_groups(tree.groups_, tree.groups_.data()), sweep);
        }
        template <class Sweep>
        void over_runs(void (*kernel)(cuda::RunsView, Sweep), kernels::RunsGrid const& grid,
                       Sweep const& sweep) const {
            cuda_on_host::launch({grid.blocks, grid.threads, grid.shared_bytes / sizeof(double)},
                                 kernel, tree.runs_, sweep);
        }
    };
    static cuda::StageWalk<Launches> walk(Tree const& tree) {
        return cuda::StageWalk<Launches>({tree});
    }
};

}  // namespace catena::test
