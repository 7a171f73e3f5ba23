// What folders without a System are: those of Catena itself and of programs whose input is not
// read. Folders of OpenMiChroM (https://github.com/junioreif/OpenMiChroM) and polychrom
// (https://github.com/open2c/polychrom). Both use lengths of 1 nm for a bond and write no System.
// OpenMiChroM leaves structures (.ndb, .cndb, .swb) and initialStats.txt. polychrom leaves
// initArgs_N.h5, applied_forces_N.h5, starting_conformation_N.h5 and blocks_A-B.h5.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "foreign/files.hpp"
#include "foreign/settings.hpp"
#include "systems/pdb_topology.hpp"

namespace catena::foreign {

/// Sets `tool`, and `init_args` to the newest one of polychrom, if the folder is one of these
/// tools. `names` are all files of the folder in alphabetical order.
void find_known_tool(std::vector<std::string> const& names, Files&);

/// Returns the lines of Python, parted by semicolons, that write system.xml and state.xml in a
/// script of that tool.
std::string how_to_write(std::string const& tool);

/// Files that no import reads.
struct OtherFiles {
    std::string what;  // such as "LAMMPS input"
    std::string name;  // of the file that tells, without its folder
    std::string remedy;
};
/// Returns what the files are, if names or contents tell: a run or a scene of Catena, input of
/// LAMMPS, GROMACS, Amber, CHARMM or HOOMD-blue.
std::optional<OtherFiles> other_files(std::vector<std::string> const& files);

/// True if a topology of the tool has nanometres in the columns that hold angstrom: neighbours are
/// about 0.1 nm apart in place of 1 nm. Always false for other tools.
bool is_in_nanometres(std::string const& tool, std::vector<PdbChain> const& chains);

/// Reads the settings from `init_args`. Throws InputError for a file that is damaged or has values
/// of the wrong kind, and in a build without HDF5.
Settings polychrom_settings(Files const&);

}  // namespace catena::foreign
