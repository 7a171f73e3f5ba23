// What the joints of a planar chain carry across its plane: its two-direction handles leave that
// out, and nothing in the motion depends on it. On request it follows from the accelerations, body
// after body from the tip.
#pragma once

#include <vector>

#include "chain/chain_group.hpp"
#include "math/executor.hpp"

namespace catena {

/// What a body needs of all its joints together, and where the next joint is; ground axes.
struct NeededWrench {
    Vec3 force, torque;  // torque about the body's inboard joint
    Vec3 to_next;        // from its inboard to its outboard joint
};

/// The wrench of every joint on its outboard body, about the joint, ground axes: sums of `needed`
/// from the tip on, unit by unit of the canonical tree, as if every tip were free. Collective.
std::vector<std::pair<Vec3, Vec3>> sums_from_tip(ChainGroup const&, Communicator const&,
                                                 std::vector<NeededWrench> const& needed);

}  // namespace catena
