// All keys that the CALVADOS package reads, and what an import does with each of them.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "foreign/package_file.hpp"

namespace catena::foreign {

/// Use that an import makes of a key.
enum class KeyUse {
    compared,  // with the System or the topology: another value is refused
    taken,     // over into the scene, or noted
    barostat,  // not taken over: the scene has a constant volume
    start,     // not taken over: the topology has the start
    program,   // not taken over: how the package runs
    origin,    // not compared: the System has what the package made of it
};

/// A key of config.yaml or of a component.
struct PackageKey {
    std::string_view name;
    KeyUse use;
    /// Kind of molecules or restraints for which the key counts; empty: for all.
    std::string_view only_for = {};
};

/// Keys of config.yaml in versions 0.1 to 1.0 of the package, in alphabetical order.
std::span<PackageKey const> config_keys();
/// Properties of components, in alphabetical order.
std::span<PackageKey const> component_keys();

/// Notes keys that the package does not know, those that are neither compared nor taken over, and
/// numbers that the package takes for texts.
/// `components` is nullptr without a components.yaml. `system` is the System's name.
void note_keys(PackageFile const& config, PackageFile const* components, std::string const& system,
               std::vector<std::string>& notes);

}  // namespace catena::foreign
