// Inside the oracles: a body and its inboard joint read from ChainSpec in the oracle's scalar.
#pragma once

#include "dca/oracle/algebra.hpp"
#include "dca/oracle/oracle.hpp"

namespace catena::oracle {

/// Body k + 1 and its inboard joint.
template <class S>
struct Link {
    JointType type = JointType::free;
    M3<S> rotation;                // components in B to components in the inboard body's axes (free: W)
    V3<S> translation;             // from the inboard body's origin to this one's, inboard body's axes (free: W)
    V3<S> axis = V3<S>::zero();    // revolute: unit axis, B
    V3<S> rate;                    // angular velocity relative to the inboard body, B
    V3<S> torque = V3<S>::zero();  // of the joint on this body, springs and dampers included, along the free directions, B
    S spring_energy = S(0);
    S mass;
    V3<S> com;                            // from the origin, B
    M3<S> inertia;                        // about com, B
    V3<S> applied_torque, applied_force;  // at com, W, without gravity
};
/// Throws ComputationError for a joint type the oracles do not know.
template <class S>
std::vector<Link<S>> read_links(ChainSpec const& chain);

/// Absolute orientation (B to W) and angular velocity (B) of every body.
template <class S>
struct Attitude {
    M3<S> orientation;
    V3<S> omega;
};
template <class S>
std::vector<Attitude<S>> attitudes(std::vector<Link<S>> const& links);

/// A link between beads, or from the anchor to bead 1.
template <class S>
struct BeadLink {
    V3<S> direction = V3<S>::zero();  // unit, towards the outboard bead, W
    S closure = S(0);                 // u . (a_outboard - a_inboard) that keeps the length: - |v_rel across u|^2 / l
};
/// Entry k is the inboard link of bead k + 1. Entry 0 of a free base is zero.
template <class S>
std::vector<BeadLink<S>> read_bead_links(ChainSpec const& chain);
/// Applied force and weight of bead k + 1, W.
template <class S>
V3<S> bead_force(ChainSpec const& chain, Loads const& loads, std::size_t k);

template <class S>
OracleResult<S> aba_beads(ChainSpec const& chain, Loads const& loads);

}  // namespace catena::oracle
