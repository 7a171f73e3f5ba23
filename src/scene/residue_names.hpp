// What the residue names of structure files mean to a model of the twenty amino acids.
#pragma once

#include <string>
#include <string_view>

namespace catena::scene {

enum class ResidueKind {
    amino_acid,  // one of the twenty, or another name or a modification that keeps its charge
    charged,     // a modification with a charge that its parent does not have
    cap,         // a blocking group at a chain's end
    water,
    ion,
    other,
};

struct ResidueMeaning {
    ResidueKind kind = ResidueKind::other;
    std::string parent = {};  // three letters, of amino_acid and charged; the name itself where it
                              // is one of the twenty
};

/// In any case, blanks cut off: "MSE" is an amino_acid with the parent "MET". Names of protonation
/// states (HIE, ASH, LYN) and Amber's of residues at a chain's ends (NMET, CLYS) are their residue.
ResidueMeaning meaning_of(std::string_view name);

}  // namespace catena::scene
