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
#include "dca/inverse_sweep.hpp"
#include "dca/simd/side_by_side.hpp"
#include "dca/team_tree.hpp"
#include "tree/frontier_exchange.hpp"

namespace catena::dca {

/// Solver of one group of chains with one kind of leaf in one Space. The views that its members
/// take must be in the memory of that Space.
template <TreeLeaf Leaf, SolverSpace Space>
class TreeSolver final : public ChainSolver {
    static constexpr int K = Leaf::K;
    using Sweeps = typename SweepsOf<Leaf>::Sweeps;
    using OfMatrices = typename SweepsOf<Leaf>::OfMatrices;
    using OfBiases = typename SweepsOf<Leaf>::OfBiases;
    template <class T, Order order>
    using Records = typename Space::template Records<T, order>;
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
          model_(space.model(group)),
          tree_(schedule_.runs, schedule_.levels, schedule_.roots, schedule_.slots,
                group.restricted_of_joint, Sweeps::in_stage),
          top_(no_runs_, schedule_.top_levels, schedule_.top_roots, schedule_.slots,
               group.restricted_of_joint, Sweeps::in_stage),
          matrices_(schedule_.slots),
          biases_(schedule_.slots),
          joints_(schedule_.joints),
          offsets_(schedule_.joints),
          forces_(schedule_.joints),
          shown_matrices_(schedule_, RecordNumbers<typename Sweeps::Matrices>::width, space,
                          communicator),
          shown_biases_(schedule_, RecordNumbers<typename Sweeps::Biases>::width, space,
                        communicator),
          lost_(1),
          sweeps_{Leaf(model_.view()), model_.restricted(), matrices_.view(), biases_.view(),
                  joints_.view(),      offsets_.view(),     forces_.view(),   lost_.data()} {
        space_.put(lost_.data(), none_lost);
        if constexpr (takes_runs_whole)
            if (at_once())
                whole_runs_.emplace(schedule_.runs, schedule_.levels, schedule_.roots,
                                    schedule_.slots, group.restricted_of_joint,
                                    Sweeps::in_stage_of_whole_runs);
        if (at_once())
            shown_both_.emplace(schedule_, NumbersOfSegments::width, space, communicator);
        if constexpr (has_lanes) {
            aside_.emplace(group, model_.view(), space.simd());
            if (aside_->items() > 0)
                lay_out_rest();
            else
                aside_.reset();
        }
    }

    /// Matrix sweep: own trees first, then the exchange of shared units, then the top of shared
    /// chains.
    void assemble_matrices(ConfigurationView const& configuration) override {
        Stopwatch const watch(*this, report_.matrix_seconds);
        sweeps_.leaf.set(configuration);
        if (!assemble_by_teams()) {
            OfMatrices const sweep{sweeps_};
            space_.climb(tree_, sweep);
            if (!schedule_.shared.empty()) {
                gather(of_matrices());
                space_.climb(top_, sweep);
            }
        }
        ++report_.matrix_sweeps;
        if (Space::answers_at_once) check();
    }

    /// Bias sweep with the matrices assembled last; may be repeated.
    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        Stopwatch const watch(*this, report_.bias_seconds);
        up_and_down(tree_, OfBiases{sweeps_, loads, out}, of_biases(), out);
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
        return space_.time_chained(chained, repeat, shown_matrices_.asks_host(),
                                   [&] { assemble_and_solve(configuration, loads, out); });
    }

    /// Computes entries of T^-1 from the roots to the leaves (InverseSweep). The leaves must be
    /// links.
    void invert(InverseView const& out) override {
        if constexpr (Space::answers_at_once && std::is_same_v<Sweeps, TreeSweeps<Leaf>>) {
            if (!inverse_) inverse_.emplace(schedule_);
            InverseSweep<Leaf> const sweep{sweeps_, inverse_->own.view(), inverse_->across.view(),
                                           out.beside};
            auto const each = [&](auto const& items) { space_.over(std::span(items), sweep); };
            auto const each_level = [&](auto const& levels) {
                for (std::size_t l = levels.size(); l-- > 0;) each(levels[l]);
            };
            each(schedule_.top_roots);
            each_level(schedule_.top_levels);
            each(schedule_.roots);
            each_level(schedule_.levels);
            each(schedule_.runs);
            // Returns the pivot of a joint; its inverse is 0 if nothing is restricted there.
            auto const pivot = [this](std::int64_t joint) {
                double const inverse = sweeps_.joints.load(joint).factor(0, 0);
                return inverse != 0 ? 1 / inverse : 1.0;
            };
            space_.for_each(group_.size, [&](std::int64_t k) { out.pivot.at(k, 0) = pivot(k); });
            for (std::size_t i = 0; i < group_.tips.size(); ++i)
                out.tip_pivot.at(group_.tips[i].body, 0) =
                    pivot(schedule_.first_tip() + static_cast<std::int64_t>(i));
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
        sweeps_.leaf.set(configuration);
        space_.each_block(blocks(), action(sweeps_));
        report_.matrix_sweeps += matrix_sweeps;
        report_.bias_sweeps += bias_sweeps;
        if (Space::answers_at_once) check();
    }

    /// Throws if a pivot failure was found, and resets the record of failures.
    void check() override {
        unsigned long long const bad = space_.get(lost_.data());
        if (bad == none_lost) return;
        space_.put(lost_.data(), none_lost);
        refuse_indefinite(group_, communicator_.rank(), static_cast<std::int64_t>(bad));
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
        r.direct_exchange = shown_matrices_.is_direct();
        r.memory_bytes = Sweeps::bytes(schedule_);
        if constexpr (has_lanes)
            if (aside_) {
                r.simd = space_.simd();
                r.memory_bytes += aside_->bytes();
            }
        return r;
    }

  private:
    // Value of `lost_` without a pivot failure.
    static constexpr unsigned long long none_lost = ~0ULL;

    /// Builds the trees of everything that is not processed side by side: runs, one level after the
    /// other, and the roots.
    void lay_out_rest() {
        auto const add = [&](auto const& runs, auto const& levels, auto const& roots) {
            rest_.emplace_back(runs, levels, roots, schedule_.slots, group_.restricted_of_joint,
                               Sweeps::in_stage);
        };
        add(aside_->other_runs(), no_levels_, no_roots_);
        for (LevelDealtOut const& level : aside_->levels()) add(no_runs_, level.others, no_roots_);
        add(no_runs_, no_levels_, schedule_.roots);
    }
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
                space_.each_block(blocks(), MatricesOfChains<Leaf>{sweeps_});
                return true;
            }
        return false;
    }

    /// One evaluation by the fused sweep.
    void evaluate(ConfigurationView const& configuration, LoadsView const& loads,
                  AccelerationsView const& out) {
        Stopwatch const watch(*this, report_.matrix_seconds);
        sweeps_.leaf.set(configuration);
        if constexpr (Leaf::beads)
            sweep_at_once(
                FusedSweep<Leaf, typename Leaf::Moving>{
                    {sweeps_}, {model_.view(), model_.restricted(), configuration, loads}, out},
                configuration, loads, out);
        else
            sweep_at_once(
                FusedSweep<Leaf, Resting<Leaf>>{
                    {sweeps_}, {sweeps_.leaf, model_.restricted(), loads}, out},
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
                RunWork<Leaf> work{sweeps_, model_.view(), configuration, loads, out};
                aside_->climb(space_, work);
                space_.climb(rest_.front(), sweep);
                for (std::size_t l = 0; l < aside_->levels().size(); ++l) {
                    aside_->climb_level(space_, sweeps_, l);
                    space_.climb(rest_[1 + l], sweep);
                }
                up_and_down(rest_.back(), sweep, of_both(), out);
                for (std::size_t l = aside_->levels().size(); l-- > 0;) {
                    aside_->descend_level(space_, sweeps_, l);
                    space_.descend(rest_[1 + l], sweep);
                }
                space_.descend(rest_.front(), sweep);
                return aside_->descend(space_, work);
            }
        up_and_down(whole_runs_ ? *whole_runs_ : tree_, sweep, of_both(), out);
    }

    /// Adds the seconds of a sweep to the report. If the space does not wait for its work, it does
    /// so only while measurement is on.
    class Stopwatch {
      public:
        Stopwatch(TreeSolver& solver, double& seconds)
            : solver_(solver), seconds_(seconds), start_(seconds_now()) {}
        ~Stopwatch() {
            if (solver_.measured_) solver_.space_.wait();
            if (solver_.measured_ || Space::answers_at_once) seconds_ += seconds_now() - start_;
        }
        Stopwatch(Stopwatch const&) = delete;
        Stopwatch& operator=(Stopwatch const&) = delete;

      private:
        TreeSolver& solver_;
        double& seconds_;
        double start_;
    };

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
        if (out.joint_force && group_.neighbour_outboard >= 0)
            space_.for_each(1, ForceOfNextRank<Sweeps>{sweeps_, out.joint_force, schedule_.halo,
                                                       schedule_.bodies});
    }

    // Numbers of a shared unit's record when matrices and biases are exchanged together.
    using NumbersOfSegments = NumbersOfBoth<typename Sweeps::Matrices, typename Sweeps::Biases>;
    // Exchange of shared units and the numbers of the records to be exchanged.
    template <class Numbers>
    struct Shown {
        FrontierExchange<Space>& units;
        Numbers numbers;
    };
    /// Distributes the records of the shared units to all ranks.
    template <class Numbers>
    void gather(Shown<Numbers> const& shown) {
        auto const start = seconds_now();
        shown.units.show(space_, shown.numbers);
        shown.units.bring(space_, communicator_, shown.numbers);
        if (measured_) space_.wait();
        report_.exchange_seconds += seconds_now() - start;
    }
    /// Returns the exchange of the matrices of shared units.
    Shown<RecordNumbers<typename Sweeps::Matrices>> of_matrices() {
        return {shown_matrices_,
                {matrices_.view(), shown_matrices_.own_units(), shown_matrices_.units()}};
    }
    /// Returns the exchange of the biases of shared units.
    Shown<RecordNumbers<typename Sweeps::Biases>> of_biases() {
        return {shown_biases_, {biases_.view(), shown_biases_.own_units(), shown_biases_.units()}};
    }
    /// Returns the exchange of matrices and biases together. Precondition: at_once().
    Shown<NumbersOfSegments> of_both() {
        return {*shown_both_,
                {matrices_.view(), biases_.view(), shown_both_->own_units(), shown_both_->units()}};
    }

    ChainGroup const& group_;
    Schedule const& schedule_;
    Space space_;
    Communicator const& communicator_;
    typename Space::Model model_;
    // Empty lists for trees without runs, merges or roots.
    std::vector<Run> no_runs_;
    std::vector<std::vector<Merge>> no_levels_;
    std::vector<Root> no_roots_;
    // Tree of the chains' parts on this rank, and the top of shared chains.
    typename Space::Tree tree_, top_;
    // Tree of evaluations that compute runs on revolute joints by articulated-body inertias.
    std::optional<typename Space::Tree> whole_runs_;
    // Segments, indexed by slot.
    Records<typename Sweeps::Matrices, Order::plain> matrices_;
    Records<typename Sweeps::Biases, Order::plain> biases_;
    // Nodes and states, indexed by joint.
    Records<typename Sweeps::Joint, Order::by_body> joints_;
    Records<typename Sweeps::Offset, Order::by_body> offsets_;
    Records<typename Sweeps::State, Order::by_body> forces_;
    FrontierExchange<Space> shown_matrices_, shown_biases_;
    // Exchange of the fused sweep, if evaluations use it.
    std::optional<FrontierExchange<Space>> shown_both_;
    // Smallest joint with a pivot failure, or none_lost.
    typename Space::template Array<unsigned long long> lost_;
    Sweeps sweeps_;
    // Made on first use or only if needed: blocks of whole chains, and runs and merges that are
    // processed side by side.
    std::optional<typename Space::Blocks> blocks_;
    std::optional<SideBySide<Leaf>> aside_;
    // Trees of everything that is not processed side by side, see lay_out_rest().
    std::vector<typename Space::Tree> rest_;
    /// Arrays of InverseSweep; allocated when invert() is called.
    struct Inverse {
        explicit Inverse(Schedule const& schedule) : own(schedule.joints), across(schedule.slots) {}
        Records<double, Order::plain> own, across;
    };
    std::optional<Inverse> inverse_;
    bool measured_ = false;
    SolverReport report_;
};

}  // namespace catena::dca
