// Search for pairs of close points.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>

#include "math/linear.hpp"

namespace catena::scene {

/// Two points and their distance.
struct NearPair {
    std::size_t first = 0, second = 0;  // indices of the points, ascending
    double distance = 0;
};

/// Returns the nearest pair within the distance `within` among those accepted by `counts`, which
/// receives ascending indices. Distances are those of nearest images if there is a box. Cost is
/// O(points) if a cube of width `within` holds few points.
std::optional<NearPair> nearest_pair(std::span<Vec3 const> points, std::optional<Vec3> const& box,
                                     double within,
                                     std::function<bool(std::size_t, std::size_t)> const& counts);

/// Calls visit(i, j, x_i - x_j) for all pairs i < j within the distance `within`. Differences are
/// those of nearest images if there is a box.
void for_each_near_pair(std::span<Vec3 const> points, std::optional<Vec3> const& box, double within,
                        std::function<void(std::size_t, std::size_t, Vec3 const&)> const& visit);

}  // namespace catena::scene
