// Chains of residues: `sequence:`, `fasta:` and `pdb:` with `model: calvados2`.
#pragma once

#include "reader/chain_request.hpp"

namespace catena::scene {

/// Of self-avoiding chains: nearer pairs of CALVADOS beads repel each other by several kT (mean
/// diameters are 0.45 to 0.68 nm).
inline constexpr double excluded_distance = 0.56;  // nm

/// Beads on links with the model's masses, link lengths and residue names, at their start
/// positions, at rest. `copy` tells the random conformations of a chain's copies apart. Sets the
/// request's rigid domains.
BeadArrays read_sequence(ChainRequest& request, std::int64_t copy);

}  // namespace catena::scene
