// What the launches of a tree's sweeps read in the GPU's memory, and the launches.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "cuda/device/clusters.hpp"
#include "cuda/device/launch.cuh"
#include "cuda/device/owners.hpp"
#include "cuda/exchange/peer_exchange.cuh"
#include "cuda/short/short_chain.cuh"
#include "cuda/sweeps/cluster_launch.cuh"
#include "cuda/sweeps/group_lanes.cuh"
#include "cuda/sweeps/stage_walk.cuh"
#include "cuda/sweeps/team_launches.cuh"
#include "cuda/sweeps/top_launch.cuh"
#include "tree/stages.hpp"

namespace catena::cuda {

/// A stage's lists and kept records in the GPU's memory.
struct StageInMemory {
    StageInMemory(dca::Stage const& stage, dca::StagesTogether const& together,
                  RunsView const& runs, dca::StageSizes const& sizes,
                  dca::StageRecords const& records)
        : words(dca::words_of(stage, together)),
          roots(stage.roots),
          kept(static_cast<std::size_t>(dca::kept_numbers(stage, records))),
          threads(dca::threads_for(stage, sizes)),
          view{static_cast<unsigned>(stage.blocks()),
               static_cast<int>(stage.forces),
               dca::layout_of(stage),
               runs,
               words.data(),
               roots.data(),
               kept.data(),
               stage.gathers} {}
    /// Encoded lists of all blocks (tree/stage_encoding.hpp).
    Buffer<dca::StageWord> words;
    Buffer<dca::StageRoot> roots;
    /// Places that blocks keep between the passes.
    Buffer<double> kept;
    /// Planned threads per block.
    int threads;
    kernels::DeviceStage view;
};

/// A planned tree in the GPU's memory: its runs, groups of runs and stages, and the launches that
/// perform several of them at once.
struct PlannedTree {
    /// Plans the stages, and copies runs and stages to the GPU. `all`: the runs;
    /// `slots`: number of segments; `restricted`: number of restricted directions of every joint.
    PlannedTree(std::vector<dca::Run> const& all,
                std::vector<std::vector<dca::Merge>> const& levels,
                std::vector<dca::Root> const& roots, std::int64_t slots,
                std::span<std::uint8_t const> restricted, dca::StageRecords const& records)
        : run_list(all), runs(view_of(all, run_list.data())) {
        dca::StageSizes const sizes = sizes_here(records, bytes_of_block);
        dca::StagePlan const plan = dca::plan_stages(all, levels, roots, slots, restricted, sizes);
        runs_apart = plan.runs_apart;
        gathers = !plan.stages.empty() && plan.stages.back().gathers;
        dca::StagesTogether const together(plan, sizes);
        for (dca::Stage const& stage : plan.stages)
            stages.emplace_back(stage, together, stage.of_runs ? runs : RunsView{}, sizes, records);
        if (together) turn = TopLaunch(together, records, bytes_of_block);
        auto const one_chain = [&](std::int64_t bodies_of_lane) {
            return ClusterLaunch(knows_clusters()
                                     ? kernels::one_chain_of(all, levels, roots, bodies_of_lane)
                                     : kernels::OneChain{},
                                 bytes_of_block);
        };
        short_chain = one_chain(dca::part_length);
        // If stages contain the runs as well, fewer launches are needed without groups.
        if (!runs_apart) return;
        std::vector<dca::Run> const grouped = groups_of(all, levels, records);
        if (!grouped.empty()) above_groups = one_chain(bodies_of_group);
        if (!above_groups) return;
        group_list = Buffer<dca::Run>(grouped);
        groups = view_of_groups(grouped, group_list.data());
    }

    int bytes_of_block = 0;  // largest shared memory of a block
    /// Runs of the tree: their list and its view.
    Buffer<dca::Run> run_list;
    RunsView runs;
    Buffer<dca::Run> group_list;
    GroupsView groups;  // empty if no launch uses groups
    std::vector<StageInMemory> stages;
    bool runs_apart = false, gathers = false;
    /// Launch of the last two stages at once; empty if that is not possible.
    TopLaunch turn;
    /// Launches of one cluster: for a whole short chain, and for the tree above groups.
    ClusterLaunch short_chain, above_groups;

  private:
    /// Returns the sizes of stages for the present GPU and stores its shared memory per block.
    static dca::StageSizes sizes_here(dca::StageRecords const& records, int& shared_bytes) {
        shared_bytes = static_cast<int>(most_shared_bytes());
        return dca::stage_sizes(records, shared_bytes, blocks_at_once());
    }
};

/// Launches of a planned tree that StageWalk requests; see there.
struct TreeLaunches {
    PlannedTree const& tree;
    cudaStream_t stream;

    std::size_t stages() const { return tree.stages.size(); }
    unsigned blocks(std::size_t i) const { return tree.stages[i].view.blocks; }
    bool runs_apart() const { return tree.runs_apart; }
    bool gathers() const { return tree.gathers; }
    bool takes_runs(std::size_t i) const { return static_cast<bool>(tree.stages[i].view.runs); }
    template <class Sweep>
    void climb(std::size_t i, Sweep const& sweep) const {
        launch(kernels::climb<Sweep>,
               grid_of(tree.stages[i], tree.stages[i].threads, kernels::threads_of<Sweep>, sweep),
               tree.stages[i].view, sweep);
    }
    template <class Sweep>
    void descend(std::size_t i, Sweep const& sweep) const {
        launch(kernels::descend<Sweep>,
               grid_of(tree.stages[i], tree.stages[i].threads, kernels::threads_of<Sweep>, sweep),
               tree.stages[i].view, sweep);
    }
    /// True if stage `first` and the one above it run at once, or if it is the last stage.
    template <class Sweep>
    bool can_turn(std::size_t first, Sweep const& sweep) const {
        return first + 1 == stages() || runs_at_once<kernels::NoExchange>(first, sweep, nullptr);
    }
    /// Launches both passes of stage `first` and of the one above it.
    template <class Sweep>
    void both_passes(std::size_t first, Sweep const& sweep) const {
        both_passes(first, sweep, kernels::NoExchange{}, nullptr);
    }
    /// True if both passes fit in a launch that also contains an exchange and `top`.
    template <class Sweep, class Numbers>
    bool can_turn(std::size_t first, Sweep const& sweep, ExchangeInTurn<Numbers> const&,
                  TreeLaunches const& top) const {
        StageInMemory const& above = top.tree.stages.back();
        if (first + 1 < stages())
            return runs_at_once<kernels::ExchangeByBlock<Numbers>>(first, sweep, &above);
        return grid_of_both_passes(first, sweep, &above).shared_bytes <= shared_bytes();
    }
    /// Launches both passes with an exchange and the passes of `top`.
    template <class Sweep, class Numbers>
    void both_passes(std::size_t first, Sweep const& sweep, ExchangeInTurn<Numbers> const& exchange,
                     TreeLaunches const& top) const {
        both_passes(first, sweep, exchange.next(), &top.tree.stages.back());
        ++turns_shared;
    }
    /// Launches the inward pass of the runs, by teams of lanes if there are few runs.
    template <class Sweep>
    void climb_runs(Sweep const& sweep) const {
        std::int64_t const runs = tree.runs.count;
        if constexpr (dca::takes_whole_runs<Sweep>)
            if (runs <= kernels::most_runs_of_teams)
                return launch(kernels::climb_runs_by_teams<Sweep>,
                              kernels::grid_of_climb_by_teams(runs), sweep);
        launch(kernels::climb_runs<Sweep>, kernels::grid_of_climb<Sweep>(runs, shared_bytes()),
               sweep);
    }
    /// Launches the outward pass of the runs, by teams of lanes if there are few runs.
    template <class Sweep>
    void descend_runs(Sweep const& sweep) const {
        std::int64_t const runs = tree.runs.count;
        if constexpr (dca::takes_whole_runs<Sweep>)
            if (runs <= kernels::most_runs_of_teams)
                return launch(kernels::descend_runs_by_teams<Sweep>,
                              kernels::grid_of_descent_by_teams<Sweep>(runs), sweep);
        launch(kernels::descend_runs<Sweep>, kernels::grid_of_descent<Sweep>(runs, shared_bytes()),
               sweep);
    }
    /// Launches the inward pass of the runs and of the levels within groups.
    template <class Sweep>
    void climb_groups(Sweep const& sweep) const {
        launch(kernels::climb_groups<Sweep>,
               kernels::grid_of_climb<Sweep>(tree.runs.count, shared_bytes()), sweep);
    }
    /// Launches the outward pass of the levels within groups and of the runs.
    template <class Sweep>
    void descend_groups(Sweep const& sweep) const {
        launch(kernels::descend_groups<Sweep>,
               kernels::grid_of_descent<Sweep>(tree.runs.count, shared_bytes()), sweep);
    }
    /// True if one cluster can hold the tree above the groups.
    template <class Sweep>
    bool can_turn_groups() const {
        return grid_above_groups<Sweep>().blocks > 0;
    }
    /// Launches both passes of the tree above the groups.
    template <class Sweep>
    void turn_groups(Sweep const& sweep) const {
        tree.above_groups.launch(grid_above_groups<Sweep>(), stream, kernels::turn_groups<Sweep>,
                                 tree.groups, sweep);
        ++groups_turned;
    }

  private:
    /// Returns the largest shared memory of a block, bytes.
    std::size_t shared_bytes() const { return static_cast<std::size_t>(tree.bytes_of_block); }
    /// Returns the cluster's grid for the tree above groups; it has no blocks if that is not
    /// possible.
    template <class Sweep>
    Grid const& grid_above_groups() const {
        return tree.above_groups.grid<kernels::GroupLanes<Sweep>>(kernels::turn_groups<Sweep>);
    }
    /// Returns the grid of one stage.
    template <class Sweep>
    static Grid grid_of(StageInMemory const& stage, int planned_threads, int most_threads,
                        Sweep const&) {
        int const of_block = kernels::threads_for<Sweep>(planned_threads, most_threads);
        return {stage.view.blocks, static_cast<unsigned>(of_block),
                sizeof(double) * static_cast<std::size_t>(
                                     kernels::PlacesOfBlock<Sweep>::size(stage.view, of_block))};
    }
    /// Launches both passes of the last stages. `top`: null if there is no stage above.
    template <class Sweep, class Exchange>
    void both_passes(std::size_t first, Sweep const& sweep, Exchange const& exchange,
                     StageInMemory const* top) const {
        bool const together = first + 1 < stages();
        launch(kernels::both_passes<Sweep, Exchange>, grid_of_both_passes(first, sweep, top),
               together ? tree.stages[first].view : kernels::DeviceStage{}, tree.stages.back().view,
               top ? top->view : kernels::DeviceStage{},
               together ? tree.turn.letters() : kernels::TopLaunchLetters{}, exchange, sweep);
        if (together) ++turns_together;
    }
    /// True if all blocks of the launch run at once. While the launch waits for other ranks,
    /// one multiprocessor remains for the kernel in which they meet (arrived_beads.cu).
    template <class Exchange, class Sweep>
    bool runs_at_once(std::size_t first, Sweep const& sweep, StageInMemory const* top) const {
        return tree.turn && tree.turn.fits(kernels::both_passes<Sweep, Exchange>,
                                           grid_of_both_passes(first, sweep, top), top ? 1 : 0);
    }
    /// Returns the grid of a launch that performs both passes of the last stages, and of `top`
    /// if not null.
    template <class Sweep>
    Grid grid_of_both_passes(std::size_t first, Sweep const& sweep,
                             StageInMemory const* top) const {
        StageInMemory const &lower = tree.stages[first], &upper = tree.stages.back();
        int const planned =
            std::max({lower.threads, upper.threads, top ? kernels::threads_among_ranks<Sweep> : 0});
        auto const of = [&](StageInMemory const& stage) {
            return grid_of(stage, planned, kernels::threads_of_turn<Sweep>, sweep);
        };
        Grid grid = of(upper);
        if (top) grid.shared_bytes += of(*top).shared_bytes;
        if (first + 1 == stages()) return grid;
        Grid const below = of(lower);
        grid.blocks += below.blocks;
        grid.shared_bytes = std::max(grid.shared_bytes, below.shared_bytes);
        grid.all_at_once = true;
        return grid;
    }
    /// Launches a kernel after permitting its shared memory.
    template <class... Parameters>
    void launch(void (*kernel)(Parameters...), Grid const& grid,
                std::type_identity_t<Parameters> const&... arguments) const {
        allow_shared(kernel, grid.shared_bytes);
        cuda::launch(grid, stream, kernel, arguments...);
    }
    /// Launches a kernel over groups of runs.
    template <class Sweep>
    void launch(void (*kernel)(RunsView, GroupsView, Sweep), kernels::RunsGrid const& grid,
                Sweep const& sweep) const {
        launch(kernel, Grid{grid.blocks, grid.threads, grid.shared_bytes}, tree.runs, tree.groups,
               sweep);
    }
    /// Launches a kernel over runs.
    template <class Sweep>
    void launch(void (*kernel)(RunsView, Sweep), kernels::RunsGrid const& grid,
                Sweep const& sweep) const {
        launch(kernel, Grid{grid.blocks, grid.threads, grid.shared_bytes}, tree.runs, sweep);
    }
};

}  // namespace catena::cuda
