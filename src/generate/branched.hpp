// Branched chains of beads from a few numbers: stars, brushes, dendrimers and random trees.
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "generate/generators.hpp"

namespace catena::scene {

/// Arms that hang on bead 1. Beads are numbered arm by arm, outward.
struct Star {
    std::int64_t arms = 3, arm_length = 1;
};
/// Side chains on every `every`-th bead of a backbone, from its first bead on. The backbone's beads
/// come first, then the side chains one by one, outward.
struct Brush {
    std::int64_t backbone = 1, side_length = 1, every = 1;
};
/// Regular tree around bead 1. `functionality` segments meet at bead 1 and at each branch point;
/// a segment has `spacer` beads and ends in a branch point, or in an end of the tree after
/// `generations` segments. Beads are numbered generation by generation, segment by segment.
struct Dendrimer {
    std::int64_t generations = 1, functionality = 3, spacer = 0;
};
/// Each bead hangs on an earlier one, which is drawn from all that carry fewer than `max_children`.
struct RandomTree {
    std::int64_t beads = 1, max_children = 2;
};
using BranchedShape = std::variant<Star, Brush, Dendrimer, RandomTree>;

/// Number of beads; a double, because it may exceed all integers.
double beads_of(BranchedShape const& shape);
/// Bead on which each bead hangs, as ChainSpec::parent but also for unbranched shapes. `seed`
/// decides random trees alone.
std::vector<std::int64_t> inboard_beads(BranchedShape const& shape, std::uint64_t seed);

/// Overlaps that a start leaves: their number, and the smallest distance of two beads.
struct Overlaps {
    std::int64_t count = 0;
    double nearest = 0;
};

/// Place from which a tree grows.
struct TreeRoot {
    Base base = Base::free;
    Vec3 anchor = Vec3::zero();
    std::uint64_t seed = 0;
};

/// Gives the beads a random start, each at its link's length from the bead that `inboard` names.
/// Beads that no link joins keep the distance `excluded` (0: any). The tree grows bead by bead and
/// steps back where no place is free. After as many steps back as it has beads, it takes the places
/// with the least overlap. Such overlaps are relaxed if at most a quarter of the beads has one.
/// Returns those that are left. The result depends on the arguments alone.
Overlaps grow_tree(BeadArrays& beads, TreeRoot const& root,
                   std::vector<std::int64_t> const& inboard, double excluded);

}  // namespace catena::scene
