// Free places for chains: cells of a grid outside of spheres around the chains that have a place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

/// Bounding sphere of a placed chain.
struct Sphere {
    Vec3 centre = Vec3::zero();
    double radius = 0;
    double gap = 0;  // twice the chain's longest link
};

/// Grid of cubic cells of width `width`, stretched to fill a periodic box. A cell is clear if its
/// centre keeps a distance from every sphere: half the width, the radius and half the gap.
class PlaceGrid {
  public:
    PlaceGrid(std::vector<Sphere> const& placed, double width, std::optional<Vec3> const& box);

    /// Returns the centres of clear cells of the coarsest cubic grid that has `wanted` of them, x
    /// running fastest. In a box without enough room all that were found are returned. Without a
    /// box the grid is centred on the origin; if it became too large, it is placed next to the
    /// spheres.
    std::vector<Vec3> find(std::size_t wanted);

  private:
    /// Number of cells along each axis.
    using Counts = std::array<std::int64_t, 3>;
    /// Cells of a row, both ends included.
    struct Run {
        std::int64_t first, last;
    };
    /// A sphere that reaches a layer or row of cells, with its squared distance from there so far.
    struct Near {
        std::size_t sphere;
        double square;
    };

    /// Largest number of cells of width `width_` along each axis of the box.
    Counts most() const;
    std::int64_t smallest_of_use(std::size_t wanted) const;
    /// Returns up to `wanted` clear cells of a grid of n cells.
    std::vector<Vec3> clear_cells(Counts const& n, std::size_t wanted);
    void add_layer(std::int64_t z, Counts const& n, std::size_t wanted, std::vector<Vec3>& cells);
    void add_row(std::int64_t y, std::int64_t z, Counts const& n, std::size_t wanted,
                 std::vector<Vec3>& cells);
    std::vector<Vec3> beside(std::size_t wanted) const;

    /// Coordinate of the centre of a cell.
    double coordinate(std::int64_t index, int axis, Counts const& n) const;
    /// Difference of coordinates, that of the nearest image in a box.
    double apart(double from, double to, int axis) const;
    /// True if the cell, in the row that `row_` belongs to, is clear of all its spheres.
    bool is_clear(Vec3 const& cell) const;
    void add_surely_full(Near const& near, std::int64_t count);
    void add_run(double first, double last, std::int64_t count);
    /// Collects the spheres of `among` that reach the plane at `at`, or the line at `at` for the
    /// spheres of a plane.
    void select(std::vector<Near> const& among, double at, int axis, std::vector<Near>& reaching);

    std::vector<Sphere> const& placed_;
    /// Distance that each sphere keeps from the centres of cells.
    std::vector<double> reach_;
    double width_;
    std::optional<Vec3> const& box_;
    std::vector<Near> all_, layer_, row_;
    std::vector<Run> full_;
    /// Number of sphere tests so far, the measure of the time spent.
    double work_ = 0;
};

}  // namespace catena::scene
