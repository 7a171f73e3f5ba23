#include "dca/articulated_sweeps.hpp"
#include "dca/host_space.hpp"
#include "dca/shared_units.hpp"

namespace catena::dca {
namespace {

/// Over the same tree, ranks and threads as TreeSolver; on the host alone.
template <bool sliding>
class ArticulatedSolver final : public ChainSolver {
    using Leaf = ArticulatedLeaf<sliding>;
    using Sweeps = ArticulatedSweeps<Leaf>;
    template <class T, Order order>
    using Records = HostSpace::Records<T, order>;

  public:
    ArticulatedSolver(ChainGroup const& group, HostSpace const& space, Communicator const& communicator)
        : group_(group),
          schedule_(group.schedule),
          space_(space),
          communicator_(communicator),
          tree_(schedule_.runs, schedule_.levels, schedule_.roots, schedule_.slots, group.restricted_of_joint, Leaf::K),
          top_(no_runs_, schedule_.top_levels, schedule_.top_roots, schedule_.slots, group.restricted_of_joint, Leaf::K),
          matrices_(schedule_.slots),
          biases_(schedule_.slots),
          joints_(schedule_.joints),
          offsets_(schedule_.joints),
          states_(schedule_.joints),
          shown_matrices_(schedule_, RecordNumbers<typename Sweeps::Matrices>::width, space, communicator),
          shown_biases_(schedule_, RecordNumbers<typename Sweeps::Biases>::width, space, communicator),
          sweeps_{Leaf(group),      group.restricted_of_joint.data(),
                  matrices_.view(), biases_.view(),
                  joints_.view(),   offsets_.view(),
                  states_.view(),   &lost_} {}

    void assemble_matrices(ConfigurationView const& configuration) override {
        double const start = seconds_now();
        sweeps_.leaf.set(configuration);
        ArticulatedMatrixSweep<Leaf> const sweep{sweeps_};
        space_.climb(tree_, sweep);
        if (!schedule_.shared.empty()) {
            gather(shown_matrices_, matrices_);
            space_.climb(top_, sweep);
        }
        ++report_.matrix_sweeps;
        report_.matrix_seconds += seconds_now() - start;
        check();
    }

    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        double const start = seconds_now();
        ArticulatedBiasSweep<Leaf> const sweep{sweeps_, loads, out};
        space_.climb(tree_, sweep);
        if (!schedule_.shared.empty()) {
            gather(shown_biases_, biases_);
            space_.climb_and_descend(top_, sweep);
            for (TopCopy const& copy : schedule_.top_copies) sweeps_.forces.store(copy.to, sweeps_.forces.load(copy.from));
        }
        space_.descend(tree_, sweep);
        if (out.joint_force && group_.neighbour_outboard >= 0)
            out.joint_force.store<Leaf::K>(schedule_.bodies, sweeps_.forces.load(schedule_.halo).force);
        ++report_.bias_sweeps;
        report_.bias_seconds += seconds_now() - start;
    }

    void check() override {
        unsigned long long const bad = std::exchange(lost_, Lost{}.joint);
        if (bad != Lost{}.joint) refuse_indefinite(group_, communicator_.rank(), static_cast<std::int64_t>(bad));
    }

    SolverReport report() const override {
        SolverReport r = report_;
        add_tree(group_, communicator_, r);
        r.threads = space_.threads();
        r.memory_bytes = Sweeps::bytes(schedule_);
        return r;
    }

  private:
    static double seconds_now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

    /// The shared units' records, to all ranks.
    template <class T>
    void gather(SharedUnits<HostSpace>& units, Records<T, Order::plain>& records) {
        double const start = seconds_now();
        RecordNumbers<T> const numbers{records.view(), units.own_units(), units.units()};
        units.show(space_, numbers);
        units.bring(space_, communicator_, numbers);
        report_.exchange_seconds += seconds_now() - start;
    }

    ChainGroup const& group_;
    Schedule const& schedule_;
    HostSpace space_;
    Communicator const& communicator_;
    std::vector<Run> no_runs_;
    HostSpace::Tree tree_, top_;
    Records<typename Sweeps::Matrices, Order::plain> matrices_;
    Records<typename Sweeps::Biases, Order::plain> biases_;
    Records<typename Sweeps::Joint, Order::by_body> joints_;
    Records<typename Sweeps::Offset, Order::by_body> offsets_;
    Records<typename Sweeps::State, Order::by_body> states_;
    SharedUnits<HostSpace> shown_matrices_, shown_biases_;
    unsigned long long lost_ = Lost{}.joint;
    Sweeps sweeps_;
    SolverReport report_;
};

}  // namespace

std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const& group, Executor const& executor, Communicator const& communicator) {
    if (group.has_screws) return std::make_unique<ArticulatedSolver<true>>(group, HostSpace(executor), communicator);
    return std::make_unique<ArticulatedSolver<false>>(group, HostSpace(executor), communicator);
}

}  // namespace catena::dca
