// The CALVADOS 2 energies summed over pairs, without OpenMM.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "force/openmm_force.hpp"

namespace catena::testing {

struct PairEnergies {
    double ashbaugh_hatch = 0, yukawa = 0;
};

PairEnergies pair_sum(BeadSystem const& beads, OpenMmSpec const& spec,
                      std::vector<Vec3> const& positions);

}  // namespace catena::testing
