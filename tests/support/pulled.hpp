// Scenes whose beads are pulled by constant forces.
#pragma once

#include <utility>

#include "terms/constant_force.hpp"

namespace catena::test {

/// Pulls every third bead of each chain, in directions that differ from bead to bead.
inline Scene pulled(Scene scene) {
    for (ChainSpec& chain : scene.chains)
        for (std::size_t k = 0; k < chain.size(); k += 3) {
            double* const force = terms::numbers_for(chain, terms::ConstantForce::name, 3, k);
            auto const x = static_cast<double>(k % 200);  // no larger on long chains
            force[0] = 3 - 0.01 * x;
            force[1] = k % 2 == 0 ? 2.5 : -1.75;
            force[2] = 1 / (1 + x);
        }
    return scene;
}

}  // namespace catena::test
