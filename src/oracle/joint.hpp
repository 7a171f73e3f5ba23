// Bodies and their inboard joints, read from ChainSpec in the oracle's scalar. Internal to the
// oracles.
#pragma once

#include <array>
#include <string>

#include "oracle/algebra.hpp"
#include "oracle/oracle.hpp"

namespace catena::oracle {

/// Direction of a joint, or relative acceleration, of the outboard side relative to the inboard
/// one, at the body's origin.
template <class S>
struct Motion {
    V3<S> angular = V3<S>::zero(), linear = V3<S>::zero();
};
template <class S>
Motion<S> operator+(Motion<S> const& a, Motion<S> const& b) {
    return {a.angular + b.angular, a.linear + b.linear};
}
template <class S>
SpatialForce<S> operator+(SpatialForce<S> const& a, SpatialForce<S> const& b) {
    return {a.torque + b.torque, a.force + b.force};
}
/// Power of a wrench along a motion, both referred to the same point.
template <class S>
S power(Motion<S> const& m, SpatialForce<S> const& f) {
    return dot(m.angular, f.torque) + dot(m.linear, f.force);
}

/// Body k + 1 and its inboard joint.
template <class S>
struct Link {
    JointType type = JointType::free;
    /// Index of the inboard body; -1 for the ground.
    std::ptrdiff_t inboard = -1;
    /// True for prescribed motion.
    bool driven = false;
    /// Maps components in B to components in the inboard body's axes (free: W).
    M3<S> rotation;
    /// Vector from the inboard body's origin to this one's, in the inboard body's axes (free: W).
    /// It includes the joint's displacement.
    V3<S> translation;
    /// Directions of the coordinates, B. A free joint lists those of its rotation.
    std::array<Motion<S>, 3> free;
    int dof = 0;  // number of directions in `free`
    /// Angular velocity, and velocity of the origin, relative to the inboard body, B (free: slide
    /// in W).
    V3<S> rate, slide;
    /// Relative angular acceleration due to the joint rates, except inboard omega x rate, B
    /// (universal).
    V3<S> drift = V3<S>::zero();
    V3<S> prescribed = V3<S>::zero();  // prescribed motion: q''
    Motion<S> gap;                     // error of the closure, Loads::gaps, B
    V3<S> effort = V3<S>::zero();  // along the coordinates: given torque or force, springs, dampers
    /// Energy of the joint's springs.
    S spring_energy = S(0);
    S mass;
    V3<S> com;      // relative to the origin, B
    M3<S> inertia;  // about com, B
    /// Load at com without gravity, W: external wrench, forces on beads, and drag.
    V3<S> applied_torque, applied_force;

    /// Number of coordinates whose second derivatives follow from the forces.
    int unknown() const { return driven ? 0 : dof; }
    /// True if the joint joins the body to the ground.
    bool on_ground() const { return inboard < 0; }
    /// Index of the inboard body. Precondition: not on_ground().
    std::size_t before() const { return static_cast<std::size_t>(inboard); }
};
/// Geometry and coordinates of a joint in the oracle's scalar, as in BodyArrays and TipJoint.
template <class S>
struct JointShape {
    JointType type;
    V3<S> axis, first_axis;  // need not have unit length; planar3: nor be perpendicular
    S pitch;
    M3<S> rotation;
    V3<S> translation;
    std::array<S, 3> q;
    std::array<double, 4> quaternion;  // spherical and free joints
};
/// Sets type, rotation, translation and directions of `link`. Throws ComputationError with `where`
/// if the joint is a link.
template <class S>
void place(JointShape<S> const& shape, std::string const& where, Link<S>& link);
/// Sets the directions of `link` that are fixed in the joint frame from the link's rotation.
template <class S>
void set_inboard_directions(JointShape<S> const& shape, Link<S>& link);

/// Returns the sum of the joint's directions times their coordinates.
template <class S>
Motion<S> along(Link<S> const& link, V3<S> const& coordinates);
/// Returns the coordinates (P^T P)^-1 P^T m of a motion m, where P has the joint's directions as
/// columns.
template <class S>
V3<S> coordinates(Link<S> const& link, Motion<S> const& motion);
/// Returns the efforts P^T f of a wrench f along the joint's directions.
template <class S>
V3<S> efforts(Link<S> const& link, SpatialForce<S> const& wrench);
/// Returns the wrench P (P^T P)^-1 effort in the span of the joint's directions with the given
/// efforts, B.
template <class S>
SpatialForce<S> spread(Link<S> const& link, V3<S> const& effort);
/// Returns the directions that the joint constrains, B; all six for prescribed motion.
template <class S>
std::vector<Motion<S>> restricted(Link<S> const& link);

/// Reads all bodies of a chain. Throws ComputationError if a joint type is not allowed between
/// bodies.
template <class S>
std::vector<Link<S>> read_links(ChainSpec const& chain, Loads const& loads);

/// Position, orientation and velocity of a body.
template <class S>
struct Attitude {
    M3<S> orientation;       // maps B to W
    V3<S> omega;             // B
    V3<S> origin, velocity;  // body origin, W
};
/// Returns the attitude of every body by forward kinematics.
template <class S>
std::vector<Attitude<S>> attitudes(std::vector<Link<S>> const& links);

/// Joint that closes a loop, from a last body to the ground or to a first body. Its outboard side
/// is a frame G, fixed in the ground or in the first body. The last body of a loop may be the
/// ground.
template <class S>
struct TipClosure {
    /// True if there is a first body.
    bool ring = false;
    /// Index of the last body and, if there is one, of the first body; -1 for the ground.
    std::int64_t last_body = -1, first_body = -1;
    /// Vector from the first body's centre of mass to G's origin, W.
    V3<S> first_arm = V3<S>::zero();
    /// Vectors from the last body's centre of mass to the origins of G and of the joint frame, W.
    V3<S> arm, frame;
    /// Directions in which G cannot move relative to the last body, W.
    std::vector<Motion<S>> locked;
    /// Velocity-dependent acceleration of G relative to the coincident point of the last body, W.
    Motion<S> closure;
};
/// Reads the tip joint of a chain. Its rates are the least-squares fit of the bodies' velocities
/// along the joint's directions.
template <class S>
TipClosure<S> read_tip(ChainSpec const& chain, std::vector<Link<S>> const& links,
                       std::vector<Attitude<S>> const& attitude);
/// Reads the jointed tip of a chain, if it has one, and then the joints of its loops.
template <class S>
std::vector<TipClosure<S>> read_closures(ChainSpec const& chain, std::vector<Link<S>> const& links,
                                         std::vector<Attitude<S>> const& attitude);
/// Motion of a body at one end of the tip joint, W.
template <class S>
struct TipEnd {
    V3<S> com_acceleration, alpha, omega;
};
/// Returns the residual of the tip's closure under the bodies' accelerations, one entry per locked
/// direction. It is zero for a closed tip. `first` is used in a ring only.
template <class S>
std::vector<S> tip_defect(TipClosure<S> const& tip, TipEnd<S> const& last, TipEnd<S> const& first);
/// Returns the wrench on the last body for given components along the locked directions on G.
/// `about` is the reference point relative to the centre of mass: zero, or the joint frame.
template <class S>
SpatialForce<S> tip_wrench(TipClosure<S> const& tip, std::vector<S> const& along_locked,
                           V3<S> const& about);
/// Returns the wrench on a ring's first body about G's origin (`arm` zero) or about its centre of
/// mass (`arm` = first_arm). It is zero for a tip joined to the ground.
template <class S>
SpatialForce<S> wrench_on_first(TipClosure<S> const& tip, std::vector<S> const& along_locked,
                                V3<S> const& arm);

/// Articulated-body algorithm for an open chain.
template <class S>
OracleResult<S> aba_links(std::vector<Link<S>> const& links, V3<S> const& gravity);
/// Articulated-body algorithm for a chain with a jointed tip or loops.
template <class S>
OracleResult<S> aba_with_closures(ChainSpec const& chain, Loads const& loads);

/// Link between two beads, or from the anchor to bead 1.
template <class S>
struct BeadLink {
    V3<S> direction = V3<S>::zero();  // unit vector towards the outboard bead, W
    /// Relative acceleration u . (a_outboard - a_inboard) that preserves the length: - |v_rel
    /// across u|^2 / l.
    S closure = S(0);
};
/// Reads the links of a chain of beads. Entry k is the inboard link of bead k + 1. A jointed tip's
/// link, from the last bead to the ground or to a ring's first bead, follows the last one. Entry 0
/// of a free base is zero.
template <class S>
std::vector<BeadLink<S>> read_bead_links(ChainSpec const& chain);
/// Reads the cross-links of a chain of beads.
template <class S>
std::vector<BeadLink<S>> read_crosslinks(ChainSpec const& chain);
/// Returns the ground point of a tip link. Throws ComputationError if the tip is another joint.
Vec3 tip_anchor(ChainSpec const& chain);
/// Returns the link with vector `along`, given the velocity of its outboard end relative to its
/// inboard end.
template <class S>
BeadLink<S> bead_link(V3<S> const& along, V3<S> const& relative_velocity);
/// Returns the applied force and weight of bead k + 1, with drag, W.
template <class S>
V3<S> bead_force(ChainSpec const& chain, Loads const& loads, std::size_t k);

/// Articulated-body algorithm for a chain of beads.
template <class S>
OracleResult<S> aba_beads(ChainSpec const& chain, Loads const& loads);

}  // namespace catena::oracle
