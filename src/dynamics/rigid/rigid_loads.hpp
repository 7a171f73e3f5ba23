// Forces and torques on rigid bodies in absolute coordinates, in any Space. Ground axes are W, body
// axes are B.
#pragma once

#include "dynamics/body_loads.hpp"
#include "dynamics/rigid/joint_rotors.hpp"
#include "dynamics/rigid/rigid_model.hpp"
#include "kinematics/carried_beads.hpp"

namespace catena {

/// Rotation of body k relative to its joint frame, whose rotation in the inboard body is `frame`.
CATENA_HD Quat turn_of_joint(Quat const& inboard, Quat const& frame, Quat const& orientation) {
    return conjugate(inboard * frame) * orientation;
}

/// Given loads and resulting loads of bodies, with the operations on one body.
struct RigidLoads {
    RigidModel model;
    RigidState state;
    JointRotors rotors;
    BodyLoadsView given;
    CarriedBeadsView beads;
    View<3> force;         // W.
    View<3> torque;        // B.
    View<3> joint_torque;  // Torque of joint k on body k, W.

    /// Sets the torque of joint k, including its spring; that of an implicit joint is applied to
    /// its rotor. Precondition: given.joint_loads.
    CATENA_HD void set_joint_torque(std::int64_t k) const {
        Vec3 torque_on_body = Vec3::zero();
        if (is_ball(model.joint[k])) {
            torque_on_body = given.torque.load(k);
            if (given.springs) {
                Quat const inboard = model.is_first[k]
                                         ? Quat::identity()
                                         : as_quaternion(state.orientation.load(k - 1));
                Quat const rotation =
                    turn_of_joint(inboard, as_quaternion(model.joint_frame.load(k)),
                                  as_quaternion(state.orientation.load(k)));
                torque_on_body = torque_on_body + spherical_spring_torque(
                                                      given.stiffness.load(k),
                                                      as_quaternion(given.rest.load(k)), rotation);
            }
        }
        if (rotors.has(k)) {
            rotors.torque.store(k, torque_on_body);
            torque_on_body = Vec3::zero();
        }
        joint_torque.store(k, state.axes(k) * torque_on_body);
    }
    /// Sets the force and the torque on body k from gravity, wrenches and joint torques; clears the
    /// forces on its beads.
    CATENA_HD void set_forces(std::int64_t k) const {
        Vec3 f = model.mass.at(k, 0) * given.gravity, t = Vec3::zero();  // t is in W.
        if (given.wrenches) {
            f = f + given.wrench_force.load(k);
            t = given.wrench_torque.load(k);
        }
        if (given.joint_loads) {
            t = t + joint_torque.load(k);
            if (!model.is_last[k]) t = t - joint_torque.load(k + 1);
        }
        force.store(k, f);
        torque.store(k, transposed_times(state.axes(k), t));
        if (beads) beads.clear_forces(k);
    }
    /// Updates and returns the position of carried bead i, W.
    CATENA_HD Vec3 put_bead(std::int64_t i) const {
        return beads.put_bead(i, state.position.load(beads.body[i]), state.axes(beads.body[i]));
    }
    /// Adds OpenMM's force on carried bead i, from its arrays on the GPU.
    CATENA_HD void add_bead_force(std::int64_t i, DeviceParticles const& particles) const {
        beads.force.store(i, beads.force.load(i) + particles.force_on(i));
    }
    /// Adds the wrench of the beads on body k to its force and torque.
    CATENA_HD void take_bead_forces(std::int64_t k) const {
        Mat3 const rotation = state.axes(k);
        Wrench const w = beads.on_body(k, rotation);
        force.store(k, force.load(k) + w.force);
        torque.store(k, torque.load(k) + transposed_times(rotation, w.torque));
    }
};

/// Given loads, and storage of the resulting loads.
template <class Space>
struct RigidLoadsIn {
    template <int D>
    using FieldOf = typename Space::template FieldOf<D>;

    /// The group must outlive this object.
    RigidLoadsIn(ChainGroup const& group, Scene const& scene, Space const& space)
        : given(make_body_loads(group, scene)),
          in_space(given),
          beads(group, space),
          force(group.size),
          torque(group.size),
          joint_torque(given.joint_loads ? group.size : 0) {}

    /// True if loads of a joint depend on the orientation of its inboard body.
    bool read_inboard_bodies() const { return given.springs; }

    BodyLoads given;
    BodyLoadsIn<Space> in_space;
    CarriedBeadsIn<Space> beads;
    FieldOf<3> force, torque, joint_torque;
};

}  // namespace catena
