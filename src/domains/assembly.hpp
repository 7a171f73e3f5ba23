// Chains whose rigid bodies may hold residues of several of them, as serial chains of beads.
#pragma once

#include <vector>

#include "bodies/domains.hpp"
#include "domains/residue_numbers.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// A rigid body as a scene asks for it.
struct RigidSet {
    /// Ranges of residues, ascending. No two of one chain touch each other.
    std::vector<Domain> ranges;
    /// Entry of the scene, for messages.
    Node const* at = nullptr;

    /// Names of all ranges, joined by "and".
    std::string name() const;
};

/// A serial chain: flexible residues and rigid bodies, one after the other.
struct Assembly {
    /// Residues in the order of the beads.
    std::vector<std::size_t> residues;
    /// Rigid bodies as ranges of places in `residues`, ascending. Those of several ranges begin and
    /// end with the residue at which the inboard and the outboard link are.
    std::vector<Domain> rigid;
    /// Chains of the file that take part, ascending.
    std::vector<std::size_t> chains;
};

/// Orders residues and bodies as serial chains; chains that share a body become one. A chain
/// without shared bodies keeps its order. Otherwise the path through the bodies begins at the first
/// end that is an N-terminus, at a body's free side, or at a C-terminus. Throws InputError where no
/// serial chain exists, and names the residues: a flexible loop between two parts of one body, more
/// than two flexible ends at a body, and paths that close a loop. `sets` must not overlap.
std::vector<Assembly> assemble(std::vector<RigidSet> const& sets, ResidueNumbers const& numbers);

}  // namespace catena::scene
