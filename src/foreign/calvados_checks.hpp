// Checks that the files of a CALVADOS folder agree: configuration, components, System, topology.
#pragma once

#include <cstdint>
#include <set>
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

/// Throws InputError if the configuration's box or charges are not the System's, or if it asks for
/// a force that the System lacks. Notes frames that are never due. `is_continued` says that the
/// start is not the package's first one; a continued run of the package leaves out forces of the
/// equilibration.
void check_configuration(PackageFile const& config, Files const& files, bool is_continued,
                         Settings& settings);

/// Holds what the package's components say.
struct CalvadosComponents {
    /// Number of molecules of all components.
    std::int64_t molecules = 0;
    /// True if a component has restraints within its domains.
    bool restrained = false;
    /// True if all components are proteins.
    bool proteins = true;
    /// Number of HarmonicBondForces and CustomBondForces that the components make.
    std::int64_t harmonic_forces = 0, custom_forces = 0;
    /// Stiffnesses of bonds and elastic networks, kJ/mol/nm2.
    std::set<double> stiffness;
};

/// Reads components.yaml. Throws InputError for one without components and for values of the wrong
/// kind.
CalvadosComponents read_components(std::string const& file);

/// Throws InputError if the topology does not have one chain for each molecule. It may have more if
/// molecules may be complexes of several chains.
void refuse_other_molecules(CalvadosComponents const& components, Files const& files);

}  // namespace catena::foreign
