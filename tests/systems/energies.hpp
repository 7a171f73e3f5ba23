// OpenMM's energies of a scene, term by term.
#pragma once

#include <map>
#include <string>

#include "integrate/chain_system.hpp"
#include "mpi/communicator.hpp"

namespace catena::testing {

/// Returns the energy of each of OpenMM's terms at the start, kJ/mol.
inline std::map<std::string, double> energies_of(Scene const& scene) {
    auto const ranks = serial_communicator();
    ChainSystem system(scene, Axes::joint, *ranks);
    system.evaluate(false);
    std::map<std::string, double> energies;
    for (auto const& [name, value] : system.openmm()->energies()) energies[name] = value;
    return energies;
}

}  // namespace catena::testing
