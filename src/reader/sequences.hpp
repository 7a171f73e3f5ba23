// Reader of chains of residues: `sequence:`, `fasta:` and `pdb:` with `model: calvados2`.
#pragma once

#include "reader/chain_request.hpp"

namespace catena::scene {

/// Throws InputError for keys and units that do not fit a chain of residues.
void check_residue_keys(ChainRequest& request);

/// Returns beads on links with the model's masses, link lengths and residue names, at their start
/// positions, at rest. `copy` selects the random conformation among a chain's copies. Sets the
/// request's rigid domains and residues.
BeadArrays read_sequence(ChainRequest& request, std::int64_t copy);

}  // namespace catena::scene
