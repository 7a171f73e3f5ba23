// Which beads lie near others: the search that every list of ghosts is made by. No OpenMM here, and
// no messages.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "math/executor.hpp"
#include "math/linear.hpp"
#include "neighbours/point_blocks.hpp"

namespace catena {

/// Of each group 1 where one of its points lies within `radius` of one of `others`, however these
/// are grouped, else 0. `box`: edges of the periodic box (nearest images). Preconditions: radius >
/// 0, positions finite.
std::vector<char> near_groups(PointGroups const& groups, PointGroups const& others, double radius,
                              std::optional<Vec3> const& box, Executor const&);

/// Indices, ascending, of the `points` that lie within `radius` of one of `others`; the rest as
/// above.
std::vector<std::int64_t> near_any(std::span<Vec3 const> points, std::span<Vec3 const> others,
                                   double radius, std::optional<Vec3> const& box);

/// Beads that are not among `own` and lie within `radius` of one of these, ascending.
std::vector<std::int64_t> ghosts_of(std::span<Vec3 const> positions,
                                    std::span<std::int64_t const> own, double radius,
                                    std::optional<Vec3> const& box);

/// The largest distance between a bead's two positions.
double largest_displacement(std::span<Vec3 const> from, std::span<Vec3 const> to);

}  // namespace catena
