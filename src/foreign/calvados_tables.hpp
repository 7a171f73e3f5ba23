// Comparison of a CALVADOS folder's System with the tables that it was made of: residues,
// sequences, custom restraints.
#pragma once

#include <string>
#include <vector>

#include "foreign/calvados_components.hpp"
#include "foreign/made_system.hpp"
#include "foreign/package_file.hpp"

namespace catena::foreign {

/// Compares masses, diameters and stickiness of particles with the components' `fresidues`, names
/// of residues with `ffasta`, and the System's last bonds with `fcustom_restraints`: their
/// beads, lengths and stiffnesses. Throws InputError for a table in the folder that differs or is
/// damaged. Notes the same for tables elsewhere, which may have been changed since, and tables that
/// are not there. `components` is nullptr without a components.yaml.
void compare_tables(PackageFile const& config, CalvadosComponents const* components,
                    std::string const& folder, MadeSystem const&, std::vector<std::string>& notes);

}  // namespace catena::foreign
