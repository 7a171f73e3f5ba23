// Neighbour search used to build ghost lists. It depends neither on OpenMM nor on communication.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/executor.hpp"
#include "math/linear.hpp"
#include "neighbours/point_blocks.hpp"

namespace catena {

/// Returns 1 for each group with a point within `radius` (nm) of a point of `others`, else 0. The
/// grouping of `others` does not affect the result. `box`: edges of the periodic box (nearest
/// images). Preconditions: radius > 0, positions finite.
std::vector<char> near_groups(PointGroups const& groups, PointGroups const& others, double radius,
                              std::optional<Vec3> const& box, Executor const&);

/// Returns the ascending indices of the `points` within `radius` of one of `others`. Preconditions
/// as near_groups().
std::vector<std::int64_t> near_any(std::span<Vec3 const> points, std::span<Vec3 const> others,
                                   double radius, std::optional<Vec3> const& box);

/// Returns the ascending indices of beads not in `own` that lie within `radius` of a bead in `own`.
std::vector<std::int64_t> ghosts_of(std::span<Vec3 const> positions,
                                    std::span<std::int64_t const> own, double radius,
                                    std::optional<Vec3> const& box);

/// Returns the largest distance between corresponding positions.
double largest_displacement(std::span<Vec3 const> from, std::span<Vec3 const> to);

}  // namespace catena
