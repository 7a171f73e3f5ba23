// Topology of a start whose positions are in a serialised State.
#pragma once

#include <string>
#include <vector>

#include "foreign/files.hpp"
#include "scene/scene.hpp"

namespace catena::foreign {

/// A written topology.
struct WrittenStart {
    std::string topology;  // path of topology.pdb
    /// Sentences on what of the State is not used, and on rounded positions.
    std::vector<std::string> notes;
};

/// Writes topology.pdb with the State's positions into `folder`. Chains and residues are those of
/// the files' topology. Without one, chains are runs of consecutive particles that bonds or
/// constraints of the System join, and residues have no name. Throws InputError for different
/// numbers of particles, and for positions that a PDB file cannot hold.
WrittenStart write_start(Files const&, OpenMmSpec const&, std::string const& folder);

}  // namespace catena::foreign
