// Distance constraints of a System as chains of beads on links.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace catena::plugin {

/// Distance constraint between two particles, nm.
struct Constraint {
    int first = 0, second = 0;
    double distance = 0;
};

/// Chains of a set of constraints, as a scene without positions, and the particle of every bead.
struct ConstraintChains {
    Scene scene;
    /// Particle of each bead, in the order of the scene.
    std::vector<std::int64_t> particle;
};

/// Sorts constraints into chains, rings and trees; those that close further loops become
/// cross-links. `mass`: mass of each particle, amu. Throws InputError if a constrained distance is
/// not positive.
ConstraintChains constraint_chains(std::vector<double> const& mass,
                                   std::vector<Constraint> const& constraints);

}  // namespace catena::plugin
