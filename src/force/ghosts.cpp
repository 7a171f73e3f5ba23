#include "force/ghosts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>

#include "force/cells.hpp"
#include "force/grid.hpp"

namespace catena {

namespace {

/// Cells around one, axis by axis: how far apart the points of two cells are at least and at most.
struct Offset {
    std::int64_t cells;
    double least, most;  // squared
};

/// The nearest first; where they would go around the box, each cell once.
std::vector<Offset> offsets(Grid const& grid, int axis, double radius) {
    double const edge = grid.edge()[axis], slack = 1e-9 * radius;  // however a point's cell is rounded
    auto const width = static_cast<std::int64_t>(std::ceil(radius / edge));
    std::int64_t const count = grid.ends() ? grid.cells()[axis] : 0;
    std::vector<Offset> all;
    auto const add = [&](std::int64_t d) {
        double const apart = static_cast<double>(std::abs(d)), least = std::max(0.0, (apart - 1) * edge - slack),
                     most = (apart + 1) * edge + slack;
        all.push_back({d, least * least, most * most});
    };
    bool const around = count > 0 && 2 * width + 1 >= count;
    std::int64_t const down = around ? (count - 1) / 2 : width, up = around ? count / 2 : width;
    add(0);
    for (std::int64_t d = 1; d <= up; ++d) {
        add(d);
        if (d <= down) add(-d);
    }
    return all;
}

/// The cells of some points, row by row along z.
class Rows {
  public:
    explicit Rows(std::vector<Cell> const& cells) : cells_(cells) {
        for (std::size_t i = 0; i < cells.size(); ++i)
            if (i == 0 || cells[i][0] != cells[i - 1][0] || cells[i][1] != cells[i - 1][1]) begin_.push_back(i);
    }
    /// Cells [first, last) of that row.
    std::pair<std::size_t, std::size_t> row(std::int64_t x, std::int64_t y) const {
        auto const found = std::lower_bound(begin_.begin(), begin_.end(), std::pair(x, y),
                                            [&](std::size_t i, auto const& at) { return std::pair(cells_[i][0], cells_[i][1]) < at; });
        if (found == begin_.end() || cells_[*found][0] != x || cells_[*found][1] != y) return {0, 0};
        return {*found, found + 1 == begin_.end() ? cells_.size() : *(found + 1)};
    }

  private:
    std::vector<Cell> const& cells_;
    std::vector<std::size_t> begin_;
};

/// Which cells of `others` decide about the points of a cell.
class Deciding {
  public:
    Deciding(Grid const& grid, PointsInCells const& others, double radius)
        : grid_(grid),
          others_(others),
          rows_(others.cells()),
          squared_(radius * radius),
          x_(offsets(grid, 0, radius)),
          y_(offsets(grid, 1, radius)),
          z_(offsets(grid, 2, radius)) {}

    /// Whether all points of the cell are near one; if not, `open`: cells with points that may be near some.
    bool all_near(Cell const& cell, std::vector<std::size_t>& open) const {
        open.clear();
        for (Offset const& x : x_)
            for (Offset const& y : y_) {
                if (x.least + y.least >= squared_) continue;
                auto const [first, last] = rows_.row(grid_.wrapped(cell[0] + x.cells, 0), grid_.wrapped(cell[1] + y.cells, 1));
                if (first == last) continue;
                for (Offset const& z : z_) {
                    if (x.least + y.least + z.least >= squared_) continue;
                    std::int64_t const at = grid_.wrapped(cell[2] + z.cells, 2);
                    auto const begin = others_.cells().begin();
                    auto const found =
                        std::lower_bound(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(last), at,
                                         [](Cell const& c, std::int64_t to) { return c[2] < to; });
                    if (found == begin + static_cast<std::ptrdiff_t>(last) || (*found)[2] != at) continue;
                    if (x.most + y.most + z.most < squared_) return true;
                    open.push_back(static_cast<std::size_t>(found - begin));
                }
            }
        return false;
    }

  private:
    Grid const& grid_;
    PointsInCells const& others_;
    Rows rows_;
    double squared_;
    std::vector<Offset> x_, y_, z_;
};

}  // namespace

/// Most points are decided about by their cells alone, which are small for that.
std::vector<std::int64_t> near_any(std::span<Vec3 const> points, std::span<Vec3 const> others, double radius,
                                   std::optional<Vec3> const& box) {
    double constexpr cells_a_radius = 4;
    Grid const grid(radius / cells_a_radius, box);
    PointsInCells const in_cells(grid, points), others_in_cells(grid, others);
    Deciding const deciding(grid, others_in_cells, radius);
    std::vector<std::int64_t> near;
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < in_cells.cells().size(); ++i) {
        bool const all = deciding.all_near(in_cells.cells()[i], open);
        auto const is_near = [&](std::int64_t k) {
            return std::any_of(open.begin(), open.end(), [&](std::size_t cell) {
                auto const there = others_in_cells.points(cell);
                return std::any_of(there.begin(), there.end(),
                                   [&](std::int64_t o) { return grid.squared_distance(points[k], others[o]) < radius * radius; });
            });
        };
        for (std::int64_t const k : in_cells.points(i))
            if (all || is_near(k)) near.push_back(k);
    }
    std::sort(near.begin(), near.end());
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
