#include "force/ghosts.hpp"

#include <algorithm>
#include <cmath>

#include "force/grid.hpp"

namespace catena {

std::vector<std::int64_t> near_any(std::span<Vec3 const> points, std::span<Vec3 const> others, double radius,
                                   std::optional<Vec3> const& box) {
    Grid const grid(radius, box);
    CellMap cells;
    for (std::int64_t i = 0; i < std::ssize(others); ++i) cells[grid.cell(others[i])].push_back(i);
    auto const holds_a_near_one = [&](Cell const& cell, Vec3 const& point) {
        auto const found = cells.find(cell);
        return found != cells.end() && std::any_of(found->second.begin(), found->second.end(), [&](std::int64_t i) {
                   return grid.squared_distance(point, others[i]) < radius * radius;
               });
    };
    std::vector<std::int64_t> near;
    for (std::int64_t k = 0; k < std::ssize(points); ++k) {
        bool is_near = false;
        grid.around(grid.cell(points[k]), [&](Cell const& cell) { is_near = is_near || holds_a_near_one(cell, points[k]); });
        if (is_near) near.push_back(k);
    }
    return near;
}

std::vector<std::int64_t> ghosts_of(std::span<Vec3 const> positions, std::span<std::int64_t const> own, double radius,
                                    std::optional<Vec3> const& box) {
    std::vector<bool> is_own(positions.size(), false);
    std::vector<Vec3> inside, outside;
    for (std::int64_t const k : own) {
        is_own[k] = true;
        inside.push_back(positions[k]);
    }
    std::vector<std::int64_t> bead;  // of `outside`
    for (std::int64_t k = 0; k < std::ssize(positions); ++k) {
        if (is_own[k]) continue;
        outside.push_back(positions[k]);
        bead.push_back(k);
    }
    std::vector<std::int64_t> ghosts = near_any(outside, inside, radius, box);
    for (std::int64_t& k : ghosts) k = bead[k];
    return ghosts;
}

double largest_displacement(std::span<Vec3 const> from, std::span<Vec3 const> to) {
    double largest = 0;
    for (std::size_t k = 0; k < from.size(); ++k) {
        Vec3 const d = to[k] - from[k];
        largest = std::max(largest, dot(d, d));
    }
    return std::sqrt(largest);
}

}  // namespace catena
