// Inside the oracles: a body and its inboard joint read from ChainSpec in the oracle's scalar.
#pragma once

#include <array>
#include <string>

#include "oracle/algebra.hpp"
#include "oracle/oracle.hpp"

namespace catena::oracle {

/// A direction of a joint or a relative acceleration: of the outboard side against the inboard one,
/// at the body's origin.
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
/// Power of a wrench along a motion, both about the same point.
template <class S>
S power(Motion<S> const& m, SpatialForce<S> const& f) {
    return dot(m.angular, f.torque) + dot(m.linear, f.force);
}

/// Body k + 1 and its inboard joint.
template <class S>
struct Link {
    JointType type = JointType::free;
    bool driven = false;
    M3<S> rotation;     // components in B to components in the inboard body's axes (free: W)
    V3<S> translation;  // from the inboard body's origin to this one's, the joint's shift included,
                        // inboard body's axes (free: W)
    std::array<Motion<S>, 3> free;  // the directions of the coordinates, B. Free: of its rotation
    int dof = 0;                    // how many of them there are
    V3<S> rate, slide;  // angular velocity and the origin's velocity relative to the inboard body,
                        // B (free: slide in W)
    V3<S> drift = V3<S>::zero();  // angular acceleration that the rates give beside inboard omega x
                                  // rate, B (universal)
    V3<S> prescribed = V3<S>::zero();  // driven: q''
    Motion<S> gap;                     // Loads::gaps, B
    V3<S> effort = V3<S>::zero();      // along the coordinates: given force, springs, dampers
    S spring_energy = S(0);
    S mass;
    V3<S> com;                            // from the origin, B
    M3<S> inertia;                        // about com, B
    V3<S> applied_torque, applied_force;  // at com, W, without gravity: wrench, beads' forces, drag

    /// Coordinates whose second derivatives follow from the forces.
    int unknown() const { return driven ? 0 : dof; }
};
/// A joint in the oracle's scalar, as BodyArrays and TipJoint describe it.
template <class S>
struct JointShape {
    JointType type;
    V3<S> axis, first_axis;  // need not be of unit length
    S pitch;
    M3<S> rotation;
    V3<S> translation;
    std::array<S, 2> q;
    std::array<double, 4> quaternion;  // spherical and free
};
/// Sets type, rotation, translation and directions. Throws ComputationError naming `where` for a
/// link.
template <class S>
void place(JointShape<S> const& shape, std::string const& where, Link<S>& link);

/// Sum of the directions times their coordinates.
template <class S>
Motion<S> along(Link<S> const& link, V3<S> const& coordinates);
/// With P the directions: coordinates of a motion (P^T P)^-1 P^T m, efforts of a wrench along them
/// P^T f, and the wrench in their span that has given efforts, P (P^T P)^-1 effort (B).
template <class S>
V3<S> coordinates(Link<S> const& link, Motion<S> const& motion);
template <class S>
V3<S> efforts(Link<S> const& link, SpatialForce<S> const& wrench);
template <class S>
SpatialForce<S> spread(Link<S> const& link, V3<S> const& effort);
/// The directions that the joint leaves no freedom, B; all six when it is driven.
template <class S>
std::vector<Motion<S>> restricted(Link<S> const& link);

/// All bodies. Throws ComputationError for a joint that has no place in a chain of bodies.
template <class S>
std::vector<Link<S>> read_links(ChainSpec const& chain, Loads const& loads);

/// Where a body is and how it moves.
template <class S>
struct Attitude {
    M3<S> orientation;       // B to W
    V3<S> omega;             // B
    V3<S> origin, velocity;  // of the body's origin, W
};
template <class S>
std::vector<Attitude<S>> attitudes(std::vector<Link<S>> const& links);

/// The joint from the last body to ground, or to a ring's first body; on it acts the frame G in the
/// place of an outboard body, at rest or that first body's B.
template <class S>
struct TipClosure {
    bool ring = false;
    V3<S> first_arm = V3<S>::zero();  // ring: from the first body's centre of mass to G's origin, W
    V3<S> arm,
        frame;  // from the last body's centre of mass to the origins of G and of the joint frame, W
    std::vector<Motion<S>> locked;  // directions in which G may not move against the last body, W
    Motion<S> closure;  // acceleration of G against the last body's point there less that along the
                        // coordinates, W
};
/// Rates of the joint: what the bodies' velocities leave along the joint's directions (least
/// squares).
template <class S>
TipClosure<S> read_tip(ChainSpec const& chain, std::vector<Link<S>> const& links,
                       std::vector<Attitude<S>> const& attitude);
/// How a body at one end of the tip's joint moves, W.
template <class S>
struct TipEnd {
    V3<S> com_acceleration, alpha, omega;
};
/// How far the bodies' accelerations are from a closed tip, one entry a locked direction: zero when
/// it is. `first` counts in a ring.
template <class S>
std::vector<S> tip_defect(TipClosure<S> const& tip, TipEnd<S> const& last, TipEnd<S> const& first);
/// Of a wrench along the locked directions on G: what the last body feels about its centre of mass,
/// and about the joint frame.
template <class S>
SpatialForce<S> tip_wrench(TipClosure<S> const& tip, std::vector<S> const& along_locked,
                           V3<S> const& about);
/// What a ring's first body feels about G's origin (`arm` zero), or about its centre of mass (`arm`
/// its first_arm). Else zero.
template <class S>
SpatialForce<S> wrench_on_first(TipClosure<S> const& tip, std::vector<S> const& along_locked,
                                V3<S> const& arm);

/// Articulated bodies of an open chain.
template <class S>
OracleResult<S> aba_links(std::vector<Link<S>> const& links, V3<S> const& gravity);
template <class S>
OracleResult<S> aba_with_tip(ChainSpec const& chain, Loads const& loads);

/// A link between beads, or from the anchor to bead 1.
template <class S>
struct BeadLink {
    V3<S> direction = V3<S>::zero();  // unit, towards the outboard bead, W
    S closure =
        S(0);  // u . (a_outboard - a_inboard) that keeps the length: - |v_rel across u|^2 / l
};
/// Entry k is the inboard link of bead k + 1; behind the last stands that of a jointed tip, from
/// the last bead to the ground or a ring's first. Entry 0 of a free base is zero.
template <class S>
std::vector<BeadLink<S>> read_bead_links(ChainSpec const& chain);
/// Ground point of a tip link. Throws ComputationError when the tip is another joint.
Vec3 tip_anchor(ChainSpec const& chain);
/// From the velocity of the outboard end less that of the inboard one.
template <class S>
BeadLink<S> bead_link(V3<S> const& along, V3<S> const& relative_velocity);
/// Applied force and weight of bead k + 1, W.
template <class S>
V3<S> bead_force(ChainSpec const& chain, Loads const& loads, std::size_t k);

template <class S>
OracleResult<S> aba_beads(ChainSpec const& chain, Loads const& loads);

}  // namespace catena::oracle
