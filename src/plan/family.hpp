// Families of chains whose evaluations take the same time per body: keys of the measured times, and
// the random chains that represent a scene in measurements.
#pragma once

#include <string>
#include <vector>

#include "chain/chain_group.hpp"
#include "generate/generators.hpp"

namespace catena::plan {

/// The properties of a group, apart from its number of bodies, that determine the time of an
/// evaluation.
struct Family {
    scene::RandomJoint joint{};
    /// True for rigid bodies among beads on links.
    bool linked = false;
    Axes axes = Axes::joint;
    Handles handles = Handles::projected;

    /// True for chains of beads without rigid bodies.
    bool beads() const { return joint == scene::RandomJoint::link && !linked; }
    /// Returns for example "revolute", "spherical, ground axes" or "link, full handles".
    std::string name() const;
};
/// Returns every family that can occur.
std::vector<Family> all_families();

/// A group of the scene's chains (make_groups): its family, and the numbers of bodies and merges of
/// the rank that has the most.
struct Share {
    Family family;
    std::int64_t bodies = 0;
    /// Number of merges on each level of the pairwise tree.
    std::vector<std::int64_t> merges;
};
/// Returns one share per group of the scene on the given number of ranks.
std::vector<Share> shares_of(Scene const&, Axes, int ranks);

/// Returns a scene of one random chain of the family with the family's handles. Equal arguments
/// give equal chains on every machine.
Scene sample(Family const&, std::int64_t bodies);

}  // namespace catena::plan
