// Periodic box divided into cells, so that the neighbours of a point lie in the cells around it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "math/linear.hpp"

namespace catena::scene {

/// Periodic images of a rectangular box.
class Images {
  public:
    explicit Images(Vec3 const& box) : edge_(box), inverse_{{1 / box[0], 1 / box[1], 1 / box[2]}} {}

    Vec3 const& edge() const { return edge_; }
    /// Returns the image of `point` in the box, between 0 and the edges.
    Vec3 wrapped(Vec3 point) const {
        for (int i = 0; i < 3; ++i) point[i] -= edge_[i] * std::floor(point[i] * inverse_[i]);
        return point;
    }
    /// Returns the shortest image of a difference (minimum image convention).
    Vec3 shortest(Vec3 const& apart) const { return apart - whole_edges(apart); }
    /// Returns the difference minus its shortest image: whole edges of the box.
    Vec3 whole_edges(Vec3 const& apart) const {
        Vec3 edges = Vec3::zero();
        for (int i = 0; i < 3; ++i) edges[i] = edge_[i] * std::rint(apart[i] * inverse_[i]);
        return edges;
    }

  private:
    Vec3 edge_, inverse_;
};

/// Cells of at least the width `width`. Their number is at most 16 (8 `points` + 64).
class Cells {
  public:
    Cells(Vec3 const& box, double width, std::size_t points) {
        double const wanted = 8.0 * static_cast<double>(points) + 64;
        double least = std::max(width, std::cbrt(box[0] * box[1] * box[2] / wanted));
        // A box flatter than its cells has one layer of them. It then has more cells in all than
        // its volume implies.
        while (cut(box, least) > 16 * wanted) least *= 2;
    }

    /// Number of cells.
    std::size_t size() const { return static_cast<std::size_t>(count_[0] * count_[1] * count_[2]); }

    /// Index of the cell that contains a point of the box.
    std::size_t of(Vec3 const& wrapped) const {
        return index(at(wrapped, 0), at(wrapped, 1), at(wrapped, 2));
    }

    /// Calls visit(cell) for the cells that hold all points within `width` of a point in the box,
    /// each once. Stops and returns true as soon as visit returns true; returns false otherwise.
    template <class Visit>
    bool any_around(Vec3 const& wrapped, Visit visit) const {
        std::array<Run, 3> const run{around(wrapped, 0), around(wrapped, 1), around(wrapped, 2)};
        for (std::int64_t z = 0; z < run[2].size; ++z)
            for (std::int64_t y = 0; y < run[1].size; ++y)
                for (std::int64_t x = 0; x < run[0].size; ++x)
                    if (visit(index(run[0].cell(x), run[1].cell(y), run[2].cell(z)))) return true;
        return false;
    }

  private:
    /// Up to three consecutive cells along one axis, with periodic wrap.
    struct Run {
        std::int64_t begin, size, count;
        std::int64_t cell(std::int64_t i) const {
            std::int64_t const sum = begin + i;
            return sum < count ? sum : sum - count;
        }
    };

    /// Divides the box into cells of at least the width `width` and returns their number.
    double cut(Vec3 const& box, double width) {
        double cells = 1;
        for (std::size_t i = 0; i < 3; ++i) {
            double const edge = box[static_cast<int>(i)],
                         along = std::max(1.0, std::floor(edge / width));
            cells *= along;
            count_[i] = static_cast<std::int64_t>(std::min(along, 1e15));
            per_length_[i] = static_cast<double>(count_[i]) / edge;
        }
        return cells;
    }
    std::int64_t at(Vec3 const& wrapped, std::size_t axis) const {
        // Rounding may move a point of the last cell one cell too far.
        return std::min(
            static_cast<std::int64_t>(wrapped[static_cast<int>(axis)] * per_length_[axis]),
            count_[axis] - 1);
    }
    Run around(Vec3 const& wrapped, std::size_t axis) const {
        std::int64_t const middle = at(wrapped, axis), n = count_[axis];
        return {middle > 0 ? middle - 1 : n - 1, std::min<std::int64_t>(3, n), n};
    }
    std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const {
        return static_cast<std::size_t>((z * count_[1] + y) * count_[0] + x);
    }

    std::array<std::int64_t, 3> count_{};
    std::array<double, 3> per_length_{};
};

}  // namespace catena::scene
