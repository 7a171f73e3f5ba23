// Points that follow each other mostly lie together, as beads of a chain do: in blocks, each with a
// box around it, which decides for all of them at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/linear.hpp"

namespace catena {

/// Groups [begin, end), and the box around their points.
struct PointBlock {
    Vec3 middle, half;
    std::int64_t begin, end;

    Vec3 least() const { return middle - half; }
    Vec3 most() const { return middle + half; }
};

/// Points in groups that follow each other: group g has points [first[g], first[g + 1]).
struct PointGroups {
    std::span<Vec3 const> points;
    std::span<std::int64_t const> first;  // of each group, then the number of points

    std::int64_t size() const { return std::ssize(first) - 1; }
    std::span<Vec3 const> group(std::int64_t g) const {
        return points.subspan(begin(g), begin(g + 1) - begin(g));
    }
    std::span<Vec3 const> of(PointBlock const& b) const {
        return points.subspan(begin(b.begin), begin(b.end) - begin(b.begin));
    }
    std::size_t begin(std::int64_t g) const {
        return static_cast<std::size_t>(first[static_cast<std::size_t>(g)]);
    }
};

/// All groups that have points, in blocks of up to 32 points within boxes of up to `edge` along
/// each axis; a group alone may be larger.
std::vector<PointBlock> blocks_of(PointGroups const& groups, double edge);

}  // namespace catena
