// Classification of residue names in structure files for a model of the twenty amino acids.
#pragma once

#include <string>
#include <string_view>

namespace catena::scene {

/// Kind of residue.
enum class ResidueKind {
    amino_acid,  // one of the twenty, or another name or a modification with the same charge
    charged,     // a modification with another charge than its parent
    cap,         // a blocking group at a chain's end
    water,
    ion,
    other,
};

/// Kind of a residue and the amino acid that it stands for.
struct ResidueMeaning {
    ResidueKind kind = ResidueKind::other;
    /// Three-letter name of the amino acid, for amino_acid and charged; the name itself for one of
    /// the twenty.
    std::string parent = {};
};

/// Classifies a name; case and blanks are ignored. "MSE" is an amino_acid with the parent "MET".
/// Names of protonation states (HIE, ASH, LYN) and Amber's names of terminal residues (NMET, CLYS)
/// map to their residue.
ResidueMeaning meaning_of(std::string_view name);

/// True if the name is that of an amino acid, also of a modified one.
bool is_amino_acid(std::string_view name);

/// True if the name is that of a nucleotide of RNA or DNA, such as "A", "DG" or "RU5".
bool is_nucleotide(std::string_view name);

/// Remedy for nucleotides in a structure file.
inline constexpr char const* nucleotide_remedy =
    "name a chain of amino acids by `chain`, or take nucleic acids out of the file; RNA takes its "
    "`sequence` and `model: calvados_rna`";

}  // namespace catena::scene
