// Files of another tool that make a scene: serialised System, topology, State, settings.
#pragma once

#include <string>
#include <vector>

namespace catena::foreign {

/// The files that an import reads; a name is empty if there is no such file.
struct Files {
    /// Folder that holds them.
    std::string folder;
    std::string system;    // serialised System
    std::string topology;  // PDB or mmCIF
    std::string state;     // serialised State, if the start's positions are its own
    std::string integrator;
    /// initArgs_N.h5 of polychrom, the newest one.
    std::string init_args;
    /// config.yaml and components.yaml of the CALVADOS package.
    std::string config, components;
    /// OpenMiChroM or polychrom, if files of the folder are theirs; else empty.
    std::string tool;
    /// Sentences on the choice among several files.
    std::vector<std::string> notes;
};

/// Finds the files of a folder, or those beside a System. XML files are told apart by their root
/// element, several topologies by their number of atoms, which must be the System's number of
/// particles. `topology` is the PDB file, mmCIF file or State that the user names, in any folder or
/// in this one; if it is empty the folder must hold one. Throws InputError if a file is missing, if
/// there are several and nothing tells which one is meant, and for config.yaml, integrator.xml and
/// topologies that are not what their names say.
Files find_files(std::string const& source, std::string const& topology);

/// Name for the scene: that of the System, or of its folder if the System is called "system".
std::string name_of(Files const&);

}  // namespace catena::foreign
