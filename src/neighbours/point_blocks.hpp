// Blocks of consecutive points with bounding boxes. Consecutive points, such as beads of a chain,
// are mostly near each other, so that one distance test decides for all points of a block.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/linear.hpp"

namespace catena {

/// Block of groups [begin, end) and the bounding box of their points: midpoint and half edges, nm.
struct PointBlock {
    Vec3 middle, half;
    std::int64_t begin, end;

    /// Lower and upper corner of the bounding box, nm.
    Vec3 least() const { return middle - half; }
    Vec3 most() const { return middle + half; }
};

/// Points in consecutive groups: group g has points [first[g], first[g + 1]).
struct PointGroups {
    std::span<Vec3 const> points;
    std::span<std::int64_t const> first;  // first point of each group, then the number of points

    std::int64_t size() const { return std::ssize(first) - 1; }
    /// Points of group g.
    std::span<Vec3 const> group(std::int64_t g) const {
        return points.subspan(begin(g), begin(g + 1) - begin(g));
    }
    /// Points of a block.
    std::span<Vec3 const> of(PointBlock const& b) const {
        return points.subspan(begin(b.begin), begin(b.end) - begin(b.begin));
    }
    std::size_t begin(std::int64_t g) const {
        return static_cast<std::size_t>(first[static_cast<std::size_t>(g)]);
    }
};

/// Returns blocks of all groups that contain points. A block has up to 32 points and a box of up to
/// `edge` along each axis; a single group may exceed both limits.
std::vector<PointBlock> blocks_of(PointGroups const& groups, double edge);

}  // namespace catena
