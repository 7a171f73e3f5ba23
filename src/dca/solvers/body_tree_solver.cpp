// Host solver of branched chains of rigid bodies in joint coordinates. Every body is held at the
// inboard side of its inboard joint, as with articulated handles (dca/articulated.hpp). Level by
// level, the inertia of a body and of everything outboard of it is formed at that side, and added
// to the inboard body (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 7.3).
#include "clock.hpp"
#include "dca/host_space.hpp"
#include "dca/leaf_choice.hpp"
#include "dca/solvers/sweep_timer.hpp"
#include "dca/tree_body.hpp"
#include "tree/levels.hpp"

namespace catena::dca {
namespace {

using Vec6 = Vector<double, 6>;

/// Solver of a group of branched chains of rigid bodies. `sliding`: some joint translates.
template <bool sliding>
class BodyTreeSolver final : public ChainSolver {
    using Leaf = ArticulatedLeaf<sliding>;
    using Body = TreeBody<sliding>;

  public:
    /// The group, the executor and the communicator must outlive the solver.
    BodyTreeSolver(ChainGroup const& group, Executor const& executor,
                   Communicator const& communicator)
        : group_(group),
          space_(executor),
          alone_(this_thread()),
          communicator_(communicator),
          model_(space_.model(group)),
          leaf_(model_.view()),
          levels_(group.branching.inboard),
          body_(static_cast<std::size_t>(group.size)) {}

    void assemble_matrices(ConfigurationView const& configuration) override {
        SweepTimer const timer(space_, measured_, report_.matrix_seconds);
        configuration_ = configuration;
        leaf_.set(configuration);
        inward([this](std::int64_t k) { assemble(k); });
        ++report_.matrix_sweeps;
        refuse_lost_pivots();
    }
    void solve(LoadsView const& loads, AccelerationsView const& out) override {
        SweepTimer const timer(space_, measured_, report_.bias_seconds);
        inward([&](std::int64_t k) { set_bias(loads, k); });
        outward([&](std::int64_t k) { accelerate(out, k); });
        ++report_.bias_sweeps;
    }
    std::vector<double> time_evaluations(ConfigurationView const& configuration,
                                         LoadsView const& loads, AccelerationsView const& out,
                                         int chained, int repeat) override {
        return space_.time_chained(chained, repeat, false,
                                   [&] { assemble_and_solve(configuration, loads, out); });
    }
    void measure(bool on) override { measured_ = on; }
    SolverReport report() const override {
        SolverReport r = report_;
        add_tree(group_, communicator_, r);
        r.handles = name_of(Handles::articulated);
        r.run_length = 1;
        r.depth =
            static_cast<std::int64_t>(communicator_.max(static_cast<double>(levels_.depth())));
        r.threads = space_.threads();
        r.memory_bytes = group_.size * static_cast<std::int64_t>(sizeof(Body));
        return r;
    }

  private:
    Body& at(std::int64_t k) { return body_[static_cast<std::size_t>(k)]; }
    /// Throws ComputationError for the first body with an inertia that is not positive definite.
    void refuse_lost_pivots() {
        for (std::int64_t k = 0; k < group_.size; ++k)
            for (int i = group_.restricted(k); i < 6; ++i)
                if (double const own = at(k).direction[i].own; !(own > 0 && own - own == 0))
                    refuse_indefinite(group_, communicator_.rank(), k);
    }

    /// Calls action(k) for every body of a level.
    template <class Action>
    void each(std::int64_t level, Action const& action) const {
        std::int64_t const first = levels_.first_of_level[static_cast<std::size_t>(level)],
                           end = levels_.first_of_level[static_cast<std::size_t>(level) + 1];
        HostSpace const& space = end - first < level_worth_threads ? alone_ : space_;
        space.for_each(end - first, [&](std::int64_t i) {
            action(levels_.body[static_cast<std::size_t>(first + i)]);
        });
    }
    /// Calls action(k) for every body, after all bodies outboard of it.
    template <class Action>
    void inward(Action const& action) const {
        for (std::int64_t level = levels_.levels(); level-- > 0;) each(level, action);
    }
    /// Calls action(k) for every body, after its inboard body.
    template <class Action>
    void outward(Action const& action) const {
        for (std::int64_t level = 0; level < levels_.levels(); ++level) each(level, action);
    }

    /// Handle of the inboard body of body k at the joint between them.
    typename Body::HandleOf seat(std::int64_t k) const {
        Vec3 const r = configuration_.r2.origin ? configuration_.r2.load(k) : group_.bodies.r2[k];
        Mat3 const axes = axes_of(configuration_.axes2.origin ? configuration_.axes2.load(k)
                                                              : group_.bodies.axes2[k]);
        auto handle = make_handle<6, sliding>(r, axes, axes);
        if constexpr (sliding)
            turn_to_screw(as_screw(group_.joints.screw[k]), r, axes, axes, handle);
        return handle;
    }

    /// Forms the matrices of body k. Those of the bodies on it are known.
    void assemble(std::int64_t k) {
        Body& b = at(k);
        auto const held = leaf_.held(k);
        b.turning = held.turning;
        b.shifting = held.shifting;
        b.handle = held.handles.h1;
        b.held = held.matrix.inertia;
        for (std::int64_t const c : levels_.children(k)) {
            Body& child = at(c);
            child.seat = seat(c);
            for (int j = 0; j < 6; ++j)
                child.carry.set_column(
                    j, along(child.seat, b.turning.column(j), b.shifting.column(j)));
            b.held = plus_symmetric_part(
                b.held, transposed_times(child.carry, full(child.inertia) * child.carry));
        }
        b.inertia = b.held;
        for (int i = 5; i >= group_.restricted(k); --i) b.direction[i] = released(i, b.inertia);
    }

    /// Forms the bias of body k. Those of the bodies on it are known.
    void set_bias(LoadsView const& loads, std::int64_t k) {
        Body& b = at(k);
        Vec3 const w = read_or_zero(loads.omega, k);
        Vec3 torque = read_or_zero(loads.torque, k);
        if (loads.gyroscopic)
            torque = torque - cross(w, as_symmetric(group_.bodies.inertia[k]) * w);
        b.closure = along(b.handle, Vec3::zero(), cross(w, cross(w, group_.bodies.r1[k])));
        if (loads.bias) b.closure = b.closure + loads.bias.template load<6>(k);
        b.force = -transposed_times(b.turning, torque) -
                  transposed_times(b.shifting, read_or_zero(loads.force, k));
        for (std::int64_t const c : levels_.children(k)) {
            Body& child = at(c);
            Vec3 const r =
                configuration_.r2.origin ? configuration_.r2.load(c) : group_.bodies.r2[c];
            child.of_seat = along(child.seat, Vec3::zero(), cross(w, cross(w, r)));
            b.force = b.force +
                      transposed_times(child.carry, child.inertia * child.of_seat + child.force);
        }
        b.force = b.force - b.held * b.closure;
        for (int i = 5; i >= group_.restricted(k); --i) {
            b.push[i] = -b.force[i];
            double const rate = b.force[i] / b.direction[i].own;
            for (int j = 0; j < 6; ++j)
                b.force[j] = j == i ? 0.0 : less_product(rate, b.direction[i].row[j], b.force[j]);
        }
    }

    /// Computes the acceleration of body k and the force of its inboard joint. Those of its inboard
    /// body are known. The acceleration of the ground is in the biases.
    void accelerate(AccelerationsView const& out, std::int64_t k) {
        Body& b = at(k);
        std::int64_t const inboard = group_.branching.inboard[static_cast<std::size_t>(k)];
        int const restricted = group_.restricted(k);
        Vec6 a = inboard < 0 ? Vec6::zero() : b.carry * at(inboard).acceleration + b.of_seat;
        for (int i = restricted; i < 6; ++i) {
            a[i] = b.push[i];
            for (int j = 0; j < i; ++j) a[i] = less_product(b.direction[i].row[j], a[j], a[i]);
            a[i] = a[i] / b.direction[i].own;
        }
        if (out.joint_force) {
            Vec6 f = b.inertia * a + b.force;
            for (int i = restricted; i < 6; ++i) f[i] = 0;
            out.joint_force.store<6>(k, f);
        }
        b.acceleration = a - b.closure;
        if (out.alpha.origin) out.alpha.store(k, b.turning * b.acceleration);
        if (out.acceleration.origin) out.acceleration.store(k, b.shifting * b.acceleration);
    }

    ChainGroup const& group_;
    HostSpace space_, alone_;
    Communicator const& communicator_;
    HostSpace::Model model_;
    Leaf leaf_;
    Levels levels_;
    ConfigurationView configuration_;
    std::vector<Body> body_;
    bool measured_ = false;
    SolverReport report_;
};

}  // namespace

/// Returns the host solver of branched chains of rigid bodies.
std::unique_ptr<ChainSolver> make_body_tree_solver(ChainGroup const& group,
                                                   Executor const& executor,
                                                   Communicator const& communicator) {
    if (group.joints.has_screws)
        return std::make_unique<BodyTreeSolver<true>>(group, executor, communicator);
    return std::make_unique<BodyTreeSolver<false>>(group, executor, communicator);
}

}  // namespace catena::dca
