// Residues that a structure file lists in a chain's sequence but gives no position.
#pragma once

#include <cstddef>
#include <vector>

#include "reader/chain_request.hpp"
#include "structure/pdb_sites.hpp"

namespace catena::scene {

/// Fills the gaps before the sites `gaps` of `from`, which holds one chain: `from.chains[0]`. What
/// is missing follows from the file's sequence; its beads grow as a self-avoiding
/// linker between both ends, clear of `obstacles`. Numbers continue those before the gap. Each
/// linker gets a note. Throws InputError, with both residues, for an unknown sequence and for a
/// distance that the linker cannot bridge.
void model_gaps(PdbSites& from, std::vector<std::size_t> const& gaps,
                std::vector<Vec3> const& obstacles, ChainRequest const& request, Node const& at);

}  // namespace catena::scene
