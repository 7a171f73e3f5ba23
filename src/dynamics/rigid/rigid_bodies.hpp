// The bodies of a group of rigid chains in absolute coordinates, in any Space: constants, state,
// loads and the solver's arrays, with the loops that all parts of a step use. Positions, velocities
// and forces are in ground axes (W), angular velocities and torques in body axes (B). Units: nm,
// ps, amu, kJ/mol, unless the scene has `units: si`.
#pragma once

#include "dynamics/rigid/rigid_loads.hpp"
#include "dynamics/rigid/rigid_steps.hpp"

namespace catena {

/// Arrays that the solver reads and writes in a bias sweep (RigidSteps, RigidJoints).
template <class Space>
struct RigidSweepIn {
    explicit RigidSweepIn(ChainGroup const& group)
        : RigidSweepIn(group.size, group.ends.has_tips() ? group.size : 0, group.directions) {}

    typename Space::template FieldOf<3> momentum, moment, acceleration, alpha;
    typename Space::Directions bias, joint_force, tip_bias, tip_force;

  private:
    RigidSweepIn(std::int64_t size, std::int64_t tips, int directions)
        : momentum(size),
          moment(size),
          acceleration(size),
          alpha(size),
          bias(size + 1, directions),
          joint_force(size + 1, directions),
          tip_bias(tips, directions),
          tip_force(tips, directions) {}
};

/// Arrays of the bodies, and the loops over them. Members are public because nvcc accepts device
/// lambdas in public members only.
template <class Space>
class RigidBodies {
  public:
    /// `implicit_step` is the step length of implicit joint springs; 0 if there are none.
    /// Everything given but the scene must outlive this object. Collective.
    RigidBodies(ChainGroup const& of_bodies, Scene const& scene, Space const& where,
                Communicator const& ranks, ChainSolver& of_group, double implicit_step)
        : group(of_bodies),
          space(where),
          communicator(ranks),
          solver(of_group),
          model(group, scene, communicator),
          loads(group, scene, space),
          rotors(group, rotor_of_spring(scene.dynamics.integrator) * implicit_step * implicit_step),
          state(group),
          observed(group),
          sweep(group),
          tips(group, start(scene)),
          handles(group, space, communicator) {
        if (!rotors) return;
        exchange_from_inboard(communicator, group, state.orientation.view(), space);
        take_rotors(state.omega.view());
    }

    // Views for loops over bodies.

    RigidJoints joints() {
        return {model.view(),   tips.view(),       state.view(),         view_of_rotors(),
                handles.view(), sweep.bias.view(), sweep.tip_bias.view()};
    }
    RigidLoads forces() {
        return {
            model.view(),       state.view(),       view_of_rotors(),    loads.in_space.view(),
            loads.beads.view(), loads.force.view(), loads.torque.view(), loads.joint_torque.view()};
    }
    RigidSteps steps() {
        return {joints(),
                loads.force.view(),
                loads.torque.view(),
                observed.velocity.view(),
                observed.omega.view(),
                sweep.momentum.view(),
                sweep.moment.view(),
                sweep.acceleration.view(),
                sweep.alpha.view()};
    }
    /// Configuration for the solver.
    ConfigurationView configuration() {
        if (!group.linked)
            return {{}, state.orientation.view(),
                    {}, {},
                    {}, rotors ? rotors.compliance() : ConstView<6>{}};
        return {handles.direction.view(),
                state.orientation.view(),
                group.ends.has_tips() ? ConstView<3>(handles.tip_direction.view()) : ConstView<3>{},
                {},
                {}};
    }

    // Loops.

    /// Computes all handles at the current poses and exchanges them.
    void set_ends() {
        space.for_each(group.size, [j = joints()] CATENA_LAMBDA(std::int64_t k) { j.set_ends(k); });
        show_ends();
    }
    /// Exchanges the handles that neighbours need, within and across ranks.
    void show_ends() {
        exchange_from_inboard(communicator, group, handles.outboard.view(), space);
        if (rotors) exchange_from_inboard(communicator, group, rotors.flown(), space);
        handles.of_rings.take(handles.inboard.view(), handles.outboard.view());
    }
    /// Largest constraint error on this rank at the handles of the last flight or set_ends().
    double error_at_ends() {
        return space.largest(group.size, [j = joints()] CATENA_LAMBDA(std::int64_t k) -> double {
            return j.error(k);
        });
    }
    /// Sets the rotors' rates to those of their joints.
    void take_rotors(View<3> omega) {
        exchange_from_inboard(communicator, group, omega, space);
        space.for_each(group.size, [r = view_of_rotors(), omega] CATENA_LAMBDA(std::int64_t k) {
            r.take(k, omega);
        });
    }
    /// Updates the positions of carried beads.
    void put_beads() {
        space.for_each(group.carried.count(),
                       [f = forces()] CATENA_LAMBDA(std::int64_t i) { f.put_bead(i); });
    }

    ChainGroup const& group;
    Space space;
    Communicator const& communicator;
    ChainSolver& solver;
    RigidModelIn<Space> model;
    RigidLoadsIn<Space> loads;
    JointRotorsIn<Space> rotors;
    RigidStateIn<Space> state;
    ObservedBodiesIn<Space> observed;
    RigidSweepIn<Space> sweep;
    HeldTipsIn<Space> tips;
    HandlesIn<Space> handles;

  private:
    JointRotors view_of_rotors() {
        if (!rotors) return {};
        return rotors.view(model.view().is_first, loads.in_space.view().stiffness,
                           state.orientation.view());
    }
    /// Sets the state to the scene's start. Returns the attachments of tips there.
    std::vector<HeldTip> start(Scene const& scene) {
        RigidStart const at = place_bodies(group, scene, communicator);
        state.set(space, at);
        return held_tips(group, [&](std::int64_t k) {
            return at.position[k] +
                   to_matrix(as_quaternion(at.orientation[k])) * group.bodies.r2[k];
        });
    }
};

}  // namespace catena
