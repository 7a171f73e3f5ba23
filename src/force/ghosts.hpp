// Which beads of other ranks a rank needs: those near its own. No OpenMM here.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dca/linear.hpp"

namespace catena {

/// Beads that are not among `own` and lie within `radius` of one of these, ascending. `box`: edges of the periodic box (nearest images).
/// Preconditions: radius > 0, positions finite.
std::vector<std::int64_t> ghosts_of(std::span<Vec3 const> positions, std::span<std::int64_t const> own, double radius,
                                    std::optional<Vec3> const& box);

/// The largest distance between a bead's two positions.
double largest_displacement(std::span<Vec3 const> from, std::span<Vec3 const> to);

}  // namespace catena
