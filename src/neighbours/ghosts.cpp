// Neighbour search over blocks of points, which are sorted into a grid by their midpoints.
#include "neighbours/ghosts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <numeric>

#include "neighbours/cells.hpp"
#include "neighbours/grid.hpp"

namespace catena {

namespace {

/// Returns the offsets of groups with one point each.
std::vector<std::int64_t> each_by_itself(std::size_t points) {
    std::vector<std::int64_t> first(points + 1);
    std::iota(first.begin(), first.end(), std::int64_t{0});
    return first;
}

/// Range of grid cells along one axis whose points may be within reach of the points of a cell.
class Window {
  public:
    Window(Grid const& grid, int axis, double reach)
        : count_(grid.ends() ? grid.cells()[axis] : 0),
          width_(static_cast<std::int64_t>(std::ceil(reach / grid.edge()[axis]))),
          all_(count_ > 0 && 2 * width_ + 1 >= count_) {}
    /// Distance of two cells along the axis, in cells; periodic if the grid is.
    std::int64_t apart(std::int64_t a, std::int64_t b) const {
        std::int64_t const d = std::abs(a - b);
        return count_ > 0 ? std::min(d, count_ - d) : d;
    }
    /// Calls action(first, last) for at most two ranges of cells; each cell occurs once.
    template <class Action>
    void runs(std::int64_t a, Action const& action) const {
        if (all_) return action(std::int64_t{0}, count_ - 1);
        std::int64_t const first = a - width_, last = a + width_;
        if (count_ > 0 && first < 0) action(first + count_, count_ - 1);
        action(count_ > 0 ? std::max<std::int64_t>(first, 0) : first,
               count_ > 0 ? std::min(last, count_ - 1) : last);
        if (count_ > 0 && last >= count_) action(std::int64_t{0}, last - count_);
    }

  private:
    std::int64_t count_, width_;
    bool all_;
};

/// Blocks of a set of points, and their midpoints for the sorting into cells.
struct BlocksInCells {
    BlocksInCells(PointGroups const& points, double edge)
        : groups(points), blocks(blocks_of(points, edge)) {
        for (PointBlock const& b : blocks) {
            middles.push_back(b.middle);
            for (int c = 0; c < 3; ++c) half[c] = std::max(half[c], b.half[c]);
        }
    }

    PointGroups groups;
    std::vector<PointBlock> blocks;
    std::vector<Vec3> middles;
    Vec3 half = Vec3::zero();  // half edges of the widest block
};

/// Search for the groups near a second set of points. Both sets are searched by blocks, most of
/// which are out of reach.
class Search {
  public:
    Search(BlocksInCells const& ours, BlocksInCells const& theirs, double radius,
           std::optional<Vec3> const& box, Executor const& executor)
        : radius_(radius),
          ours_(ours),
          theirs_(theirs),
          reach_(ours.half + theirs.half + radius * Vec3{{1, 1, 1}}),
          grid_(std::max({reach_[0], reach_[1], reach_[2]}) / cells_a_reach, box),
          x_(grid_, 0, reach_[0]),
          y_(grid_, 1, reach_[1]),
          z_(grid_, 2, reach_[2]),
          in_cells_(grid_, ours.middles, executor),
          their_cells_(grid_, theirs.middles, executor),
          near_(static_cast<std::size_t>(ours.groups.size()), 0) {
        for (std::int64_t const b : their_cells_.points())
            their_blocks_.push_back(theirs.blocks[static_cast<std::size_t>(b)]);
    }

    std::vector<char> run(Executor const& executor) {
        std::vector<std::size_t> const rows = row_starts(in_cells_.cells());
        int constexpr cost = 256;  // cost of a row, in bodies
        executor.for_ranges(std::ssize(rows) - 1, cost, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i)
                search_row(rows[static_cast<std::size_t>(i)],
                           rows[static_cast<std::size_t>(i) + 1]);
        });
        return std::move(near_);
    }

  private:
    /// Number of cells per reach: narrower cells exclude more blocks.
    static double constexpr cells_a_reach = 2;

    /// Returns the index of the first cell of each row along z, then the number of cells.
    static std::vector<std::size_t> row_starts(std::vector<Cell> const& cells) {
        std::vector<std::size_t> starts;
        for (std::size_t i = 0; i < cells.size(); ++i)
            if (i == 0 || cells[i][0] != cells[i - 1][0] || cells[i][1] != cells[i - 1][1])
                starts.push_back(i);
        starts.push_back(cells.size());
        return starts;
    }

    /// Row of the other set's cells along z, and its squared distance in cells.
    struct Row {
        std::size_t first, last;
        std::int64_t away;
    };

    /// Searches the blocks of cells [first, last), which form one row along z.
    void search_row(std::size_t first, std::size_t last) {
        std::vector<Row> const rows = rows_near(in_cells_.cells()[first]);
        std::vector<std::int64_t> open;
        for (std::size_t i = first; i < last; ++i)
            for (std::int64_t const b : in_cells_.points(i)) {
                PointBlock const& block = ours_.blocks[static_cast<std::size_t>(b)];
                open.resize(static_cast<std::size_t>(block.end - block.begin));
                std::iota(open.begin(), open.end(), block.begin);
                for (Row const& row : rows)
                    if (!open.empty()) search_along(row, block, in_cells_.cells()[i][2], open);
            }
    }

    /// Returns the rows within reach, nearest first: they decide most groups.
    std::vector<Row> rows_near(Cell const& cell) const {
        std::vector<Row> rows;
        std::vector<Cell> const& cells = their_cells_.cells();
        auto const from = [&](Cell const& least) {
            return static_cast<std::size_t>(std::lower_bound(cells.begin(), cells.end(), least) -
                                            cells.begin());
        };
        std::int64_t constexpr lowest = std::numeric_limits<std::int64_t>::min();
        x_.runs(cell[0], [&](std::int64_t x_first, std::int64_t x_last) {
            for (std::int64_t x = x_first; x <= x_last; ++x)
                y_.runs(cell[1], [&](std::int64_t y_first, std::int64_t y_last) {
                    for (std::size_t i = from({x, y_first, lowest});
                         i < cells.size() && cells[i][0] == x && cells[i][1] <= y_last;) {
                        std::int64_t const y = cells[i][1], dx = x_.apart(cell[0], x),
                                           dy = y_.apart(cell[1], y);
                        std::size_t const end = from({x, y + 1, lowest});
                        rows.push_back({i, end, dx * dx + dy * dy});
                        i = end;
                    }
                });
        });
        std::stable_sort(rows.begin(), rows.end(),
                         [](Row const& a, Row const& b) { return a.away < b.away; });
        return rows;
    }

    /// Removes from `open` the groups of a block that are near blocks of the row, and marks them.
    void search_along(Row const& row, PointBlock const& block, std::int64_t z,
                      std::vector<std::int64_t>& open) {
        std::vector<Cell> const& cells = their_cells_.cells();
        z_.runs(z, [&](std::int64_t first, std::int64_t last) {
            auto const end = cells.begin() + static_cast<std::ptrdiff_t>(row.last);
            auto c =
                std::lower_bound(cells.begin() + static_cast<std::ptrdiff_t>(row.first), end, first,
                                 [](Cell const& at, std::int64_t least) { return at[2] < least; });
            for (; c != end && (*c)[2] <= last; ++c) {
                auto const [begin_block, end_block] =
                    their_cells_.range(static_cast<std::size_t>(c - cells.begin()));
                for (std::int64_t k = begin_block; k < end_block && !open.empty(); ++k) {
                    PointBlock const& other = their_blocks_[static_cast<std::size_t>(k)];
                    if (!may_be_near(squared_gap(block.middle, block.half, other))) continue;
                    std::erase_if(open, [&](std::int64_t g) { return is_near(g, other); });
                }
            }
        });
    }

    /// Tests one group point by point against a block of the other set, and stores the result.
    bool is_near(std::int64_t g, PointBlock const& block) {
        std::span<Vec3 const> const points = ours_.groups.group(g),
                                    others = theirs_.groups.of(block);
        bool const near = std::any_of(points.begin(), points.end(), [&](Vec3 const& x) {
            return may_be_near(squared_gap(x, Vec3::zero(), block)) &&
                   std::any_of(others.begin(), others.end(), [&](Vec3 const& other) {
                       return grid_.squared_distance(x, other) < radius_ * radius_;
                   });
        });
        near_[static_cast<std::size_t>(g)] = near ? 1 : 0;
        return near;
    }

    /// Squared distance between two bounding boxes in nearest images; 0 if they overlap.
    double squared_gap(Vec3 const& middle, Vec3 const& half, PointBlock const& other) const {
        Vec3 d = grid_.nearest_image(middle - other.middle);
        for (int c = 0; c < 3; ++c) d[c] = std::max(0.0, std::abs(d[c]) - half[c] - other.half[c]);
        return dot(d, d);
    }
    bool may_be_near(double squared_gap) const {
        double constexpr slack = 1 + 1e-9;  // allows for rounding of the boxes
        return squared_gap < slack * radius_ * radius_;
    }

    double radius_;
    BlocksInCells const &ours_, &theirs_;
    Vec3 reach_;
    Grid grid_;
    Window x_, y_, z_;
    PointsInCells in_cells_, their_cells_;
    std::vector<PointBlock> their_blocks_;  // sorted by cell
    std::vector<char> near_;
};

}  // namespace

std::vector<char> near_groups(PointGroups const& groups, PointGroups const& others, double radius,
                              std::optional<Vec3> const& box, Executor const& executor) {
    BlocksInCells const ours(groups, radius / 2), theirs(others, radius / 2);
    return Search(ours, theirs, radius, box, executor).run(executor);
}

std::vector<std::int64_t> near_any(std::span<Vec3 const> points, std::span<Vec3 const> others,
                                   double radius, std::optional<Vec3> const& box) {
    std::vector<std::int64_t> const first = each_by_itself(points.size()),
                                    of_others = each_by_itself(others.size());
    std::vector<char> const is_near =
        near_groups({points, first}, {others, of_others}, radius, box, *serial_executor());
    std::vector<std::int64_t> near;
    for (std::size_t k = 0; k < is_near.size(); ++k)
        if (is_near[k] != 0) near.push_back(static_cast<std::int64_t>(k));
    return near;
}

std::vector<std::int64_t> ghosts_of(std::span<Vec3 const> positions,
                                    std::span<std::int64_t const> own, double radius,
                                    std::optional<Vec3> const& box) {
    std::vector<bool> is_own(positions.size(), false);
    std::vector<Vec3> inside, outside;
    for (std::int64_t const k : own) {
        is_own[k] = true;
        inside.push_back(positions[k]);
    }
    std::vector<std::int64_t> bead;  // bead of each entry of `outside`
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
