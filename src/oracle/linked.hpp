// Rigid bodies and point beads on links, in absolute coordinates, read in the oracle's scalar.
// Internal to the oracles.
#pragma once

#include "oracle/joint.hpp"

namespace catena::oracle {

/// Rigid body or bead at one state.
template <class S>
struct LinkedBody {
    S mass;
    bool bead = false;
    M3<S> orientation, inertia;  // B to W; inertia about com, W
    V3<S> omega;                 // W
    V3<S> force, torque;         // load at com, W, gyroscopic torque included, link forces not
    /// Ends of the inboard and the outboard link relative to com, W.
    std::array<V3<S>, 2> end{V3<S>::zero(), V3<S>::zero()};
    /// Part of the acceleration of an end that depends on the angular velocity alone.
    V3<S> centripetal(std::size_t i) const { return cross(omega, cross(omega, end[i])); }
};
/// Chain of linked bodies.
template <class S>
struct LinkedModel {
    std::vector<LinkedBody<S>> bodies;
    /// Links as from read_bead_links(); `closure` is - |v_rel across u|^2 / l of the link's ends.
    std::vector<BeadLink<S>> links;
    std::size_t first = 0;  // first link: 1 for a free base, which has no link 0
};
/// Reads a chain of linked bodies.
template <class S>
LinkedModel<S> read_linked(ChainSpec const& chain, Loads const& loads);
/// Computes the matrix T of the link forces (src/dca/README.md, "Link chains"). `diagonal` and
/// `beside` are its diagonal and off-diagonal; entry k belongs to link k.
template <class S>
void link_compliance(LinkedModel<S> const& model, std::vector<S>& diagonal, std::vector<S>& beside);

/// Solves a chain of linked bodies by elimination in the tridiagonal system of the link forces.
template <class S>
OracleResult<S> tridiagonal_linked(ChainSpec const& chain, Loads const& loads);

}  // namespace catena::oracle
