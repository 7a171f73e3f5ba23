// Rigid domains of a chain of residues: `rigid: [[first, last], ...]`.
#pragma once

#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// First and last bead of a domain, from 0, both included.
struct Domain {
    std::size_t first = 0, last = 0;
    std::string name = {};  // "residues 5 to 30", in the scene's numbering
};

/// Returns the domains in ascending order. `labels` holds the scene's number of each residue, such
/// as a file's "52A". Without labels the residues are numbered from 1 to `residues`. Throws
/// InputError for domains outside the chain, with fewer than three residues, or that overlap.
std::vector<Domain> read_domains(Node const& rigid, std::size_t residues,
                                 std::vector<std::string> const& labels = {});

/// Merges the beads of each domain into one rigid body with their mass, centre of mass and inertia.
/// The body's axes are the principal axes. It carries the beads and is linked at its first and last
/// bead. The other beads stay points. Throws InputError if the beads of a domain lie on one line.
LinkedArrays with_domains(BeadArrays const& beads, std::vector<Domain> const& domains,
                          Node const& rigid);

}  // namespace catena::scene
