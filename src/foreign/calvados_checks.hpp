// Checks that the files of a CALVADOS folder agree: configuration, components, System, topology.
#pragma once

#include <string>
#include <vector>

#include "foreign/files.hpp"
#include "foreign/package_file.hpp"
#include "foreign/settings.hpp"

namespace catena::foreign {

/// Throws InputError for a configuration that was cut: after a key without a value, or after a
/// line, which the order of its keys tells. The package writes them in alphabetical order. Notes a
/// last line with a value but without a line feed, which may be cut.
void refuse_cut(PackageFile const& config, std::vector<std::string>& notes);

/// Compares the configuration and the components with the System, the topology and the tables that
/// it was made of. Throws InputError for values that are not the System's, and for a force that it
/// lacks. Notes what cannot be compared and what is not taken over. `is_continued` says that the
/// start is not the package's first one; a continued run of the package leaves out forces of the
/// equilibration.
void check_package(PackageFile const& config, Files const& files, bool is_continued,
                   Settings& settings);

}  // namespace catena::foreign
