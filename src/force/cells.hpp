// Points sorted by the cells of a grid.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "force/grid.hpp"

namespace catena {

class PointsInCells {
  public:
    PointsInCells(Grid const& grid, std::span<Vec3 const> points) {
        // Beads that follow each other lie together: their cells are the same for some.
        struct Run {
            Cell cell;
            std::int64_t begin, end;
        };
        std::vector<Run> runs;
        for (std::int64_t k = 0; k < std::ssize(points); ++k) {
            Cell const cell = grid.cell(points[static_cast<std::size_t>(k)]);
            if (runs.empty() || !is_same(runs.back().cell, cell)) runs.push_back({cell, k, k});
            runs.back().end = k + 1;
        }
        std::sort(runs.begin(), runs.end(),
                  [](Run const& a, Run const& b) { return is_same(a.cell, b.cell) ? a.begin < b.begin : a.cell < b.cell; });
        point_.reserve(points.size());
        for (Run const& run : runs) {
            if (cells_.empty() || !is_same(cells_.back(), run.cell)) {
                cells_.push_back(run.cell);
                first_.push_back(std::ssize(point_));
            }
            for (std::int64_t k = run.begin; k < run.end; ++k) point_.push_back(k);
        }
        first_.push_back(std::ssize(point_));
    }

    /// Those that hold points, ascending.
    std::vector<Cell> const& cells() const { return cells_; }
    /// Cell by cell; ascending in each.
    std::vector<std::int64_t> const& points() const { return point_; }
    /// Which of them are in the i-th cell.
    std::pair<std::int64_t, std::int64_t> range(std::size_t i) const { return {first_[i], first_[i + 1]}; }
    std::span<std::int64_t const> points(std::size_t i) const {
        return std::span(point_).subspan(static_cast<std::size_t>(first_[i]), static_cast<std::size_t>(first_[i + 1] - first_[i]));
    }

  private:
    std::vector<Cell> cells_;
    std::vector<std::int64_t> first_, point_;
};

}  // namespace catena
