// Chains of residues: `sequence:`, `fasta:` and `pdb:` with `model: calvados2`.
#pragma once

#include "scene/chain_request.hpp"

namespace catena::scene {

/// Beads on links with the model's masses, link lengths and residue names, at their start positions, at rest. `copy` tells the random
/// conformations of a chain's copies apart. Sets the request's rigid domains.
BeadArrays read_sequence(ChainRequest& request, std::int64_t copy);

}  // namespace catena::scene
