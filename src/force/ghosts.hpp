// Which beads lie near others: the search that every list of ghosts is made by. No OpenMM here, and no messages.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "dca/executor.hpp"
#include "dca/linear.hpp"

namespace catena {

/// Indices, ascending, of the `points` that lie within `radius` of one of `others`. `box`: edges of the periodic box (nearest images).
/// What is near one of `points` is found from either side alike. Preconditions: radius > 0, positions finite.
std::vector<std::int64_t> near_any(std::span<Vec3 const> points, std::span<Vec3 const> others, double radius,
                                   std::optional<Vec3> const& box);

/// Both at once: those of `one` near some of `other`, and the other way round.
struct NearEachOther {
    std::vector<std::int64_t> one, other;
};
NearEachOther near_each_other(std::span<Vec3 const> one, std::span<Vec3 const> other, double radius, std::optional<Vec3> const& box,
                              Executor const&);

/// Beads that are not among `own` and lie within `radius` of one of these, ascending.
std::vector<std::int64_t> ghosts_of(std::span<Vec3 const> positions, std::span<std::int64_t const> own, double radius,
                                    std::optional<Vec3> const& box);

/// The largest distance between a bead's two positions.
double largest_displacement(std::span<Vec3 const> from, std::span<Vec3 const> to);

}  // namespace catena
