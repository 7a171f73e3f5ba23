#include "force/ghosts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>

#include "force/cells.hpp"
#include "force/grid.hpp"

namespace catena {

namespace {

/// How far apart the points of two cells so many cells apart are at least and at most along an axis, squared.
struct Apart {
    double least, most;
};

/// Along one axis of a grid, the cells whose points may be near those of a cell.
class Window {
  public:
    Window(Grid const& grid, int axis, double radius)
        : count_(grid.ends() ? grid.cells()[axis] : 0), width_(static_cast<std::int64_t>(std::ceil(radius / grid.edge()[axis]))) {
        double const edge = grid.edge()[axis], slack = 1e-9 * radius;  // however a point's cell is rounded
        if (count_ > 0 && 2 * width_ + 1 >= count_) all_ = true;
        for (std::int64_t d = 0; d <= width_; ++d) {
            double const least = std::max(0.0, (static_cast<double>(d) - 1) * edge - slack),
                         most = (static_cast<double>(d) + 1) * edge + slack;
            apart_.push_back({least * least, most * most});
        }
    }
    /// Precondition: b is in the window of a.
    Apart const& apart(std::int64_t a, std::int64_t b) const {
        std::int64_t d = std::abs(a - b);
        if (count_ > 0) d = std::min(d, count_ - d);
        return apart_[static_cast<std::size_t>(d)];
    }
    /// Calls action(first, last) for at most two runs of cells, each cell once.
    template <class Action>
    void runs(std::int64_t a, Action const& action) const {
        if (all_) return action(std::int64_t{0}, count_ - 1);
        std::int64_t const first = a - width_, last = a + width_;
        if (count_ > 0 && first < 0) action(first + count_, count_ - 1);
        action(count_ > 0 ? std::max<std::int64_t>(first, 0) : first, count_ > 0 ? std::min(last, count_ - 1) : last);
        if (count_ > 0 && last >= count_) action(std::int64_t{0}, last - count_);
    }

  private:
    std::int64_t count_, width_;
    bool all_ = false;
    std::vector<Apart> apart_;
};

/// Cells [first, last) of a row along z, and how far apart their points and those of another row are.
struct Row {
    std::size_t first, last;
    Apart apart;
};

/// Whether points are near others: by their cells, most of which decide for all that they hold.
class Search {
  public:
    Search(Grid const& grid, double radius, std::span<Vec3 const> points, PointsInCells const& in_cells, std::span<Vec3 const> others,
           PointsInCells const& others_in_cells)
        : grid_(grid),
          squared_(radius * radius),
          x_(grid, 0, radius),
          y_(grid, 1, radius),
          z_(grid, 2, radius),
          points_(points),
          in_cells_(in_cells),
          others_in_cells_(others_in_cells),
          near_(points.size(), 0) {
        for (std::int64_t const k : others_in_cells.points()) others_.push_back(others[static_cast<std::size_t>(k)]);
    }

    std::vector<std::int64_t> run(Executor const& executor) {
        std::vector<std::size_t> const rows = row_starts(in_cells_.cells());
        int constexpr cost = 64;  // of a row in bodies
        executor.for_ranges(std::ssize(rows) - 1, cost, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) search_row(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(i) + 1]);
        });
        std::vector<std::int64_t> near;
        for (std::size_t k = 0; k < near_.size(); ++k)
            if (near_[k] != 0) near.push_back(static_cast<std::int64_t>(k));
        return near;
    }

  private:
    /// Where rows along z begin among cells, and the number of these.
    static std::vector<std::size_t> row_starts(std::vector<Cell> const& cells) {
        std::vector<std::size_t> starts;
        for (std::size_t i = 0; i < cells.size(); ++i)
            if (i == 0 || cells[i][0] != cells[i - 1][0] || cells[i][1] != cells[i - 1][1]) starts.push_back(i);
        starts.push_back(cells.size());
        return starts;
    }

    void search_row(std::size_t first, std::size_t last) {
        std::vector<Row> const rows = rows_near(in_cells_.cells()[first]);
        std::vector<std::size_t> open;
        for (std::size_t i = first; i < last; ++i) {
            bool const all = all_near(in_cells_.cells()[i][2], rows, open);
            for (std::int64_t const k : in_cells_.points(i)) near_[static_cast<std::size_t>(k)] = all || is_near(k, open) ? 1 : 0;
        }
    }

    /// The nearest first.
    std::vector<Row> rows_near(Cell const& cell) const {
        std::vector<Row> rows;
        std::vector<Cell> const& cells = others_in_cells_.cells();
        auto const from = [&](Cell const& least) {
            return static_cast<std::size_t>(std::lower_bound(cells.begin(), cells.end(), least) - cells.begin());
        };
        std::int64_t constexpr lowest = std::numeric_limits<std::int64_t>::min();
        x_.runs(cell[0], [&](std::int64_t x_first, std::int64_t x_last) {
            for (std::int64_t x = x_first; x <= x_last; ++x)
                y_.runs(cell[1], [&](std::int64_t y_first, std::int64_t y_last) {
                    for (std::size_t i = from({x, y_first, lowest}); i < cells.size() && cells[i][0] == x && cells[i][1] <= y_last;) {
                        std::int64_t const y = cells[i][1];
                        std::size_t const end = from({x, y + 1, lowest});
                        Apart const a = x_.apart(cell[0], x), b = y_.apart(cell[1], y);
                        if (a.least + b.least < squared_) rows.push_back({i, end, {a.least + b.least, a.most + b.most}});
                        i = end;
                    }
                });
        });
        std::sort(rows.begin(), rows.end(), [](Row const& a, Row const& b) {
            return a.apart.most != b.apart.most ? a.apart.most < b.apart.most : a.first < b.first;
        });
        return rows;
    }

    /// Whether all points of a cell are near one; if not, `open`: cells with points that may be near some.
    bool all_near(std::int64_t z, std::vector<Row> const& rows, std::vector<std::size_t>& open) const {
        open.clear();
        std::vector<Cell> const& cells = others_in_cells_.cells();
        bool all = false;
        for (Row const& row : rows) {
            z_.runs(z, [&](std::int64_t first, std::int64_t last) {
                auto const end = cells.begin() + static_cast<std::ptrdiff_t>(row.last);
                auto c = std::lower_bound(cells.begin() + static_cast<std::ptrdiff_t>(row.first), end, first,
                                          [](Cell const& at, std::int64_t least) { return at[2] < least; });
                for (; c != end && (*c)[2] <= last && !all; ++c) {
                    Apart const apart = z_.apart(z, (*c)[2]);
                    all = row.apart.most + apart.most < squared_;
                    if (row.apart.least + apart.least < squared_) open.push_back(static_cast<std::size_t>(c - cells.begin()));
                }
            });
            if (all) break;
        }
        return all;
    }

    bool is_near(std::int64_t k, std::vector<std::size_t> const& open) const {
        Vec3 const& x = points_[static_cast<std::size_t>(k)];
        return std::any_of(open.begin(), open.end(), [&](std::size_t cell) {
            auto const there = others_in_cells_.range(cell);
            return std::any_of(others_.begin() + there.first, others_.begin() + there.second,
                               [&](Vec3 const& other) { return grid_.squared_distance(x, other) < squared_; });
        });
    }

    Grid const& grid_;
    double squared_;
    Window x_, y_, z_;
    std::span<Vec3 const> points_;
    std::vector<Vec3> others_;  // cell by cell
    PointsInCells const &in_cells_, &others_in_cells_;
    std::vector<char> near_;
};

/// Small ones decide about more points.
Grid grid_for(double radius, std::optional<Vec3> const& box) {
    double constexpr cells_a_radius = 4;
    return Grid(radius / cells_a_radius, box);
}

}  // namespace

std::vector<std::int64_t> near_any(std::span<Vec3 const> points, std::span<Vec3 const> others, double radius,
                                   std::optional<Vec3> const& box) {
    Grid const grid = grid_for(radius, box);
    auto const executor = serial_executor();
    PointsInCells const a(grid, points, *executor), b(grid, others, *executor);
    return Search(grid, radius, points, a, others, b).run(*executor);
}

NearEachOther near_each_other(std::span<Vec3 const> one, std::span<Vec3 const> other, double radius, std::optional<Vec3> const& box,
                              Executor const& executor) {
    Grid const grid = grid_for(radius, box);
    PointsInCells const a(grid, one, executor), b(grid, other, executor);
    return {Search(grid, radius, one, a, other, b).run(executor), Search(grid, radius, other, b, one, a).run(executor)};
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
