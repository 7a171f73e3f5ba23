#include "force/ghosts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace catena {

namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(Cell const& c) const {
        std::uint64_t h = 0;
        for (std::int64_t i : c) h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
        return h;
    }
};

/// Cells with edges of at least `radius`: what is near a point lies in its cell or in one of the 26 around it.
class Grid {
  public:
    Grid(double radius, std::optional<Vec3> const& box) : box_(box) {
        for (int i = 0; i < 3; ++i) {
            count_[i] = box ? std::max<std::int64_t>(1, static_cast<std::int64_t>(std::floor((*box)[i] / radius))) : 0;
            edge_[i] = box ? (*box)[i] / static_cast<double>(count_[i]) : radius;
        }
    }

    Cell cell(Vec3 const& x) const {
        Cell c{};
        for (int i = 0; i < 3; ++i) c[i] = wrapped(static_cast<std::int64_t>(std::floor(x[i] / edge_[i])), i);
        return c;
    }

    template <class Visit>
    void around(Cell const& c, Visit visit) const {
        for (std::int64_t x = -1; x <= 1; ++x)
            for (std::int64_t y = -1; y <= 1; ++y)
                for (std::int64_t z = -1; z <= 1; ++z) visit(Cell{wrapped(c[0] + x, 0), wrapped(c[1] + y, 1), wrapped(c[2] + z, 2)});
    }

    double squared_distance(Vec3 const& a, Vec3 const& b) const {
        Vec3 d = a - b;
        if (box_)
            for (int i = 0; i < 3; ++i) d[i] -= (*box_)[i] * std::round(d[i] / (*box_)[i]);
        return dot(d, d);
    }

  private:
    std::int64_t wrapped(std::int64_t c, int axis) const {
        if (count_[axis] == 0) return c;
        std::int64_t const r = c % count_[axis];
        return r < 0 ? r + count_[axis] : r;
    }

    std::optional<Vec3> box_;
    Vec3 edge_{};
    Cell count_{};
};

}  // namespace

std::vector<std::int64_t> ghosts_of(std::span<Vec3 const> positions, std::span<std::int64_t const> own, double radius,
                                    std::optional<Vec3> const& box) {
    std::vector<std::int64_t> ghosts;
    if (own.empty()) return ghosts;
    Grid const grid(radius, box);
    std::vector<bool> is_own(positions.size(), false);
    std::unordered_map<Cell, std::vector<std::int64_t>, CellHash> near;  // own beads in and around each cell
    for (std::int64_t const k : own) {
        is_own[k] = true;
        grid.around(grid.cell(positions[k]), [&](Cell const& c) {
            auto& beads = near[c];
            if (beads.empty() || beads.back() != k) beads.push_back(k);
        });
    }
    for (std::int64_t k = 0; k < std::ssize(positions); ++k) {
        if (is_own[k]) continue;
        auto const beads = near.find(grid.cell(positions[k]));
        if (beads == near.end()) continue;
        bool const is_near = std::any_of(beads->second.begin(), beads->second.end(), [&](std::int64_t inside) {
            return grid.squared_distance(positions[k], positions[inside]) < radius * radius;
        });
        if (is_near) ghosts.push_back(k);
    }
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
