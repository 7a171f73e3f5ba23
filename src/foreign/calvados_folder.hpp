// Folders of the CALVADOS package (https://github.com/KULL-Centre/CALVADOS): its files and its
// configuration. The package writes config.yaml, components.yaml, NAME.xml and top.pdb. Its run
// adds equilibration_final.pdb, checkpoint.pdb and restart.chk.
#pragma once

#include <string>

#include "foreign/files.hpp"
#include "foreign/settings.hpp"

namespace catena::foreign {

/// Sets `config` and `components` if the folder is one of the package.
void find_calvados_files(Files&);

/// Name of the package's system, `sysname` of its configuration.
std::string calvados_name(std::string const& config);

/// Sets the topology to the package's last frame, else to its start, and notes the choice. Returns
/// false if the folder is not one of the package or holds neither.
bool take_calvados_start(Files&);

/// Reads config.yaml and components.yaml. Throws InputError for values of the wrong kind.
Settings calvados_settings(Files const&);

}  // namespace catena::foreign
