// Relative change of a solution in joint coordinates by a step of iterative refinement.
#pragma once

#include "chain/chain_group.hpp"

namespace catena {

/// A refined solution of a rank's bodies, on the host, B axes. Accelerations are relative to a
/// frame that falls with gravity; `alpha` and `acceleration` already include the changes. `force`
/// has no origin if no body has a force.
struct RefinedSolution {
    ChainGroup const& group;
    Vec3 gravity;
    double reach;  // Contour length of the longest chain, nm.
    ConstView<3> torque, force, alpha, acceleration, change_of_alpha, change_of_acceleration;

    /// The larger of |change| / |solution| for angular and for linear accelerations, each with the
    /// maximum over bodies. Vanishing accelerations are compared with those that gravity and the
    /// largest load would give the heaviest body. NaN if anything is not finite. Collective.
    double relative_change(Communicator const&) const;
};

}  // namespace catena
