// Self-avoiding linkers between two given points.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

/// A linker to be grown: `beads` new points between two given ones, on links of equal length.
struct Linker {
    Vec3 from = Vec3::zero(), to = Vec3::zero();
    std::int64_t beads = 0;
    double length = 0;    // of each of the beads + 1 links
    double excluded = 0;  // smallest distance of points that are not neighbours
};

/// Returns the linker's points, without its two ends. Points keep the excluded distance from each
/// other, from both ends and from `others`, which must not hold the ends. The walk grows from
/// `from`, always near enough to `to`, and steps back when no place is free. Returns no points if
/// it finds no way. The result depends on the arguments alone. Preconditions: the ends are at most
/// beads + 1 links apart, and excluded < 2 length.
std::vector<Vec3> grow_linker(Linker const& linker, std::span<Vec3 const> others,
                              std::uint64_t seed);

}  // namespace catena::scene
