// Import of chains from OpenMM's System and its topology, for scenes without `chains`.
#pragma once

#include <vector>

#include "reader/chains.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Makes one free chain of beads for each chain of `forces.openmm.topology`. Masses and link
/// lengths are those of the System; positions are those of the topology, projected to these
/// lengths. Chains start at rest or, if `warm`, thermal. Without a box in the scene, sets it to the
/// System's if a force is periodic. Precondition: the scene has a system. Throws InputError.
std::vector<Draft> import_chains(Node const& openmm, Scene& scene, bool warm);

}  // namespace catena::scene
