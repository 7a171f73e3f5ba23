// Chains of rigid bodies and point beads joined by links.
#pragma once

#include <utility>
#include <vector>

#include "scene/chain_request.hpp"

namespace catena::scene {

struct ExplicitLinked {
    LinkedArrays linked;
    bool velocities = false;  // some body says its velocity or omega
};
/// Bodies {mass, inertia, com, position, quaternion, velocity, omega, beads, joint: {type: link, length, translation}} and, where there is
/// no `inertia`, beads. Every length is given or the distance at the start. Throws InputError.
ExplicitLinked read_linked(Node const& bodies, Base base, Vec3 const& anchor);

}  // namespace catena::scene
