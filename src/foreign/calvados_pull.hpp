// Comparison of a CALVADOS folder's external force with its configuration and components.
#pragma once

#include <string>
#include <vector>

#include "foreign/calvados_components.hpp"
#include "foreign/made_system.hpp"
#include "foreign/package_file.hpp"

namespace catena::foreign {

/// Throws InputError if the System's external force is not that of the configuration: the slab's
/// axis, centre and stiffness (`slab_eq`), or the expression (`ext_force`). Notes a force that the
/// configuration does not ask for.
void compare_pull(PackageFile const& config, SystemText const& system,
                  std::vector<std::string>& notes);

/// Throws InputError if the external force that the configuration asks for acts on other molecules
/// than `ext_restraint` says.
void refuse_other_pulled(PackageFile const& config, CalvadosComponents const&, MadeSystem const&);

}  // namespace catena::foreign
