// Parser of PDB files (format 3.3, section "ATOM"), shared by chains of scenes and topologies of
// Systems.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "math/linear.hpp"

namespace catena::scene {

/// One ATOM or HETATM record. Texts have no blanks at their ends and refer to the file's text,
/// which must outlive them.
struct PdbAtom {
    int line = 0;          // line number from 1
    bool het = false;      // HETATM
    char alternate = ' ';  // letter of the alternate location
    char insertion = ' ';  // insertion code
    /// True if the name begins in column 13, the first column of an element of two letters.
    bool at_margin = false;
    /// Number of TER records before the atom.
    int part = 0;
    std::string_view name, residue, chain, number, segment, element;
    double occupancy = 1;  // 1 if the file gives none
    Vec3 position{};       // angstrom

    /// True if both atoms belong to one chain: the same letter and segment, and no TER between
    /// them.
    bool same_chain(PdbAtom const& other) const {
        return part == other.part && chain == other.chain && segment == other.segment;
    }
};

/// Counts and cell of a PDB file.
struct PdbSummary {
    std::int64_t atoms = 0;  // first model only
    int models = 0;          // 1 if the file numbers none
    /// Number of residues listed by SEQRES, by chain.
    std::map<std::string, std::int64_t> sequence;
    /// Edges of a rectangular cell (CRYST1), angstrom.
    std::optional<Vec3> cell;
};

/// Calls `take` for each atom of the first model in the file's order. Serial numbers are ignored,
/// so that none can overflow. Throws InputError with `path` for other formats (mmCIF, compressed,
/// HTML, empty, ...). Throws InputError with `path` and the line for coordinates outside their
/// columns.
PdbSummary for_each_pdb_atom(std::string_view text, std::string const& path,
                             std::function<void(PdbAtom const&)> const& take);

/// Parses a residue's number: decimal or, beyond 9999, hybrid-36. Returns nothing if the column
/// overflowed.
std::optional<std::int64_t> residue_number(std::string_view number);

/// Name of the atom's chain: its letter, else its segment, else empty.
inline std::string_view chain_of(PdbAtom const& atom) {
    return atom.chain.empty() ? atom.segment : atom.chain;
}

}  // namespace catena::scene
