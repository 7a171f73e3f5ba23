// Points of many that are near to each other.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "math/linear.hpp"

namespace catena::scene {

struct NearPair {
    std::size_t first = 0, second = 0;  // indices of the points, ascending
    double distance = 0;
};

/// The nearest pair among those not further apart than `within` that `counts` lets in (it is asked
/// with ascending indices), by nearest images where there is a box. O(points) while a cube as wide
/// as `within` holds few of them.
std::optional<NearPair> nearest_pair(std::span<Vec3 const> points, std::optional<Vec3> const& box,
                                     double within,
                                     std::function<bool(std::size_t, std::size_t)> const& counts);

/// Calls visit(i, j, x_i - x_j) for all pairs i < j not further apart than `within`, by nearest
/// images where there is a box.
void for_each_near_pair(std::span<Vec3 const> points, std::optional<Vec3> const& box, double within,
                        std::function<void(std::size_t, std::size_t, Vec3 const&)> const& visit);

}  // namespace catena::scene
