// Comparison of a CALVADOS folder's configuration and components with the charges of its System.
#pragma once

#include <string>
#include <vector>

#include "foreign/calvados_components.hpp"
#include "foreign/made_system.hpp"
#include "foreign/package_file.hpp"

namespace catena::foreign {

/// Throws InputError if the System's charges do not act as the package makes them at the
/// configuration's temperature, ionic strength, pH and cutoff. Notes what cannot be compared, and
/// the charge of histidines if there is no pH.
void compare_charges(PackageFile const& config, MadeSystem const&, std::vector<std::string>& notes);

/// Throws InputError if ends of proteins have other charges than their `charge_termini` says.
void refuse_other_termini(PackageFile const& config, CalvadosComponents const&, MadeSystem const&);

}  // namespace catena::foreign
