// Kinds of chains whose evaluations take alike: what a scene's times are looked up by, and the
// random chains that stand for it.
#pragma once

#include <string>
#include <vector>

#include "chain/chain_group.hpp"
#include "generate/generators.hpp"

namespace catena::plan {

/// What decides how long an evaluation of a group takes, its number of bodies aside.
struct Family {
    scene::RandomJoint joint{};
    bool linked = false;  // rigid bodies among beads on links
    Axes axes = Axes::joint;
    Handles handles = Handles::projected;

    /// Alone: without rigid bodies.
    bool beads() const { return joint == scene::RandomJoint::link && !linked; }
    /// "revolute", "spherical, ground axes", "link, full handles"
    std::string name() const;
};
/// Every one there is.
std::vector<Family> all_families();

/// A group of the scene's chains (make_groups): its family, and the bodies and merges of the rank
/// that has the most.
struct Share {
    Family family;
    std::int64_t bodies = 0;
    std::vector<std::int64_t> merges;  // of the pairwise tree, level by level
};
std::vector<Share> shares_of(Scene const&, Axes, int ranks);

/// One random chain of the family, the same for the same arguments everywhere. Solver: the family's
/// handles.
Scene sample(Family const&, std::int64_t bodies);

}  // namespace catena::plan
