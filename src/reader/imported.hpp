// Chains that the scene does not write down because OpenMM's System and its topology have them.
#pragma once

#include <vector>

#include "reader/chains.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// One free chain of beads for each chain of `forces.openmm.topology`: masses and link lengths from
/// the System, positions from the topology projected to these lengths, at rest or, when `warm`,
/// thermal. Sets the scene's box to the System's where the scene gives none and some force is
/// periodic. Precondition: the scene has a system. Throws InputError.
std::vector<Draft> import_chains(Node const& openmm, Scene& scene, bool warm);

}  // namespace catena::scene
