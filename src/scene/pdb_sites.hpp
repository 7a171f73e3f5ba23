// Selection of one site per residue from the atoms of a PDB file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/linear.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// The position that becomes a bead, with the residue's names.
struct PdbSite {
    Vec3 position;                       // nm
    std::string residue;                 // name in the file
    std::string label;                   // number with insertion code, "52A"
    std::optional<std::int64_t> number;  // none if unreadable
    std::optional<Vec3> carbonyl{},
        /// Ends of the peptide bonds (atoms C and N), if the file has them, nm.
        nitrogen{};
};

/// Sites of a file in its order.
struct PdbSites {
    std::string file;  // for messages
    std::vector<PdbSite> sites;
    std::optional<Vec3> cell{};  // cell of the file, rectangular, nm
    /// Sentences on what was left out or chosen.
    std::vector<std::string> notes;

    std::vector<Vec3> positions() const;
};

/// Returns the alpha carbons of the first model of a PDB file. A file without alpha carbons must
/// have one atom per residue, and all atoms are returned. The alternate location of largest
/// occupancy is used, the first among equals. Water, ions and caps are left out with a note; so are
/// other HETATM residues next to a protein. Throws InputError for residues without a site or with
/// two. If `single_chain` is set, sites of several chains (TER, letter, segment) are refused too.
PdbSites read_pdb(std::string const& path, Node const& at, bool single_chain);

}  // namespace catena::scene
