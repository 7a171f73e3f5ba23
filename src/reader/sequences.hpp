// Reader of chains of residues: `sequence:`, `fasta:` and `pdb:` with `model: calvados2`.
#pragma once

#include "reader/chain_request.hpp"

namespace catena::scene {

/// Excluded distance of self-avoiding chains. Closer pairs of CALVADOS beads repel each other by
/// several kT (mean diameters are 0.45 to 0.68 nm).
inline constexpr double excluded_distance = 0.56;  // nm

/// Throws InputError for keys and units that do not fit a chain of residues.
void check_residue_keys(ChainRequest& request);

/// Returns beads on links with the model's masses, link lengths and residue names, at their start
/// positions, at rest. `copy` selects the random conformation among a chain's copies. Sets the
/// request's rigid domains and residues.
BeadArrays read_sequence(ChainRequest& request, std::int64_t copy);

}  // namespace catena::scene
