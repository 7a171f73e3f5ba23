// One site a residue, chosen from the atoms of a PDB file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/linear.hpp"
#include "scene/node.hpp"

namespace catena::scene {

struct PdbSite {
    Vec3 position;                       // nm
    std::string residue;                 // name in the file
    std::string label;                   // number with insertion code, "52A"
    std::optional<std::int64_t> number;  // nothing where the file gives none that can be read
    std::optional<Vec3> carbonyl{},
        nitrogen{};  // ends of the peptide bonds, where the file has them, nm
};

struct PdbSites {
    std::string file;  // for messages
    std::vector<PdbSite> sites;
    std::optional<Vec3> cell{};      // of the file, rectangular, nm
    std::vector<std::string> notes;  // what was left out or chosen, a sentence each

    std::vector<Vec3> positions() const;
};

/// The alpha carbons of the first model of a PDB file or, where it has none, all atoms, which then
/// must be one a residue. Of alternate locations the one of largest occupancy is taken, the first
/// among equals. Water, ions, caps and, beside a protein, other HETATM residues are left out with a
/// note. InputError for residues without their site or with two of them and, where `single_chain`
/// is set, for sites of several chains (TER, letter, segment).
PdbSites read_pdb(std::string const& path, Node const& at, bool single_chain);

}  // namespace catena::scene
