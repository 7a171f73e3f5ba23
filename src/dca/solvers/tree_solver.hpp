// Driver of the divide-and-conquer solver for any Space: which sweeps run over which trees, and
// when ranks exchange records. The mathematics is in segment.hpp, leaf.hpp and articulated.hpp.
#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "clock.hpp"
#include "dca/contracts.hpp"
#include "dca/fused_sweep.hpp"
#include "dca/host_space.hpp"
#include "dca/solvers/links_inverse.hpp"
#include "dca/solvers/segment_exchange.hpp"
#include "dca/solvers/side_by_side_tree.hpp"
#include "dca/solvers/sweep_timer.hpp"
#include "dca/sweep_store.hpp"
#include "dca/team_tree.hpp"

namespace catena::dca {

/// Solver of one group of chains with one kind of leaf in one Space. The views that its members
/// take must be in the memory of that Space.
template <TreeLeaf Leaf, SolverSpace Space>
class TreeSolver final : public ChainSolver {
    static constexpr int K = Leaf::K;
    using Sweeps = typename SweepsOf<Leaf>::Sweeps;
    using OfMatrices = typename SweepsOf<Leaf>::OfMatrices;
    using OfBiases = typename SweepsOf<Leaf>::OfBiases;
    // True if evaluations compute runs on revolute joints by articulated-body inertias.
    static constexpr bool takes_runs_whole = requires { requires Leaf::by_inertia; };
    // True if runs of this leaf can be processed side by side in the vectors of this Space.
    static constexpr bool has_lanes =
        goes_side_by_side<Leaf> && requires(Space const& space) { space.simd(); };

  public:
    /// Allocates all arrays. The group and the communicator must outlive the solver.
    TreeSolver(ChainGroup const& group, Space const& space, Communicator const& communicator)
        : group_(group),
          schedule_(group.schedule),
          space_(space),
          communicator_(communicator),
          store_(group, space, space.model(group)),
          tree_(schedule_.runs, schedule_.levels, schedule_.roots, schedule_.slots,
                group.joints.restricted, Sweeps::in_stage),
          top_(no_runs_, schedule_.top_levels, schedule_.top_roots, schedule_.slots,
               group.joints.restricted, Sweeps::in_stage),
          exchange_(schedule_, space, communicator, at_once()) {
        if constexpr (takes_runs_whole)
            if (at_once())
                whole_runs_.emplace(schedule_.runs, schedule_.levels, schedule_.roots,
                                    schedule_.slots, group.joints.restricted,
                                    Sweeps::in_stage_of_whole_runs);
        if constexpr (has_lanes) {
            aside_.emplace(group, store_.model().view(), space.simd());
            if (aside_->empty()) aside_.reset();
        }
    }

    /// Matrix sweep: own trees first, then the exchange of shared units, then the top of shared
    /// chains.
    void assemble_matrices(ConfigurationView const& configuration) override {
        SweepTimer const timer(space_, measured_, report_.matrix_seconds);
        sweeps().leaf.set(configuration);
        if (!assemble_by_teams()) {
            OfMatrices const sweep{sweeps()};
            space_.climb(tree_, sweep);
            if (!schedule_.shared.empty()) {
                gather(exchange_.of_matrices(sweeps()));
                space_.climb(top_, sweep);
            }
        }
        ++report_.matrix_sweeps;
        if (Space::answers_at_once) check();
    }

    /// Bias sweep with the matrices assembled last; may be repeated.
    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        SweepTimer const timer(space_, measured_, report_.bias_seconds);
        up_and_down(tree_, OfBiases{sweeps(), loads, out}, exchange_.of_biases(sweeps()), out);
        ++report_.bias_sweeps;
    }

    /// One evaluation: a fused sweep if at_once(), otherwise a matrix sweep and a bias sweep.
    void assemble_and_solve(ConfigurationView const& configuration, LoadsView const& loads,
                            AccelerationsView const& out) override {
        if constexpr (Leaf::projected)
            if (at_once()) return evaluate(configuration, loads, out);
        ChainSolver::assemble_and_solve(configuration, loads, out);
    }
    /// True if evaluations use the fused sweep. The chapter's pairwise tree and full handles keep
    /// separate sweeps.
    bool at_once() const override {
        return Leaf::projected && group_.partition.trees.front().run_length > 1;
    }
    /// True if evaluations compute runs by articulated-body inertias and all joints but those of
    /// chains' first bodies are revolute.
    bool eliminates_revolute_joints() const override {
        return takes_runs_whole && at_once() && group_.revolute;
    }
    bool has_runs_side_by_side() const override { return aside_.has_value(); }
    /// Times evaluations; shared units may make them depend on work of the host.
    std::vector<double> time_evaluations(ConfigurationView const& configuration,
                                         LoadsView const& loads, AccelerationsView const& out,
                                         int chained, int repeat) override {
        return space_.time_chained(chained, repeat, exchange_.asks_host(),
                                   [&] { assemble_and_solve(configuration, loads, out); });
    }

    /// Computes entries of T^-1 from the roots to the leaves (InverseSweep). The leaves must be
    /// links.
    void invert(InverseView const& out) override {
        if constexpr (Space::answers_at_once && std::is_same_v<Sweeps, TreeSweeps<Leaf>>) {
            if (!inverse_) inverse_.emplace(schedule_);
            inverse_->compute(space_, group_, sweeps(), out);
        } else {
            ChainSolver::invert(out);
        }
    }

    /// True if whole chains can run through several sweeps block by block, without exchange between
    /// ranks, and if this is faster.
    bool carries() const { return schedule_.shared.empty() && space_.pays_by_blocks(group_); }
    /// Calls action(sweeps)(block) for every block of whole chains. Each call executes the given
    /// numbers of matrix and bias sweeps, which are added to the report. Precondition: carries().
    template <class Action>
    void carry(ConfigurationView const& configuration, int matrix_sweeps, int bias_sweeps,
               Action const& action) {
        sweeps().leaf.set(configuration);
        space_.each_block(blocks(), action(sweeps()));
        report_.matrix_sweeps += matrix_sweeps;
        report_.bias_sweeps += bias_sweeps;
        if (Space::answers_at_once) check();
    }

    /// Throws if a pivot failure was found, and resets the record of failures.
    void check() override {
        PivotFailure const found = store_.take_failure(space_);
        if (!found.none())
            refuse_indefinite(group_, communicator_.rank(), static_cast<std::int64_t>(found.joint));
    }
    /// Waits until all work of the Space is complete.
    void wait() override { space_.wait(); }
    void measure(bool on) override { measured_ = on; }

    /// Returns the statistics, with the size of the arrays and the run length and depth of the
    /// tree.
    SolverReport report() const override {
        SolverReport r = report_;
        add_tree(group_, communicator_, r);
        r.threads = space_.threads();
        r.direct_exchange = exchange_.is_direct();
        r.memory_bytes = Sweeps::bytes(schedule_);
        if constexpr (has_lanes)
            if (aside_) {
                r.simd = space_.simd();
                r.memory_bytes += aside_->bytes();
            }
        return r;
    }

  private:
    // The arrays of the sweeps, with the configuration set last.
    Sweeps& sweeps() { return store_.sweeps(); }
    /// Returns the blocks of whole chains; they are made on the first call.
    typename Space::Blocks const& blocks() {
        if (!blocks_) blocks_.emplace(group_);
        return *blocks_;
    }
    /// Assembles the matrices by teams of threads, one thread per part of a run, if all chains are
    /// short enough. Returns false if they are not, and does nothing then.
    bool assemble_by_teams() {
        if constexpr (Space::template has_teams<K>)
            if (carries() && group_.partition.trees.front().run_length == longest_run) {
                space_.each_block(blocks(), MatricesOfChains<Leaf>{sweeps()});
                return true;
            }
        return false;
    }

    /// One evaluation by the fused sweep.
    void evaluate(ConfigurationView const& configuration, LoadsView const& loads,
                  AccelerationsView const& out) {
        SweepTimer const timer(space_, measured_, report_.matrix_seconds);
        sweeps().leaf.set(configuration);
        if constexpr (Leaf::beads)
            sweep_at_once(
                FusedSweep<Leaf, typename Leaf::Moving>{
                    {sweeps()},
                    {store_.model().view(), store_.model().restricted(), configuration, loads},
                    out},
                configuration, loads, out);
        else
            sweep_at_once(
                FusedSweep<Leaf, Resting<Leaf>>{
                    {sweeps()}, {sweeps().leaf, store_.model().restricted(), loads}, out},
                configuration, loads, out);
        ++report_.evaluations;
        if (Space::answers_at_once) check();
    }

    /// Executes the fused sweep. If some runs and merges are processed side by side, the others of
    /// each level follow them.
    template <class Sweep>
    void sweep_at_once(Sweep const& sweep, ConfigurationView const& configuration,
                       LoadsView const& loads, AccelerationsView const& out) {
        if constexpr (has_lanes)
            if (aside_) {
                RunWork<Leaf> work{sweeps(), store_.model().view(), configuration, loads, out};
                return aside_->execute(space_, work, sweep, [&](auto const& roots) {
                    up_and_down(roots, sweep, exchange_.of_both(sweeps()), out);
                });
            }
        up_and_down(whole_runs_ ? *whole_runs_ : tree_, sweep, exchange_.of_both(sweeps()), out);
    }

    /// Executes the inward and the outward pass with the exchange of the shared units' records
    /// (`shown`) between them. With measurement on, the seconds of the exchange are reported.
    template <class Sweep, class Shown>
    void up_and_down(typename Space::Tree const& tree, Sweep const& sweep, Shown const& shown,
                     AccelerationsView const& out) {
        if (schedule_.shared.empty()) {
            space_.climb_and_descend(tree, sweep);
        } else if (measured_ || !shown.units.both_passes(space_, communicator_, shown.numbers, tree,
                                                         top_, sweep)) {
            space_.climb(tree, sweep);
            gather(shown);
            space_.climb_and_descend(top_, sweep);
            space_.descend(tree, sweep);
        }
        // The neighbour rank needs the force of the joint between the two ranks' bodies.
        if (out.joint_force && group_.neighbours.outboard >= 0)
            space_.for_each(1, ForceOfNextRank<Sweeps>{sweeps(), out.joint_force, schedule_.halo,
                                                       schedule_.bodies});
    }

    /// Distributes the records of the shared units to all ranks.
    template <class Shown>
    void gather(Shown const& shown) {
        auto const start = seconds_now();
        shown.gather(space_, communicator_);
        if (measured_) space_.wait();
        report_.exchange_seconds += seconds_now() - start;
    }

    ChainGroup const& group_;
    Schedule const& schedule_;
    Space space_;
    Communicator const& communicator_;
    SweepStore<Leaf, Space> store_;
    // Empty list for the top, which has no runs.
    std::vector<Run> no_runs_;
    // Tree of the chains' parts on this rank, and the top of shared chains.
    typename Space::Tree tree_, top_;
    // Tree of evaluations that compute runs on revolute joints by articulated-body inertias.
    std::optional<typename Space::Tree> whole_runs_;
    SegmentExchange<Sweeps, Space> exchange_;
    // Made on first use or only if needed: blocks of whole chains, and runs and merges that are
    // processed side by side.
    std::optional<typename Space::Blocks> blocks_;
    std::optional<SideBySideTree<Leaf, Space>> aside_;
    std::optional<LinksInverse<Leaf, Space>> inverse_;
    bool measured_ = false;
    SolverReport report_;
};

}  // namespace catena::dca
