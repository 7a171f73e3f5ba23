// Comparison of a CALVADOS folder's settings with the forces of its System.
#pragma once

#include <string>
#include <vector>

#include "foreign/calvados_checks.hpp"
#include "foreign/package_file.hpp"
#include "foreign/system_text.hpp"

namespace catena::foreign {

/// Throws InputError if contacts or the external force of the System are not those of the
/// configuration: depth, cutoff and `fixed_lambda` of contacts, the slab's stiffness, the
/// expression of `ext_force`.
void refuse_other_forces(PackageFile const& config, SystemText const& system);

/// Throws InputError if the System lacks bonds or elastic networks that components and custom
/// restraints make, or has them with another stiffness. Notes further ones. Components other than
/// proteins are not compared.
void refuse_other_bonds(PackageFile const& config, CalvadosComponents const& components,
                        SystemText const& system, std::string const& components_file,
                        std::vector<std::string>& notes);

}  // namespace catena::foreign
