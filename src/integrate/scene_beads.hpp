// The beads of a scene and their start positions, in the form that OpenMM's model needs.
#pragma once

#include <vector>

#include "force/openmm_force.hpp"
#include "math/linear.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Returns every bead of the scene in the order of its chains. The owners (first_of_rank, by_rank)
/// are left empty.
BeadSystem bead_system_of(Scene const&);
/// Returns the beads' positions at the scene's start, in the same order; nm, W, unwrapped.
std::vector<Vec3> bead_positions_of(Scene const&);

}  // namespace catena
