// Rigid domains of a chain of beads as bodies with mass and inertia.
#pragma once

#include <string>
#include <vector>

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// First and last bead of a domain, from 0, both included.
struct Domain {
    std::size_t first = 0, last = 0;
    std::string name = {};  // "residues 5 to 30", in the scene's numbering
};

/// Merges the beads of each domain into one rigid body with their mass, centre of mass and inertia.
/// The body's axes are the principal axes. It carries the beads and is linked at its first and last
/// bead. The other beads stay points. Throws InputError if the beads of a domain lie on one line.
LinkedArrays with_domains(BeadArrays const& beads, std::vector<Domain> const& domains,
                          Node const& rigid);

}  // namespace catena::scene
