// Chains of beads in a periodic box that is too crowded for places side by side: grown into it,
// then relaxed.
#pragma once

#include <cstdint>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

/// Beads of all chains, one chain after the other, then points that stand still.
struct Crowd {
    Vec3 box = Vec3::zero();
    double excluded = 0;             // beads that are not link neighbours keep this distance
    std::vector<Vec3> at;            // unwrapped
    std::vector<double> length;      // of the link to the point before; 0: there is none
    std::vector<std::size_t> first;  // bead of each chain, and the end of the last

    std::size_t chains() const { return first.size() - 1; }
    std::size_t movable() const { return first.back(); }
    bool linked(std::size_t i, std::size_t j) const {
        return i < j ? j - i == 1 && length[j] > 0 : i - j == 1 && length[i] > 0;
    }
};

/// Puts the beads of every chain along random walks from random points of the box that keep the
/// excluded distance from all that is there, stepping back where they are stuck; where that fails,
/// the bead goes where it overlaps least. All chains grow at one pace, so that none finds the box
/// full. A function of its arguments alone. Precondition: edges of 2.5 excluded distances or more;
/// links shorter than the excluded distance, longer than half of it.
void grow(Crowd& crowd, std::uint64_t seed);

struct Relaxed {
    std::int64_t steps = 0;
    std::int64_t overlaps = 0;  // pairs that are nearer than the excluded distance
    double nearest = 0;         // distance of the nearest such pair
};

/// Pushes beads that are too near apart by forces with a cap, each step followed by the projection
/// of the links to their lengths (1e-13 of them, as far as the positions' rounding allows), until
/// no two are nearer than the excluded distance or `most_steps` are done.
Relaxed relax(Crowd& crowd, std::int64_t most_steps);

}  // namespace catena::scene
