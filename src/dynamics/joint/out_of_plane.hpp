// Forces that the joints of a planar chain carry across its plane. Its two-direction handles omit
// them, and the motion does not depend on them. On request they are computed from the
// accelerations, body by body from the tip inward.
#pragma once

#include <vector>

#include "chain/chain_group.hpp"
#include "math/executor.hpp"

namespace catena {

/// Sum of the joint wrenches that a body needs, and the position of the next joint, W.
struct NeededWrench {
    Vec3 force, torque;  // The torque is about the body's inboard joint.
    Vec3 to_next;        // Vector from the inboard to the outboard joint.
};

/// Wrench {force, torque} of every joint on its outboard body, about the joint, W. It sums `needed`
/// from the tip inward, unit by unit of the canonical tree, with every tip taken as free.
/// Collective.
std::vector<std::pair<Vec3, Vec3>> sums_from_tip(ChainGroup const&, Communicator const&,
                                                 std::vector<NeededWrench> const& needed);

}  // namespace catena
