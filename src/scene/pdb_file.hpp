// The lines of a PDB file (format 3.3, section "ATOM"), as chains of scenes and topologies of
// Systems read them alike.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "math/linear.hpp"

namespace catena::scene {

/// Texts are without blanks at their ends and hold as long as the file's text.
struct PdbAtom {
    int line = 0;            // from 1
    bool het = false;        // HETATM
    char alternate = ' ';    // letter of the alternate location
    char insertion = ' ';    // insertion code
    bool at_margin = false;  // the name begins in column 13, where an element of two letters stands
    int part = 0;            // how many TER records came before
    std::string_view name, residue, chain, number, segment, element;
    double occupancy = 1;  // 1 where the file gives none
    Vec3 position{};       // angstrom

    /// Whether both belong to one chain: no TER between them, the same letter and segment.
    bool same_chain(PdbAtom const& other) const {
        return part == other.part && chain == other.chain && segment == other.segment;
    }
};

struct PdbSummary {
    std::int64_t atoms = 0;                        // of the first model
    int models = 0;                                // 1 where the file numbers none
    std::map<std::string, std::int64_t> sequence;  // residues that SEQRES lists, by chain
    std::optional<Vec3> cell;                      // edges of a rectangular cell (CRYST1), angstrom
};

/// Calls `take` for each atom of the first model in the file's order. Serial numbers are not read,
/// so that none can overflow. InputError, with `path` and the line, for what is no PDB file (mmCIF,
/// compressed, HTML, empty, ...) and for coordinates that do not stand in their columns.
PdbSummary for_each_pdb_atom(std::string_view text, std::string const& path,
                             std::function<void(PdbAtom const&)> const& take);

/// A residue's number: decimal or, beyond 9999, hybrid-36; nothing where the column overflowed.
std::optional<std::int64_t> residue_number(std::string_view number);

/// How the file calls the atom's chain: its letter, else its segment, else nothing.
inline std::string_view chain_of(PdbAtom const& atom) {
    return atom.chain.empty() ? atom.segment : atom.chain;
}

}  // namespace catena::scene
