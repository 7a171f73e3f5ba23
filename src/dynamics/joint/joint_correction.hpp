// By how much a step of iterative refinement changed a solution in joint coordinates, over the
// solution's size.
#pragma once

#include "chain/chain_group.hpp"

namespace catena {

/// On the host, of a rank's bodies. Vectors: of bodies, in the accelerated frame in which the
/// ground falls; `alpha`, `acceleration`: after the step, whose part in them the changes are.
/// `force`: absent where no body has any.
struct RefinedSolution {
    ChainGroup const& group;
    Vec3 gravity;
    double reach;  // of the longest chain
    ConstView<3> torque, force, alpha, acceleration, change_of_alpha, change_of_acceleration;

    /// The larger of |change| / |solution| of turning and of linear accelerations, each by the
    /// largest of the bodies'; NaN where something is not finite. Accelerations that vanish count
    /// as what gravity and the largest load would give the heaviest body. Collective.
    double relative_change(Communicator const&) const;
};

}  // namespace catena
