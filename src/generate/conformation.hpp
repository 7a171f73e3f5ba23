// Start positions of the beads of a link chain.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "math/linear.hpp"
#include "scene/branches.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Excluded distance of self-avoiding chains. Closer pairs of CALVADOS beads repel each other by
/// several kT (mean diameters are 0.45 to 0.68 nm).
inline constexpr double excluded_distance = 0.56;  // nm
/// Largest excluded distance of self-avoiding chains, relative to their links: bond angles are then
/// above 97 degrees.
inline constexpr double widest_exclusion = 1.5;

/// Planar zig-zag along x with bond angles of 120 degrees, from the origin. A straight chain is
/// avoided: under forces along itself it would never bend without noise. Its link matrix is also
/// the worst conditioned one.
std::vector<Vec3> extended_conformation(std::int64_t points, double length);

/// Random walk from the origin. Points that are not neighbours keep the distance `excluded` or more
/// (precondition: excluded < 2 length). The walk grows point by point and steps back when no place
/// is free. Cost is O(points); the result depends on the arguments alone.
std::vector<Vec3> self_avoiding_conformation(std::int64_t points, double length, double excluded,
                                             std::uint64_t seed);

/// Sets each link's `length` to the distance of its ends (entry 0: to the anchor of a fixed base,
/// else 0).
void take_lengths(BeadArrays& beads, Base base, Parents parents = {});

/// Returns the first bead (from 0) that coincides with its inboard neighbour within rounding. Entry
/// 0 is compared with the anchor of a fixed base. Returns -1 if no bead coincides.
std::int64_t coincident_bead(BeadArrays const& beads, Base base, Parents parents = {});

}  // namespace catena::scene
