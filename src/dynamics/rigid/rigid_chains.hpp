// Operations of a step on one body of chains of rigid bodies in absolute coordinates, in any Space.
// Positions, velocities and forces are in ground axes (W), angular velocities and torques in body
// axes (B). Units: nm, ps, amu, kJ/mol, unless the scene has `units: si`.
#pragma once

#include <cmath>

#include "dca/solver.hpp"
#include "dynamics/body_loads.hpp"
#include "dynamics/constrained_step.hpp"
#include "dynamics/rigid/joint_rotors.hpp"
#include "joints/joint_models.hpp"
#include "kinematics/carried_beads.hpp"
#include "kinematics/link_geometry.hpp"
#include "kinematics/ring_ends.hpp"
#include "kinematics/rotor.hpp"
#include "math/philox.hpp"

namespace catena {

/// Parameters of one of the sweeps that close the joints at a drift's end.
struct DriftSweep {
    double time = 0;  // Duration of the drift.
    bool first = false, last = false;
};

/// Thermostat, and the streams of its noise for linear and angular velocities.
struct RigidNoise {
    Thermostat thermostat;
    std::uint64_t step = 0;
    NoiseStage linear = NoiseStage::start, angular = NoiseStage::start_angular;
    /// True in the middle of drifts. Elsewhere, at whole steps, rotors have half the variance
    /// (JointRotors::add_noise).
    bool between_drifts = false;
};

/// Rotation of body k relative to its joint frame, whose rotation in the inboard body is `frame`.
CATENA_HD Quat turn_of_joint(Quat const& inboard, Quat const& frame, Quat const& orientation) {
    return conjugate(inboard * frame) * orientation;
}

/// State and operations of bodies. Handle 1 of body k lies at x + R r1 and handle 2 at x + R r2,
/// with x the centre of mass and R the body's rotation matrix. Joints hold two handles together;
/// links keep them at the link's length. A point bead is a body without inertia that never rotates.
struct RigidChains {
    bool linked = false;
    double reach = 1;  // Length that openings of joints are divided by, nm.
    /// True for body k if it begins or ends its chain.
    std::uint8_t const *is_first = nullptr, *is_last = nullptr;
    JointType const* joint = nullptr;
    /// Index of each body in `tip` if it is a last body with a jointed tip, else -1. Null if the
    /// group has no tips.
    std::int32_t const* jointed_tip = nullptr;
    HeldTip const* tip = nullptr;
    RingEndsView ring_ends;
    LocalPiece const* piece = nullptr;
    std::int64_t pieces = 0;
    ConstView<1> mass, inverse_mass, length;
    ConstView<6> inertia;
    ConstView<3> r1, r2;
    ConstView<4> joint_frame;  // Quaternion of J in the inboard body (ChainGroup::joint_rotation).
    ConstView<4> principal_axes;  // Quaternion of P in B.
    /// Principal moments of inertia; 0 for a bead.
    ConstView<3> principal_moment;
    BodyLoadsView given;
    JointRotors rotors;
    CarriedBeadsView beads;
    View<3> position, velocity, omega;
    View<4> orientation;
    View<3> observed_velocity, observed_omega, force, torque;
    /// Linear (W) and angular momenta (B). For accelerations, `moment` is the torque less the
    /// gyroscopic torque.
    View<3> momentum, moment;
    /// Accelerations, or a sweep's corrections of velocities.
    View<3> acceleration, alpha;
    /// Handles 1 and 2 of bodies, W: their positions, or their velocities during an evaluation.
    View<3> inboard_end, outboard_end;
    View<3> joint_torque;  // Torque of joint k on body k, W.
    /// Unit directions of links, W.
    View<3> direction, tip_direction;
    /// Biases of inboard joints and tips; for a link, component 0 along its direction. The other
    /// directions of full handles stay 0.
    DirectionsView bias, tip_bias;

    /// Rotation matrix of B in W.
    CATENA_HD Mat3 axes(std::int64_t k) const {
        return to_matrix(as_quaternion(orientation.load(k)));
    }
    /// True if body k is a point bead.
    CATENA_HD bool is_bead(std::int64_t k) const { return principal_moment.at(k, 0) == 0; }
    /// True if body k has an inboard joint or link.
    CATENA_HD bool is_joined(std::int64_t k) const { return !floats(joint[k]); }
    /// Attachment of the tip of body k; null if body k is not a last body or its tip is free.
    CATENA_HD HeldTip const* tip_of(std::int64_t k) const {
        return jointed_tip && jointed_tip[k] >= 0 ? tip + jointed_tip[k] : nullptr;
    }
    CATENA_HD LocalPiece const& piece_of(std::int64_t k) const {
        return catena::piece_of(piece, pieces, k);
    }

    // Geometry of joints and links.

    /// Sets the positions of both handles of body k at the given pose.
    CATENA_HD void set_ends(std::int64_t k, Vec3 const& centre, Mat3 const& rotation) const {
        inboard_end.store(k, centre + rotation * r1.load(k));
        outboard_end.store(k, centre + rotation * r2.load(k));
    }
    CATENA_HD void set_ends(std::int64_t k) const { set_ends(k, position.load(k), axes(k)); }
    /// Handle 1 of body k from handle 2 of its inboard neighbour, or from its anchor on the ground.
    CATENA_HD Vec3 apart(std::int64_t k) const {
        return inboard_end.load(k) - (is_first[k] ? piece_of(k).anchor : outboard_end.load(k - 1));
    }
    /// The attachment of a tip from handle 2 of its last body. `at_ground` is used if the tip is
    /// attached to the ground.
    CATENA_HD Vec3 apart(HeldTip const& t, Vec3 const& at_ground) const {
        return (t.ring < 0 ? at_ground : ring_ends.first.load(t.ring)) - outboard_end.load(t.body);
    }
    CATENA_HD Vec3 apart(HeldTip const& t) const { return apart(t, t.anchor); }
    /// Direction and length of a link; both are zero for a joint.
    struct Link {
        Vec3 direction;
        double length;
    };
    CATENA_HD Link link(std::int64_t k) const {
        return linked ? Link{direction.load(k), length.at(k, 0)} : Link{Vec3::zero(), 0};
    }
    CATENA_HD Link link(HeldTip const& t) const {
        return {linked ? tip_direction.load(t.body) : Vec3::zero(), t.length};
    }

    /// Sets the directions of the links of body k: inboard, and of its tip.
    CATENA_HD void set_directions(std::int64_t k) const {
        Vec3 const d = is_joined(k) ? apart(k) : Vec3::zero();
        direction.store(k, is_joined(k) ? (1.0 / norm(d)) * d : d);
        HeldTip const* const t = tip_of(k);
        if (!t) return;
        Vec3 const at_tip = apart(*t);
        tip_direction.store(k, (1.0 / norm(at_tip)) * at_tip);
    }
    /// Sets the direction of the link that closes a ring, as the inboard direction of the ring's
    /// first body.
    CATENA_HD void set_first_direction(LocalRing const& ring, std::int64_t i) const {
        if (ring.first < 0) return;
        Vec3 const d = ring_ends.first.load(i) - ring_ends.last.load(i);
        direction.store(ring.first, (1.0 / norm(d)) * d);
    }
    /// Relative error of a link or joint with opening d.
    CATENA_HD double error_of(Vec3 const& d, double l) const {
        return linked ? std::fabs(norm(d) - l) / l : norm(d) / reach;
    }
    /// Constraint error of the inboard joint of body k and of its tip; the larger one.
    CATENA_HD double error(std::int64_t k) const {
        double const own = is_joined(k) ? error_of(apart(k), linked ? length.at(k, 0) : 0.0) : 0.0;
        HeldTip const* const t = tip_of(k);
        double const at_tip = t ? error_of(apart(*t), t->length) : 0.0;
        return at_tip > own || at_tip != at_tip ? at_tip : own;
    }
    /// Stores the bias of a joint along its directions.
    CATENA_HD void set_bias(DirectionsView const& out, std::int64_t k, Vec3 const& value) const {
        if (linked)
            out.at(k, 0) = value[0];
        else
            out.store<3>(k, value);
    }
    /// Opening of a joint, or length error of a link as component 0.
    CATENA_HD Vec3 opening(Vec3 const& d, Link const& l) const {
        return linked ? Vec3{{excess(d, l.length, 0.5 / l.length), 0, 0}} : d;
    }
    /// Sets the biases for a drift's sweep, after a flight has set the handles: `scale` times the
    /// openings of joints.
    CATENA_HD void set_openings(std::int64_t k, double scale) const {
        set_bias(bias, k, is_joined(k) ? scale * opening(apart(k), link(k)) : Vec3::zero());
        rotors.set_opening(bias, k, scale);
        if (HeldTip const* const t = tip_of(k))
            set_bias(tip_bias, k, scale * opening(apart(*t), link(*t)));
    }
    /// Velocity bias of a joint for accelerations, without the bodies' centripetal terms, which the
    /// solver adds. It is nonzero for links only.
    CATENA_HD Vec3 turning(Vec3 const& v, Link const& l) const {
        return linked ? Vec3{{velocity_bias(v, l.direction, l.length), 0, 0}} : Vec3::zero();
    }
    /// Sets the velocity biases of body k's joints. Precondition for links: handles hold
    /// velocities.
    CATENA_HD void set_turnings(std::int64_t k) const {
        Vec3 const before = is_first[k] || !linked ? Vec3::zero() : outboard_end.load(k - 1);
        set_bias(bias, k,
                 is_joined(k) ? turning(inboard_end.load(k) - before, link(k)) : Vec3::zero());
        if (HeldTip const* const t = tip_of(k))
            set_bias(tip_bias, k, turning(apart(*t, Vec3::zero()), link(*t)));
    }

    // Forces and torques on bodies.

    /// Sets the torque of joint k, including its spring; that of an implicit joint is applied to
    /// its rotor. Precondition: given.joint_loads.
    CATENA_HD void set_joint_torque(std::int64_t k) const {
        Vec3 torque_on_body = Vec3::zero();
        if (is_ball(joint[k])) {
            torque_on_body = given.torque.load(k);
            if (given.springs) {
                Quat const inboard =
                    is_first[k] ? Quat::identity() : as_quaternion(orientation.load(k - 1));
                Quat const rotation = turn_of_joint(inboard, as_quaternion(joint_frame.load(k)),
                                                    as_quaternion(orientation.load(k)));
                torque_on_body = torque_on_body + spherical_spring_torque(
                                                      given.stiffness.load(k),
                                                      as_quaternion(given.rest.load(k)), rotation);
            }
        }
        if (rotors.has(k)) {
            rotors.torque.store(k, torque_on_body);
            torque_on_body = Vec3::zero();
        }
        joint_torque.store(k, axes(k) * torque_on_body);
    }
    /// Sets the force and the torque on body k from gravity, wrenches and joint torques; clears the
    /// forces on its beads.
    CATENA_HD void set_forces(std::int64_t k) const {
        Vec3 f = mass.at(k, 0) * given.gravity, t = Vec3::zero();  // t is in W.
        if (given.wrenches) {
            f = f + given.wrench_force.load(k);
            t = given.wrench_torque.load(k);
        }
        if (given.joint_loads) {
            t = t + joint_torque.load(k);
            if (!is_last[k]) t = t - joint_torque.load(k + 1);
        }
        force.store(k, f);
        torque.store(k, transposed_times(axes(k), t));
        if (beads) beads.clear_forces(k);
    }
    /// Updates and returns the position of carried bead i, W.
    CATENA_HD Vec3 put_bead(std::int64_t i) const {
        return beads.put_bead(i, position.load(beads.body[i]), axes(beads.body[i]));
    }
    /// Adds OpenMM's force on carried bead i, from its arrays on the GPU.
    CATENA_HD void add_bead_force(std::int64_t i, DeviceParticles const& particles) const {
        beads.force.store(i, beads.force.load(i) + particles.force_on(i));
    }
    /// Adds the wrench of the beads on body k to its force and torque.
    CATENA_HD void take_bead_forces(std::int64_t k) const {
        Mat3 const rotation = axes(k);
        Wrench const w = beads.on_body(k, rotation);
        force.store(k, force.load(k) + w.force);
        torque.store(k, torque.load(k) + transposed_times(rotation, w.torque));
    }

    // Parts of a step.

    /// Computes the momenta after a kick of duration h, the right-hand side of a projection.
    CATENA_HD void set_momenta(std::int64_t k, double h) const {
        momentum.store(k, plus_scaled(mass.at(k, 0) * velocity.load(k), h, force.load(k)));
        moment.store(k,
                     plus_scaled(as_symmetric(inertia.load(k)) * omega.load(k), h, torque.load(k)));
        if (rotors.implicit) rotors.set_kick(bias, k, h);
    }
    /// Free flight from the drift's start, with the corrections of the previous sweep added to the
    /// velocities there. The last sweep stores the new pose.
    CATENA_HD void fly(std::int64_t k, DriftSweep const& sweep) const {
        Vec3 v = velocity.load(k);
        RotorState turning{as_quaternion(orientation.load(k)), omega.load(k)};
        if (!sweep.first) {
            v = v + acceleration.load(k);
            turning.omega = turning.omega + alpha.load(k);
            velocity.store(k, v);
            if (!sweep.last) omega.store(k, turning.omega);
        }
        Vec3 const x = plus_scaled(position.load(k), sweep.time, v);
        if (!is_bead(k))
            turning = free_rotor({as_quaternion(principal_axes.load(k)), principal_moment.load(k)},
                                 turning, sweep.time);
        if (!sweep.last) {
            if (rotors.implicit) rotors.flown.store(k, as_vector(turning.orientation));
            return set_ends(k, x, to_matrix(turning.orientation));
        }
        position.store(k, x);
        orientation.store(k, as_vector(turning.orientation));
        omega.store(k, turning.omega);
    }
    /// Mixes the velocities of body k with the thermostat's noise.
    CATENA_HD void add_noise(std::int64_t k, RigidNoise const& n) const {
        std::uint64_t const body = piece_of(k).body_of(k);
        Thermostat const& t = n.thermostat;
        Vec3 const noise = normal3(t.seed, n.step, body, n.linear);
        velocity.store(k, plus_scaled(t.keep * velocity.load(k),
                                      t.spread * std::sqrt(inverse_mass.at(k, 0)), noise));
        rotors.add_noise(k, t, n.step, body, n.between_drifts);
        if (is_bead(k)) return;
        Vec3 const moments = principal_moment.load(k);
        Vec3 turning = normal3(t.seed, n.step, body, n.angular);
        for (int i = 0; i < 3; ++i) turning[i] *= t.spread / std::sqrt(moments[i]);
        omega.store(
            k, t.keep * omega.load(k) + to_matrix(as_quaternion(principal_axes.load(k))) * turning);
    }

    // Evaluation of accelerations at the last observed velocities.

    /// Observed velocity of the point of body k at r (B) from its centre, W.
    CATENA_HD Vec3 velocity_of(std::int64_t k, Vec3 const& r) const {
        return observed_velocity.load(k) + axes(k) * cross(observed_omega.load(k), r);
    }
    /// Sets the torque less the gyroscopic torque of body k; on links, also the velocities of its
    /// handles.
    CATENA_HD void set_moment(std::int64_t k) const {
        Vec3 const w = observed_omega.load(k);
        moment.store(k, torque.load(k) - cross(w, as_symmetric(inertia.load(k)) * w));
        if (!linked) return;
        inboard_end.store(k, velocity_of(k, r1.load(k)));
        outboard_end.store(k, velocity_of(k, r2.load(k)));
    }
};

}  // namespace catena
