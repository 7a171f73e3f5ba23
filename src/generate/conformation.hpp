// Where the beads of a link chain stand at the start.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "math/linear.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Planar zig-zag along x with bond angles of 120 degrees, from the origin. Not straight: a
/// straight chain under forces along itself would never bend without noise, and its link matrix is
/// the worst conditioned one.
std::vector<Vec3> extended_conformation(std::int64_t points, double length);

/// Random walk from the origin whose points, neighbours apart, stay `excluded` or more from each
/// other (excluded < 2 length); grown point by point, stepping back where it is stuck. O(points); a
/// function of its arguments alone.
std::vector<Vec3> self_avoiding_conformation(std::int64_t points, double length, double excluded,
                                             std::uint64_t seed);

/// Sets each link's `length` to the distance of its ends (entry 0: to the anchor of a fixed base,
/// else 0).
void take_lengths(BeadArrays& beads, Base base);

/// First bead, from 0, that stands on its inboard neighbour (entry 0: on the anchor of a fixed
/// base) as far as rounding can tell; -1: none does.
std::int64_t coincident_bead(BeadArrays const& beads, Base base);

}  // namespace catena::scene
