// Rigid domains of a chain of residues: `rigid: [[first, last], ...]`.
#pragma once

#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// First and last bead of a domain, from 0, both included.
struct Domain {
    std::size_t first = 0, last = 0;
    std::string name = {};  // "residues 5 to 30", as the scene numbers them
};

/// The list in ascending order. The scene numbers the residues by `labels`, one each, such as a
/// file's "52A"; without labels from 1 to `residues`. InputError for domains outside the chain, of
/// fewer than three residues, or that overlap.
std::vector<Domain> read_domains(Node const& rigid, std::size_t residues,
                                 std::vector<std::string> const& labels = {});

/// The beads of each domain become one rigid body with their mass, centre of mass and inertia, in
/// principal axes, which carries them and is linked at its first and last bead; the other beads
/// stay points. InputError for beads on one line.
LinkedArrays with_domains(BeadArrays const& beads, std::vector<Domain> const& domains,
                          Node const& rigid);

}  // namespace catena::scene
