// Files that a scene names: sequences, structures, tables of positions.
#pragma once

#include <string>
#include <vector>

#include "dca/linear.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Throws InputError for a file that is missing, a folder or unreadable; `at` names the key that asked for it.
std::string read_text_file(std::string const& path, Node const& at);

/// `path` as the scene means it: relative to the folder of `scene_file`.
std::string resolved(std::string const& path, std::string const& scene_file);

/// One-letter codes of the first record of a FASTA file (a closing `*` is dropped).
std::string read_fasta(std::string const& path, Node const& at);

/// Lines "x,y,z"; blank lines, lines from `#` on and one line of column names are passed over.
std::vector<Vec3> read_position_table(std::string const& path, Node const& at);

struct PdbSites {
    std::vector<Vec3> position;        // nm
    std::vector<std::string> residue;  // three-letter names
};
/// The CA atoms of the first model of a PDB file or, where there are none, all atoms, which then must be one a residue. Alternate locations
/// but the first are passed over. InputError where the atoms belong to several chains and `single_chain` is set.
PdbSites read_pdb(std::string const& path, Node const& at, bool single_chain);

}  // namespace catena::scene
