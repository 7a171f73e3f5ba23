// Grid of cells wider than a given radius: all neighbours of a point within that radius lie in its
// cell or in one of the 26 adjacent cells.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_set>
#include <vector>

#include "math/linear.hpp"

namespace catena {

/// Integer coordinates of a cell.
using Cell = std::array<std::int64_t, 3>;

inline bool is_same(Cell const& a, Cell const& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/// Hash function of cells.
struct CellHash {
    std::size_t operator()(Cell const& c) const {
        std::uint64_t h = 0;
        for (std::int64_t i : c)
            h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
        return h;
    }
};

using CellSet = std::unordered_set<Cell, CellHash>;

/// Grid over a periodic box or over unbounded space.
class Grid {
  public:
    /// `radius` is the least width of a cell, nm. `box` has the edges of the periodic box; without
    /// it, space is unbounded. Precondition: radius > 0.
    Grid(double radius, std::optional<Vec3> const& box) : box_(box) {
        // The factor keeps cells wider than the radius in spite of rounding.
        double const width = radius * (1 + 1e-9);
        for (int i = 0; i < 3; ++i) {
            count_[i] = box ? std::max<std::int64_t>(
                                  1, static_cast<std::int64_t>(std::floor((*box)[i] / width)))
                            : 0;
            edge_[i] = box ? (*box)[i] / static_cast<double>(count_[i]) : width;
            a_box_[i] = box ? 1 / (*box)[i] : 0;
        }
    }

    /// Edges of a cell, nm.
    Vec3 const& edge() const { return edge_; }
    /// True if space is a periodic box.
    bool ends() const { return box_.has_value(); }
    /// Number of cells along each edge of the box. Precondition: ends().
    Cell const& cells() const { return count_; }

    /// Cell that contains x, wrapped into the box.
    Cell cell(Vec3 const& x) const {
        Cell c = unwrapped(x);
        for (int i = 0; i < 3; ++i) c[i] = wrapped(c[i], i);
        return c;
    }

    /// Midpoint of a cell, nm.
    Vec3 middle(Cell const& c) const {
        Vec3 x;
        for (int i = 0; i < 3; ++i) x[i] = (static_cast<double>(c[i]) + 0.5) * edge_[i];
        return x;
    }

    /// Calls visit(cell) for the cell and its 26 neighbours. In a small box some cells occur more
    /// than once.
    template <class Visit>
    void around(Cell const& c, Visit visit) const {
        for (std::int64_t x = -1; x <= 1; ++x)
            for (std::int64_t y = -1; y <= 1; ++y)
                for (std::int64_t z = -1; z <= 1; ++z)
                    visit(Cell{wrapped(c[0] + x, 0), wrapped(c[1] + y, 1), wrapped(c[2] + z, 2)});
    }

    /// Returns the cells together with all their neighbours.
    template <class Cells>
    CellSet with_surroundings(Cells const& cells) const {
        CellSet all;
        for (Cell const& c : cells) around(c, [&](Cell const& near) { all.insert(near); });
        return all;
    }

    /// Returns the shortest periodic image of a vector.
    Vec3 nearest_image(Vec3 d) const {
        if (box_)
            for (int i = 0; i < 3; ++i) d[i] -= (*box_)[i] * std::nearbyint(d[i] * a_box_[i]);
        return d;
    }
    /// Squared distance of nearest images, nm^2. The result for (a, b) and (b, a) is the same to
    /// the bit.
    double squared_distance(Vec3 const& a, Vec3 const& b) const {
        Vec3 const d = nearest_image(a - b);
        return dot(d, d);
    }
    /// Calls visit(cell) for all cells that intersect the box [least, most]. In a small periodic
    /// box some cells occur more than once.
    template <class Visit>
    void within(Vec3 const& least, Vec3 const& most, Visit visit) const {
        Cell const a = unwrapped(least), b = unwrapped(most);
        for (std::int64_t x = a[0]; x <= b[0]; ++x)
            for (std::int64_t y = a[1]; y <= b[1]; ++y)
                for (std::int64_t z = a[2]; z <= b[2]; ++z)
                    visit(Cell{wrapped(x, 0), wrapped(y, 1), wrapped(z, 2)});
    }

    /// Coordinate of a cell along an axis, wrapped into the periodic box if there is one.
    std::int64_t wrapped(std::int64_t c, int axis) const {
        if (count_[axis] == 0) return c;
        std::int64_t const r = c % count_[axis];
        return r < 0 ? r + count_[axis] : r;
    }

  private:
    Cell unwrapped(Vec3 const& x) const {
        double constexpr far = 1e15;  // integer coordinates are still distinct there
        Cell c{};
        for (int i = 0; i < 3; ++i)
            c[i] = static_cast<std::int64_t>(std::clamp(std::floor(x[i] / edge_[i]), -far, far));
        return c;
    }

    std::optional<Vec3> box_;
    Vec3 edge_{}, a_box_{};  // a_box_: 1 / edge of the box, 1/nm
    Cell count_{};
};

}  // namespace catena
