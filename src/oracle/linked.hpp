// Inside the oracles: rigid bodies and point beads on links, in absolute coordinates, read in the
// oracle's scalar.
#pragma once

#include "oracle/joint.hpp"

namespace catena::oracle {

template <class S>
struct LinkedBody {
    S mass;
    bool bead = false;
    M3<S> orientation, inertia;  // B to W; about com, W
    V3<S> omega;                 // W
    V3<S> force, torque;         // at com, W: all but the links'; gyroscopic torque included
    std::array<V3<S>, 2> end{V3<S>::zero(),
                             V3<S>::zero()};  // of the inboard and the outboard link, from com, W
    /// Part of the acceleration of an end that the angular acceleration does not give.
    V3<S> centripetal(std::size_t i) const { return cross(omega, cross(omega, end[i])); }
};
template <class S>
struct LinkedModel {
    std::vector<LinkedBody<S>> bodies;
    std::vector<BeadLink<S>>
        links;  // as read_bead_links; `closure`: - |v_rel across u|^2 / l of the link's ends
    std::size_t first = 0;  // 1: free base, which has no link 0
};
template <class S>
LinkedModel<S> read_linked(ChainSpec const& chain, Loads const& loads);
/// Matrix T of the link forces (src/dca/README.md, "Link chains"): diagonal and what stands beside
/// it, entry k of link k.
template <class S>
void link_compliance(LinkedModel<S> const& model, std::vector<S>& diagonal, std::vector<S>& beside);

template <class S>
OracleResult<S> tridiagonal_linked(ChainSpec const& chain, Loads const& loads);

}  // namespace catena::oracle
