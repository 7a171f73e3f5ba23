// Topology of a start whose positions are in a serialised State.
#pragma once

#include <string>

#include "foreign/files.hpp"
#include "scene/scene.hpp"

namespace catena::foreign {

/// Writes topology.pdb with the State's positions into `folder` and returns its path. Chains and
/// residues are those of the files' topology. Without one, chains are runs of consecutive particles
/// that bonds or constraints of the System join, and residues have no name. Throws InputError for
/// different numbers of particles.
std::string write_start(Files const&, OpenMmSpec const&, std::string const& folder);

}  // namespace catena::foreign
