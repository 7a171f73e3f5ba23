// Forces of RNA in the CALVADOS models. Needs OpenMM's headers.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "structure/calvados2.hpp"
#include "systems/model.hpp"

namespace catena {

/// Nucleotides of a scene, by the links between beads of backbones and bases.
struct Nucleotides {
    /// Beads of a pair of bases that stack: those of neighbours in a chain.
    std::vector<std::pair<std::int64_t, std::int64_t>> stacks;
    /// Three consecutive beads of a backbone.
    struct Angle {
        std::int64_t first, middle, last;
    };
    std::vector<Angle> angles;
    std::int64_t count = 0;
};

/// Finds the nucleotides: beads of the backbone by their residue, and the bases that hang on them.
/// Throws InputError for a backbone with several bases, or one that branches, and for beads of RNA
/// by the built-in table that are no part of a nucleotide.
Nucleotides nucleotides_of(BeadSystem const&, ForceResidues const&);

/// Adds the forces of nucleotides to the model, each in the next group: stacking of bases and
/// angles of the backbone. The pairs that these bind are excluded from the `pairs` of contacts and
/// charges. Nothing happens without nucleotides.
void add_rna_forces(OpenMmModel&, Nucleotides const&, ForceResidues const&, BeadSystem const&,
                    std::span<OpenMM::CustomNonbondedForce* const> pairs);

}  // namespace catena
