// Comparison of a CALVADOS folder's configuration with the charges of its System.
#pragma once

#include <string>
#include <vector>

#include "foreign/files.hpp"
#include "foreign/package_file.hpp"

namespace catena::foreign {

/// Throws InputError if the System's charges do not act as the package makes them at the
/// configuration's temperature, ionic strength, pH and cutoff. Charges whose screening is not
/// recognised are not compared. `notes` receives a sentence on a temperature at which there is
/// nothing to compare with.
void refuse_other_charges(PackageFile const& config, Files const& files,
                          std::vector<std::string>& notes);

}  // namespace catena::foreign
