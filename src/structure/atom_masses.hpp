// Masses of the atoms in structure files.
#pragma once

#include <optional>

#include "structure/pdb_file.hpp"

namespace catena::scene {

/// Mass of the atom, amu, by its element or, where the file gives none, by its name. Returns
/// nothing for elements that proteins do not have.
std::optional<double> atom_mass(PdbAtom const& atom);

}  // namespace catena::scene
