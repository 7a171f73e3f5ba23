// The operators of a step of rigid bodies in absolute coordinates, in any Space: configuration,
// forces, kick, drift and noise.
#pragma once

#include "dynamics/closing.hpp"
#include "dynamics/rigid/rigid_bodies.hpp"

namespace catena::rigid_bodies {

/// AbsoluteDynamics::update_configuration().
template <class Space>
void update_configuration(RigidBodies<Space>& bodies) {
    Space const& space = bodies.space;
    ChainGroup const& group = bodies.group;
    if (bodies.loads.read_inboard_bodies())
        exchange_from_inboard(bodies.communicator, group, bodies.state.orientation.view(), space);
    if (bodies.rotors)
        space.for_each(group.size, [j = bodies.joints()] CATENA_LAMBDA(std::int64_t k) {
            j.rotors.set_compliance(k);
        });
    if (!group.linked) return;
    bodies.set_ends();
    space.for_each(group.size,
                   [j = bodies.joints()] CATENA_LAMBDA(std::int64_t k) { j.set_directions(k); });
    space.for_each(std::ssize(group.ends.rings),
                   [j = bodies.joints(), ring = bodies.handles.rings.data()] CATENA_LAMBDA(
                       std::int64_t i) { j.set_first_direction(ring[i], i); });
    exchange_from_outboard(bodies.communicator, group, bodies.handles.direction.view(), space);
}
/// AbsoluteDynamics::set_simple_forces().
template <class Space>
void set_simple_forces(RigidBodies<Space>& bodies) {
    RigidLoads const f = bodies.forces();
    if (bodies.loads.given.joint_loads) {
        bodies.space.for_each(bodies.group.size,
                              [f] CATENA_LAMBDA(std::int64_t k) { f.set_joint_torque(k); });
        exchange_from_outboard(bodies.communicator, bodies.group, bodies.loads.joint_torque.view(),
                               bodies.space);
    }
    bodies.space.for_each(bodies.group.size,
                          [f] CATENA_LAMBDA(std::int64_t k) { f.set_forces(k); });
}
/// BeadHost::take_bead_forces().
template <class Space>
void take_bead_forces(RigidBodies<Space>& bodies) {
    bodies.loads.beads.take_bead_forces();
    if (bodies.loads.beads.any())
        bodies.space.for_each(bodies.group.size, [f = bodies.forces()] CATENA_LAMBDA(
                                                     std::int64_t k) { f.take_bead_forces(k); });
}

/// Constraint projection P (v + h M^-1 f): with momenta instead of forces, the solver returns
/// velocities instead of accelerations.
template <class Space>
void project(RigidBodies<Space>& bodies, double h, View<3> velocity, View<3> omega) {
    bodies.space.for_each(bodies.group.size, [s = bodies.steps(), h] CATENA_LAMBDA(std::int64_t k) {
        s.set_momenta(k, h);
    });
    bodies.solver.solve({bodies.sweep.moment.view(),
                         bodies.sweep.momentum.view(),
                         {},
                         bodies.rotors ? bodies.sweep.bias.view() : DirectionsView{},
                         {}},
                        {omega, velocity, {}, {}});
}
/// AbsoluteDynamics::kick().
template <class Space>
void kick(RigidBodies<Space>& bodies, double h) {
    View<3> const omega = bodies.state.omega.view();
    project(bodies, h, bodies.state.velocity.view(), omega);
    if (bodies.rotors) bodies.take_rotors(omega);
}

/// Free flight of all bodies from the drift's start. Unless it is the last one, the new handles are
/// exchanged with neighbours.
template <class Space>
void fly(RigidBodies<Space>& bodies, DriftSweep const& sweep) {
    bodies.space.for_each(bodies.group.size, [s = bodies.steps(), sweep] CATENA_LAMBDA(
                                                 std::int64_t k) { s.fly(k, sweep); });
    if (!sweep.last) bodies.show_ends();
}
/// Adds a sweep's corrections to the rotors' rates.
template <class Space>
void add_to_rotors(RigidBodies<Space>& bodies) {
    exchange_from_inboard(bodies.communicator, bodies.group, bodies.sweep.alpha.view(),
                          bodies.space);
    bodies.space.for_each(bodies.group.size, [s = bodies.steps()] CATENA_LAMBDA(std::int64_t k) {
        s.joints.rotors.add(s.joints.bias, k, s.alpha);
    });
}
/// Finds the corrections of velocities at the drift's start that close the joints at the end of the
/// last fly().
template <class Space>
void correct(RigidBodies<Space>& bodies, double h) {
    bodies.space.for_each(bodies.group.size, [j = bodies.joints(), scale = 1.0 / h] CATENA_LAMBDA(
                                                 std::int64_t k) { j.set_openings(k, scale); });
    RigidSweepIn<Space>& sweep = bodies.sweep;
    bodies.solver.solve({{}, {}, {}, sweep.bias.view(), of_tips(bodies.group, sweep.tip_bias)},
                        {sweep.alpha.view(), sweep.acceleration.view(), {}, {}});
    if (bodies.rotors) add_to_rotors(bodies);
}
/// Clears the corrections that the velocities already include.
template <class Space>
void forget_correction(RigidBodies<Space>& bodies) {
    bodies.space.for_each(bodies.group.size,
                          [a = bodies.sweep.acceleration.view(),
                           t = bodies.sweep.alpha.view()] CATENA_LAMBDA(std::int64_t k) {
                              a.store(k, Vec3::zero());
                              t.store(k, Vec3::zero());
                          });
}
/// AbsoluteDynamics::drift(), with the constraint impulses in the momenta at its start, as RATTLE
/// requires. The free rotor runs again in every sweep (src/dca/README.md, "Rigid bodies under
/// RATTLE").
template <class Space>
void drift(RigidBodies<Space>& bodies, double h, int sweeps) {
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        fly(bodies, {h, sweep == 0, false});
        correct(bodies, h);
    }
    fly(bodies, {h, sweeps == 0, true});
}
/// ClosingDrifts::drift_closing().
template <class Space>
int drift_closing(RigidBodies<Space>& bodies, double h, int sweeps, Closing const& closing) {
    fly(bodies, {h, true, false});
    auto const sweep = [&] {
        correct(bodies, h);
        fly(bodies, {h, false, false});
    };
    for (int i = 0; i < sweeps; ++i) sweep();
    int const more = closing.close(
        sweeps, [&] { return bodies.communicator.max(bodies.error_at_ends()); }, sweep);
    forget_correction(bodies);
    fly(bodies, {h, false, true});
    return more;
}

/// Mixes the velocities of bodies [first, first + count) with noise.
template <class Space>
void add_noise(RigidBodies<Space>& bodies, RigidNoise const& noise, std::int64_t first,
               std::int64_t count) {
    bodies.space.for_each(count, [s = bodies.steps(), noise, first] CATENA_LAMBDA(std::int64_t i) {
        s.add_noise(first + i, noise);
    });
}
/// AbsoluteDynamics::draw_velocities().
template <class Space>
void draw_velocities(RigidBodies<Space>& bodies, double kt, std::uint64_t seed,
                     std::vector<bool> const& of_chain) {
    for (dca::Piece const& piece : bodies.group.pieces)
        if (of_chain[piece.chain])
            add_noise(bodies, {{0.0, std::sqrt(kt), seed}}, piece.local, piece.count);
    kick(bodies, 0.0);
}

}  // namespace catena::rigid_bodies
