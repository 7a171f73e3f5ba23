// Atoms of the Protein Data Bank's formats, and the parser of the older one (PDB format 3.3). The
// parser of the newer one is in mmcif_file.hpp; structure_file.hpp chooses between them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

/// One ATOM or HETATM record, or one row of `_atom_site`. Texts have no blanks at their ends and
/// refer to the file's text, which must outlive them.
struct PdbAtom {
    std::int64_t line = 0;  // line number, or row of `_atom_site`, from 1
    bool row = false;       // `line` is a row of `_atom_site`
    bool het = false;       // HETATM
    char alternate = ' ';   // letter of the alternate location
    char insertion = ' ';   // insertion code
    /// True if the name begins with an element of two letters: in column 13 of a PDB file.
    bool at_margin = false;
    /// Number of ends of chains before the atom: TER records, changes of `label_asym_id`.
    int part = 0;
    std::string_view name, residue, chain, number, segment, element;
    /// Name of the chain in the list of sequences: its letter, or `label_asym_id`.
    std::string_view label;
    /// Position of the residue in the chain's sequence, from 1 (`label_seq_id`).
    std::optional<std::int64_t> sequence_index = {};
    double occupancy = 1;  // 1 if the file gives none
    /// B factor, angstrom^2, or the pLDDT of a predicted structure; nothing if the file gives none.
    std::optional<double> b_factor = {};
    Vec3 position{};  // angstrom

    /// True if both atoms belong to one chain: the same letter and segment, and no end of a chain
    /// between them.
    bool same_chain(PdbAtom const& other) const {
        return part == other.part && chain == other.chain && segment == other.segment;
    }
    /// True if two atoms of one chain belong to one residue.
    bool same_residue(PdbAtom const& other) const {
        return number == other.number && insertion == other.insertion && residue == other.residue;
    }
};

/// A chain's whole sequence, residues without positions included (SEQRES, `_entity_poly_seq`).
struct ListedSequence {
    std::int64_t residues = 0;       // the number that the file states
    std::vector<std::string> names;  // three-letter names; of alternative residues the first
};

/// Counts, sequences and cell of a structure file.
struct PdbSummary {
    std::int64_t atoms = 0;  // of the chosen model only
    /// Numbers of the models; 1, 2, ... if the file numbers none.
    std::vector<std::int64_t> models = {};
    /// Sequences by PdbAtom::label.
    std::map<std::string, ListedSequence> sequence = {};
    /// Edges of a rectangular cell (CRYST1, `_cell`), angstrom.
    std::optional<Vec3> cell = {};
    /// Number of data blocks with atoms; the first is read.
    int blocks = 1;
    /// What shows that the file ends too early ("the last model has no ENDMDL");
    /// empty if nothing does.
    std::string cut = {};
};

/// Receives the atoms of a file one after the other.
using TakeAtom = std::function<void(PdbAtom const&)>;

/// Decides which atoms belong to the chosen model, and lists the models.
class ModelChoice {
  public:
    /// Chooses the model of the number `wanted`, else the first.
    explicit ModelChoice(std::optional<std::int64_t> wanted) : wanted_(wanted) {}

    /// Begins a model. Returns true if it is the chosen one.
    bool begin(std::int64_t number, PdbSummary& summary);

  private:
    std::optional<std::int64_t> wanted_;
    bool found_ = false;
};

/// Calls `take` for each atom of a model of a PDB file in the file's order: that of the number
/// `model`, else the first. Serial numbers are ignored, so that none can overflow. Throws
/// InputError with `path` for other formats (HTML, empty, ...), and with the line for coordinates
/// outside their columns.
PdbSummary for_each_pdb_atom(std::string_view text, std::string const& path,
                             std::optional<std::int64_t> model, TakeAtom const& take);

/// Parses a residue's number: decimal or, beyond 9999, hybrid-36. Returns nothing if the column
/// overflowed.
std::optional<std::int64_t> residue_number(std::string_view number);

/// Edges of a rectangular cell; nothing for other cells and for cubes of 1 angstrom, which mean
/// that there is no cell.
std::optional<Vec3> rectangular_cell(Vec3 const& edges, Vec3 const& angles);

/// Name of the atom's chain: its letter, else its segment, else empty.
inline std::string_view chain_of(PdbAtom const& atom) {
    return atom.chain.empty() ? atom.segment : atom.chain;
}

}  // namespace catena::scene
