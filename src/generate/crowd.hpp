// Chains of beads in a dense periodic box without room for separate places: grown into it, then
// relaxed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

/// Coordinates along one axis that walls leave to a chain; all of them by default.
struct Range {
    double low = -std::numeric_limits<double>::infinity(),
           high = std::numeric_limits<double>::infinity();

    bool is_bounded() const { return low > -std::numeric_limits<double>::infinity(); }
    /// Distance of a coordinate beyond the range; at most 0 within it.
    double beyond(double at) const { return std::max(low - at, at - high); }
};
/// Ranges along the three axes.
using Walls = std::array<Range, 3>;

/// Beads of all chains, one chain after the other, then fixed points.
struct Crowd {
    /// Edges of the periodic box.
    Vec3 box = Vec3::zero();
    /// Smallest distance of beads that are not link neighbours.
    double excluded = 0;
    /// Positions, not wrapped into the box.
    std::vector<Vec3> at;
    /// Length of the link to the point on which each point hangs; 0 if there is none.
    std::vector<double> length;
    /// Index of the first bead of each chain, and the end of the last chain.
    std::vector<std::size_t> first;
    /// Walls of each chain; empty if no chain has any.
    std::vector<Walls> walls = {};
    /// Point on which each point hangs, with a smaller number; -1 for the first of each chain and
    /// for fixed points. Empty if no chain branches: each point then hangs on the preceding one.
    std::vector<std::int64_t> parent = {};

    std::size_t chains() const { return first.size() - 1; }
    /// Number of beads that belong to chains; points from there on are fixed.
    std::size_t movable() const { return first.back(); }
    Range range(std::size_t chain, int axis) const {
        return walls.empty() ? Range() : walls[chain][static_cast<std::size_t>(axis)];
    }
    /// Distance of a point beyond the walls of a chain, the largest of the three axes; 0 within
    /// them.
    double outside(std::size_t chain, Vec3 const& point) const {
        double most = 0;
        for (int axis = 0; axis < 3 && !walls.empty(); ++axis)
            most = std::max(most, range(chain, axis).beyond(point[axis]));
        return most;
    }
    /// Point on which point i of a chain hangs. Precondition: i is not the chain's first.
    std::size_t inboard(std::size_t i) const {
        return parent.empty() ? i - 1 : static_cast<std::size_t>(parent[i]);
    }
    /// True if a link joins points i and j.
    bool linked(std::size_t i, std::size_t j) const {
        if (!parent.empty())
            return parent[std::max(i, j)] == static_cast<std::int64_t>(std::min(i, j));
        return i < j ? j - i == 1 && length[j] > 0 : i - j == 1 && length[i] > 0;
    }
};

/// Places the beads of every chain along random walks from random points of the box. Beads keep the
/// excluded distance from all points; a walk steps back when no place is free. If that fails, the
/// bead is placed with the least overlap. All chains grow at the same pace, so that none meets a
/// full box. Walks keep within the walls. The result depends on the arguments alone. Precondition:
/// edges of at least 2.5 excluded distances; links of at least half of the excluded distance.
void grow(Crowd& crowd, std::uint64_t seed);

/// Result of a relaxation.
struct Relaxed {
    std::int64_t steps = 0;
    std::int64_t overlaps = 0;  // pairs closer than the excluded distance
    double nearest = 0;         // distance of the closest such pair
    std::int64_t outside = 0;   // beads beyond their walls
};

/// Separates beads that are too close by forces with a cap. Each step ends with the projection of
/// the links to their lengths (relative error 1e-13, as far as the positions' rounding allows).
/// Beads beyond their walls are moved back. Stops when no pair is closer than the excluded distance
/// and no bead is outside, or after `most_steps` steps.
Relaxed relax(Crowd& crowd, std::int64_t most_steps);

}  // namespace catena::scene
