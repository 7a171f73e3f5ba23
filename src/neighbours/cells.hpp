// Points sorted by the cells of a grid.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "math/executor.hpp"
#include "neighbours/grid.hpp"

namespace catena {

/// Indices of points, sorted by the grid cells that contain them.
class PointsInCells {
  public:
    PointsInCells(Grid const& grid, std::span<Vec3 const> points, Executor const& executor) {
        std::vector<Run> const runs = sorted_runs(grid, points, executor);
        point_.resize(points.size());
        std::vector<std::int64_t> place;  // first index of each run's points
        std::int64_t placed = 0;
        for (Run const& run : runs) {
            if (cells_.empty() || !is_same(cells_.back(), run.cell)) {
                cells_.push_back(run.cell);
                first_.push_back(placed);
            }
            place.push_back(placed);
            placed += run.end - run.begin;
        }
        first_.push_back(placed);
        executor.for_each(std::ssize(runs), [&](std::int64_t r) {
            Run const& run = runs[static_cast<std::size_t>(r)];
            std::iota(point_.begin() + place[static_cast<std::size_t>(r)],
                      point_.begin() + place[static_cast<std::size_t>(r)] + (run.end - run.begin),
                      run.begin);
        });
    }

    /// Cells that contain points, ascending.
    std::vector<Cell> const& cells() const { return cells_; }
    /// Point indices, cell by cell, and ascending within a cell.
    std::vector<std::int64_t> const& points() const { return point_; }
    /// Range in points() of the i-th cell.
    std::pair<std::int64_t, std::int64_t> range(std::size_t i) const {
        return {first_[i], first_[i + 1]};
    }
    /// Points of the i-th cell.
    std::span<std::int64_t const> points(std::size_t i) const {
        return std::span(point_).subspan(static_cast<std::size_t>(first_[i]),
                                         static_cast<std::size_t>(first_[i + 1] - first_[i]));
    }

  private:
    /// Consecutive points in one cell. Consecutive points are mostly near each other, so that runs
    /// are longer than one point.
    struct Run {
        Cell cell;
        std::int64_t begin, end;
    };
    static bool before(Run const& a, Run const& b) {
        return is_same(a.cell, b.cell) ? a.begin < b.begin : a.cell < b.cell;
    }
    static std::vector<Run> runs_of(Grid const& grid, std::span<Vec3 const> points,
                                    std::int64_t begin, std::int64_t end) {
        std::vector<Run> runs;
        for (std::int64_t k = begin; k < end; ++k) {
            Cell const cell = grid.cell(points[static_cast<std::size_t>(k)]);
            if (runs.empty() || !is_same(runs.back().cell, cell)) runs.push_back({cell, k, k});
            runs.back().end = k + 1;
        }
        std::sort(runs.begin(), runs.end(), before);
        return runs;
    }
    /// Returns the runs of all points, sorted by cell: first in pieces of points, then by pairwise
    /// merges of the pieces.
    static std::vector<Run> sorted_runs(Grid const& grid, std::span<Vec3 const> points,
                                        Executor const& executor) {
        std::int64_t constexpr of_piece = 1 << 13;
        std::int64_t const count = std::ssize(points),
                           pieces = std::max<std::int64_t>((count + of_piece - 1) / of_piece, 1);
        std::vector<std::vector<Run>> sorted(static_cast<std::size_t>(pieces));
        auto const for_pieces = [&](std::int64_t n, auto const& action) {
            executor.for_ranges(n, of_piece, [&](std::int64_t begin, std::int64_t end) {
                for (std::int64_t i = begin; i < end; ++i) action(static_cast<std::size_t>(i));
            });
        };
        for_pieces(pieces, [&](std::size_t p) {
            auto const begin = static_cast<std::int64_t>(p) * of_piece;
            sorted[p] = runs_of(grid, points, begin, std::min(begin + of_piece, count));
        });
        while (sorted.size() > 1) {
            std::vector<std::vector<Run>> merged((sorted.size() + 1) / 2);
            for_pieces(std::ssize(merged), [&](std::size_t m) {
                std::vector<Run>& one = sorted[2 * m];
                if (2 * m + 1 == sorted.size()) return merged[m].swap(one);
                std::vector<Run> const& other = sorted[2 * m + 1];
                merged[m].resize(one.size() + other.size());
                std::merge(one.begin(), one.end(), other.begin(), other.end(), merged[m].begin(),
                           before);
            });
            sorted.swap(merged);
        }
        return std::move(sorted.front());
    }

    std::vector<Cell> cells_;
    std::vector<std::int64_t> first_, point_;
};

}  // namespace catena
