// Changes that a scene makes to the forces of its builder or System: added, left out, made links.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.hpp"

namespace catena {

/// Changes of the forces of `forces.openmm`. They are kept in OpenMmSpec::map, under names that no
/// chain can have.
struct ForceChanges {
    /// Serialised forces (XML) that are added, resolved paths.
    std::vector<std::string> extra;
    /// Names or kinds of forces of the System that do not count.
    std::vector<std::string> leave_out;
    /// Names or kinds of CustomBondForces with the length of the rigid links that replace their
    /// bonds between neighbours in a chain, nm.
    std::vector<std::pair<std::string, double>> links;
};

/// Adds the changes to those of the spec.
void add_changes(ForceChanges const&, OpenMmSpec&);
/// Returns the changes of the spec, each list in the order in which it was added.
ForceChanges changes_of(OpenMmSpec const&);

using ChainMap = std::vector<std::pair<std::string, std::pair<std::int64_t, std::int64_t>>>;
/// Returns the entries of OpenMmSpec::map that name chains.
ChainMap chain_map(OpenMmSpec const&);

}  // namespace catena
