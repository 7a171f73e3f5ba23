// Free places for chains: the cells of a grid that are clear of spheres around what has a place
// already.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

struct Sphere {
    Vec3 centre = Vec3::zero();
    double radius = 0;
    double gap = 0;  // two links
};

/// Cubic cells `width` wide, in a periodic box stretched to fill it. A cell is clear where its
/// middle is half a width, the radius and half of the gap or more from every sphere.
class PlaceGrid {
  public:
    PlaceGrid(std::vector<Sphere> const& placed, double width, std::optional<Vec3> const& box);

    /// Middles of clear cells of the coarsest cubic grid that has `wanted` of them, x running
    /// fastest; in a box that has no room, all that were found. Without a box the grid is centred
    /// on the origin; where it would become too large, it lies beside the spheres.
    std::vector<Vec3> find(std::size_t wanted);

  private:
    using Counts = std::array<std::int64_t, 3>;
    /// Cells of a row, both ends included.
    struct Run {
        std::int64_t first, last;
    };
    /// A sphere as a layer or a row of cells meets it: its distance from there so far.
    struct Near {
        std::size_t sphere;
        double square;
    };

    Counts most() const;
    std::int64_t smallest_of_use(std::size_t wanted) const;
    std::vector<Vec3> clear_cells(Counts const& n, std::size_t wanted);
    void add_layer(std::int64_t z, Counts const& n, std::size_t wanted, std::vector<Vec3>& cells);
    void add_row(std::int64_t y, std::int64_t z, Counts const& n, std::size_t wanted,
                 std::vector<Vec3>& cells);
    std::vector<Vec3> beside(std::size_t wanted) const;

    double coordinate(std::int64_t index, int axis, Counts const& n) const;
    double apart(double from, double to, int axis) const;
    /// Of a cell in the row that `row_` belongs to, sphere by sphere.
    bool is_clear(Vec3 const& cell) const;
    void add_surely_full(Near const& near, std::int64_t count);
    void add_run(double first, double last, std::int64_t count);
    /// The spheres of `among` that reach the plane or, among those of a plane, the line at `at`.
    void select(std::vector<Near> const& among, double at, int axis, std::vector<Near>& reaching);

    std::vector<Sphere> const& placed_;
    std::vector<double> reach_;  // of each sphere, from its centre to the middles of cells
    double width_;
    std::optional<Vec3> const& box_;
    std::vector<Near> all_, layer_, row_;
    std::vector<Run> full_;
    double work_ = 0;  // spheres looked at
};

}  // namespace catena::scene
