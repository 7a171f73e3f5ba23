// The bodies of a group in joint coordinates in any Space: state, motion, loads and solution, with
// the loops that compute one from another.
#pragma once

#include "dca/host_space.hpp"
#include "dynamics/joint/closed_loops.hpp"
#include "dynamics/joint/joint_lanes.hpp"
#include "dynamics/joint/joint_loads_in.hpp"
#include "dynamics/joint/joint_motion_in.hpp"
#include "dynamics/joint/joint_solution_in.hpp"
#include "dynamics/joint/joint_state_in.hpp"
#include "dynamics/joint/jointed_tips_in.hpp"
#include "dynamics/joint/revolute_scan.hpp"

namespace catena {

/// Constant properties of a group's bodies. Everything in it must outlive them.
struct JointGroup {
    ChainGroup const& group;
    Scene const& scene;
    Communicator const& communicator;
    ChainSolver& solver;
    BodyLoads const& given;
    double reach;  // Characteristic length (reach_of()), nm.
    JointClock& clock;
    double implicit_step;
};

/// Arrays of the bodies and the loops over them. On hosts with SIMD, bodies and runs are processed
/// side by side in vector lanes (JointLanes). Members are public because nvcc accepts device
/// lambdas in public members only.
template <class Space>
class JointBodies {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;

  public:
    static constexpr bool has_lanes = requires(Space const& space) { space.simd(); };

    JointBodies(JointGroup const& g, Space const& of_bodies)
        : group(g.group),
          space(of_bodies),
          communicator(g.communicator),
          solver(g.solver),
          state(group, g.clock),
          motion(group, space, communicator, g.given),
          tips(group, g.scene, space, communicator, g.reach),
          closed_loops(group, g.reach),
          loads(group, g.given, space, solver.eliminates_revolute_joints(),
                rotor_of_spring(g.scene.dynamics.integrator), g.implicit_step),
          solution(group, solver.eliminates_revolute_joints()),
          zero(group.has_closures() ? group.size : 0),
          pieces_(local_pieces(group, g.scene)),
          pieces(pieces_) {
        if constexpr (has_lanes)
            if (JointLanes placed(group, g.given.springs,
                                  loads.eliminated && solver.has_runs_side_by_side(), space.simd());
                placed.any() && !group.is_branched())
                lanes = std::move(placed);
    }

    // Views.

    /// Views of all arrays for loops over bodies.
    JointChains chains() {
        JointChains c;
        c.moved.scan = motion.scan(state.now.view());
        if (loads.implicit) c.implicit = loads.implicit.view(state.start.view().qd);
        c.moved.time = state.clock.now;
        c.directions = group.directions;
        loads.show(c, motion.kinematics().joints());
        c.alpha = solution.alpha.view();
        c.acceleration = solution.acceleration.view();
        c.outboard_end = solution.outboard_end.view();
        c.left = {loads.leaves_torques(), loads.leaves_loads(),
                  loads.leaves_motions() && !joint_by_joint()};
        if (solution.found == Found::revolutes)
            c.revolute_acceleration = solution.revolute_acceleration.view();
        return c;
    }
    JointSteps steps() {
        return {chains(), state.start.view(), state.sum.view(), state.saved.view()};
    }
    /// Views for steps of an embedded pair. Precondition: JointStateIn::pair.
    EmbeddedSteps embedded() {
        return {steps(), state.pair->kept.view(), state.pair->kept_base.view()};
    }
    /// Views with zero velocities and gravity, so that rates contain the last solution only.
    JointSteps at_rest() {
        JointSteps still = steps();
        still.chains.moved.scan.state.qd = zero.view();
        still.chains.moved.scan.motion.omega = zero.view();
        still.chains.given.gravity = Vec3::zero();
        return still;
    }
    JointedTips jointed_tips() { return tips.view(motion.view()); }
    /// Configuration for the solver.
    ConfigurationView configuration() {
        MotionView const m = motion.view();
        ConfigurationView all{
            {},   m.joint_turn, {},
            m.r2, m.axes2,      loads.implicit ? loads.implicit.compliance().view() : View<6>{}};
        all.loop_ends = closed_loops.ends().data();
        return all;
    }
    /// Loads for the solver; views without origin are left to it.
    LoadsView given_to_solver() {
        MotionView const m = motion.view();
        LoadsView all{loads.torque.view(), loads.has_forces ? loads.force.view() : View<3>{},
                      m.omega, loads.bias.view(), of_tips(group, tips.bias())};
        all.loop_bias = closed_loops.bias().data();
        if (!loads.leaves_loads()) return all;
        if (loads.leaves_torques()) all.torque = {};
        all.gyroscopic = loads.leaves_torques();
        View<3> const qd = state.now.qd.view();
        all.revolute_rate = {qd.origin, qd.pitch, qd.size};
        if (loads.leaves_motions())
            all.revolutes = loads.of_revolutes(motion.kinematics().rotations(), m.orientation);
        return all;
    }

    // Loops.

    /// Calls one(k) for every body. Bodies that are side by side in vector lanes are passed to
    /// some(loops, first bodies, range) instead.
    template <bool positions, class Some, class One>
    void each_body(Some const& some, One const& one) const {
        if constexpr (has_lanes)
            if (lanes) return lanes->each(space, positions, some, one);
        space.for_each(group.size, one);
    }
    /// Calls with(std::true_type) if loads depend on the positions of bodies, and
    /// with(std::false_type) otherwise.
    template <class With>
    void with_positions(With const& with) const {
        motion.needs_positions() ? with(std::true_type{}) : with(std::false_type{});
    }
    /// Computes the loads of all bodies from the current motion.
    void set_loads() {
        space.for_each(group.size,
                       [c = chains()] CATENA_LAMBDA(std::int64_t k) { c.set_loads(k); });
    }
    /// Computes the joints' relative motions.
    void set_relative() {
        space.for_each(group.size, [c = chains()] CATENA_LAMBDA(std::int64_t k) {
            c.template set_relative<false>(k);
        });
    }
    /// Computes the second derivatives of coordinates from the last solution.
    void set_rates(RatesView const& out) {
        JointChains const c = chains();
        each_body<false>(
            [&](JointLoops const& loops, auto... bodies) { loops.set_rates(c, out, bodies...); },
            [c, out] CATENA_LAMBDA(std::int64_t k) { c.set_rates(k, out); });
    }
    /// Forces of a thermostat's noise. Allocates the arrays that only thermostats need.
    FieldOf<3>& force_of_noise() {
        if (force_of_noise_.size() != group.size) force_of_noise_ = FieldOf<3>(group.size);
        if (zero.size() != group.size) zero = FieldOf<3>(group.size);
        return force_of_noise_;
    }
    /// Sends the acceleration of the last body's outboard end to the outboard neighbour.
    void exchange_ends() { exchange_ends(chains()); }
    void exchange_ends(JointChains const& c) {
        View<4> const end = c.outboard_end;
        space.exchange(
            communicator,
            BodyExchange<4>{end, 0, group.neighbours.outboard, end, -1, group.neighbours.inboard},
            [c, last = group.size - 1] CATENA_LAMBDA(std::int64_t) {
                c.outboard_end.store(0, c.outboard_end_of(last));
            });
    }

    /// True if joints' relative motions, which the preceding step may leave undone, are computed in
    /// a loop before those of runs.
    bool joint_by_joint() const {
        return space.has_threads_to_spare(std::ssize(group.schedule.runs));
    }
    ChainGroup const& group;
    Space space;
    Communicator const& communicator;
    ChainSolver& solver;
    JointStateIn<Space> state;
    JointMotionIn<Space> motion;
    JointedTipsIn<Space> tips;
    ClosedLoops closed_loops;  // On the host; no chains with loops are elsewhere.
    JointLoadsIn<Space> loads;
    JointSolutionIn<Space> solution;
    std::optional<JointLanes> lanes;
    /// Velocities of at_rest(); allocated if there are jointed tips, loops or noise.
    FieldOf<3> zero;

  private:
    FieldOf<3> force_of_noise_;
    std::vector<LocalPiece> pieces_;  // On the host a List is a view.

  public:
    /// The parts of chains on this rank.
    typename Space::template List<LocalPiece> pieces;
};

}  // namespace catena
