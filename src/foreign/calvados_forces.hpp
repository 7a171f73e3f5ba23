// Comparison of a CALVADOS folder's settings with the forces of its System.
#pragma once

#include <string>
#include <vector>

#include "foreign/calvados_components.hpp"
#include "foreign/package_file.hpp"
#include "foreign/system_text.hpp"

namespace catena::foreign {

/// Returns the force of contacts in the package's form; nullptr without one.
ForceText const* contacts_of(SystemText const&);

/// Throws InputError if depth, cutoff or `fixed_lambda` of contacts are not those of the
/// configuration. Notes contacts of another form.
void compare_contacts(PackageFile const& config, SystemText const& system,
                      std::vector<std::string>& notes);

/// Throws InputError if the System lacks bonds or elastic networks that components and custom
/// restraints make, or has them with another stiffness, depth or reach. Notes further ones, and
/// components whose bonds are not compared.
void compare_bonds(PackageFile const& config, CalvadosComponents const& components,
                   SystemText const& system, std::vector<std::string>& notes);

}  // namespace catena::foreign
