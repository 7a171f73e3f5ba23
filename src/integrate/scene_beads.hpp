// A scene's beads as OpenMM knows them.
#pragma once

#include <vector>

#include "force/openmm_force.hpp"
#include "math/linear.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Every bead of the scene in the order of its chains; which rank owns which is still to be said.
BeadSystem bead_system_of(Scene const&);
/// Where they stand at the scene's start, in the same order; W, unwrapped.
std::vector<Vec3> bead_positions_of(Scene const&);

}  // namespace catena
