// Rigid domains of a chain of residues: `rigid: [[first, last], "A:1-95", ...]`.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// First and last bead of a domain, from 0, both included.
struct Domain {
    std::size_t first = 0, last = 0;
    std::string name = {};  // "residues 5 to 30", in the scene's numbering
};

/// Names of the residues that `rigid` may use.
struct ResidueNumbers {
    /// Number of residues; without labels they are numbered from 1.
    std::size_t residues = 0;
    /// Number of each residue, such as a file's "52A"; empty without a file.
    std::vector<std::string> labels = {};
    /// Chain of each residue: the authors' name and the label; empty without a file.
    std::vector<std::array<std::string, 2>> chains = {};
};

/// Returns the domains in ascending order. Each is a pair [first, last] or a text
/// "CHAIN:FIRST-LAST", where "CHAIN:" may be left out. Throws InputError for domains outside the
/// chain, with fewer than three residues, or that overlap.
std::vector<Domain> read_domains(Node const& rigid, ResidueNumbers const& numbers);

/// Merges the beads of each domain into one rigid body with their mass, centre of mass and inertia.
/// The body's axes are the principal axes. It carries the beads and is linked at its first and last
/// bead. The other beads stay points. Throws InputError if the beads of a domain lie on one line.
LinkedArrays with_domains(BeadArrays const& beads, std::vector<Domain> const& domains,
                          Node const& rigid);

}  // namespace catena::scene
