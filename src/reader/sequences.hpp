// Reader of chains of residues and nucleotides: `sequence:`, `fasta:` and `pdb:` with their
// `model`.
#pragma once

#include <cstdint>
#include <string>

#include "reader/chain_request.hpp"

namespace catena::scene {

/// Throws InputError for keys and units that do not fit a chain of residues.
void check_residue_keys(ChainRequest& request);

/// Returns beads on links with the model's masses, link lengths and residue names, at their start
/// positions, at rest. `copy` selects the random conformation among a chain's copies. Sets the
/// request's rigid domains and residues.
BeadArrays read_sequence(ChainRequest& request, std::int64_t copy);

/// Distance that the beads of a self-avoiding start of RNA keep, nm. The model's beads are 0.62 to
/// 0.70 nm wide.
inline constexpr double excluded_of_nucleotides = 0.6;

/// True if the chain's `model` is that of RNA.
bool is_rna(ChainRequest const& request);
/// Makes a chain of nucleotides of `sequence` or `fasta`, at rest: beads of backbone and base by
/// turns, each with the model's mass, link length and residue name. `copy` selects the random
/// conformation among a chain's copies. Throws InputError for letters that are no nucleotides, and
/// for keys that do not fit RNA.
void read_nucleotides(ChainRequest& request, std::int64_t copy, ChainSpec& chain);

/// A sequence as written, and the key that names it.
struct WrittenSequence {
    std::string text;
    Node const& source;
};
/// Reads `sequence`, or the record of `fasta`. Throws InputError.
WrittenSequence written_sequence(ChainRequest const& request);

/// Start of a chain of residues: a file of positions, or a conformation.
struct WrittenStart {
    Node const* file = nullptr;
    bool self_avoiding = false;
};
/// Reads `positions` and `conformation`. Throws InputError.
WrittenStart written_start(ChainRequest const& request);

}  // namespace catena::scene
