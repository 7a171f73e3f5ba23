// Implements the search for free places layer by layer and row by row.
#include "generate/place_grid.hpp"

#include <algorithm>
#include <cmath>

namespace catena::scene {

namespace {

/// Numbers of sphere tests after which grids grow by doubling, and after which a box counts as
/// full.
double constexpr patience = 1e8, end_of_patience = 10 * patience;
/// Largest number of cells along an edge of a grid without a box.
std::int64_t constexpr widest = 4096;
/// Relative rounding of distances; cells within it are tested one by one.
double constexpr relative_rounding = 1e-9;

/// Returns the smallest n >= `least` with `wanted` cells in a grid of n along each edge, limited to
/// `limit`. If there is none, returns the largest of the limits. A long or flat box has far fewer
/// cells than a cube.
std::int64_t with_room_for(std::size_t wanted, std::int64_t least,
                           std::array<std::int64_t, 3> const& limit) {
    auto const has_room = [&](std::int64_t n) {
        double cells = 1;
        for (std::int64_t const most : limit) cells *= static_cast<double>(std::min(n, most));
        return cells >= static_cast<double>(wanted);
    };
    std::int64_t none = least, some = *std::max_element(limit.begin(), limit.end());
    if (none >= some || has_room(none)) return none;
    while (some - none > 1) {
        std::int64_t const middle = none + (some - none) / 2;
        (has_room(middle) ? some : none) = middle;
    }
    return some;
}

}  // namespace

PlaceGrid::PlaceGrid(std::vector<Sphere> const& placed, double width,
                     std::optional<Vec3> const& box)
    : placed_(placed), width_(width), box_(box) {
    for (std::size_t i = 0; i < placed.size(); ++i) {
        reach_.push_back(0.5 * width + placed[i].radius + 0.5 * placed[i].gap);
        all_.push_back({i, 0});
    }
}

std::vector<Vec3> PlaceGrid::find(std::size_t wanted) {
    Counts const limit = most();
    std::int64_t const largest = *std::max_element(limit.begin(), limit.end());
    std::vector<Vec3> cells;
    // The coarsest grid with enough room spreads few chains over the box and puts a single chain
    // into its middle.
    for (std::int64_t n = with_room_for(wanted, smallest_of_use(wanted), limit);
         cells.size() < wanted; n = work_ < patience ? n + 1 : 2 * n) {
        if (!box_ && n > widest && !placed_.empty()) return beside(wanted);
        cells = clear_cells({std::min(n, limit[0]), std::min(n, limit[1]), std::min(n, limit[2])},
                            wanted);
        if (n >= largest || work_ > end_of_patience) break;
    }
    return cells.size() < wanted && !box_ ? beside(wanted) : cells;
}

PlaceGrid::Counts PlaceGrid::most() const {
    Counts limit{INT64_MAX, INT64_MAX, INT64_MAX};
    for (int i = 0; i < 3 && box_; ++i)
        limit[static_cast<std::size_t>(i)] =
            static_cast<std::int64_t>(std::floor(std::min((*box_)[i] / width_, 1e15)));
    return limit;
}

/// Smallest number of cells along an edge that can succeed. Smaller grids have too few cells or,
/// without a box, lie within one sphere.
std::int64_t PlaceGrid::smallest_of_use(std::size_t wanted) const {
    double n = std::ceil(std::cbrt(static_cast<double>(wanted)) - 1e-9);
    for (std::size_t i = 0; i < placed_.size() && !box_; ++i) {
        Vec3 const& c = placed_[i].centre;
        double const sum = std::abs(c[0]) + std::abs(c[1]) + std::abs(c[2]);
        double const under = sum * sum - 3 * (dot(c, c) - reach_[i] * reach_[i]);
        if (under <= sum * sum) continue;
        // Half the edge of a cube whose farthest corner the sphere reaches.
        double const half = (std::sqrt(under) - sum) / 3 * (1 - relative_rounding);
        n = std::max(n, std::floor(2 * half / width_) + 1);
    }
    return static_cast<std::int64_t>(std::min(n, 1e15));
}

std::vector<Vec3> PlaceGrid::clear_cells(Counts const& n, std::size_t wanted) {
    std::vector<Vec3> cells;
    if (n[0] == 0 || n[1] == 0) return cells;  // the number of empty layers and rows may be huge
    for (std::int64_t z = 0; z < n[2] && cells.size() < wanted && work_ <= end_of_patience; ++z)
        add_layer(z, n, wanted, cells);
    return cells;
}

void PlaceGrid::add_layer(std::int64_t z, Counts const& n, std::size_t wanted,
                          std::vector<Vec3>& cells) {
    select(all_, coordinate(z, 2, n), 2, layer_);
    for (Near const& near : layer_) {
        Vec3 const& centre = placed_[near.sphere].centre;
        double square = near.square;
        for (int i = 0; i < 2; ++i) {
            double const farthest =
                box_ ? 0.5 * (*box_)[i] : std::abs(centre[i]) + std::abs(coordinate(0, i, n));
            square += farthest * farthest;
        }
        if (std::sqrt(square) < reach_[near.sphere] * (1 - relative_rounding))
            return;  // the sphere covers the layer
    }
    for (std::int64_t y = 0; y < n[1] && cells.size() < wanted && work_ <= end_of_patience; ++y)
        add_row(y, z, n, wanted, cells);
}

void PlaceGrid::add_row(std::int64_t y, std::int64_t z, Counts const& n, std::size_t wanted,
                        std::vector<Vec3>& cells) {
    Vec3 cell{{0, coordinate(y, 1, n), coordinate(z, 2, n)}};
    select(layer_, cell[1], 1, row_);
    full_.clear();
    for (Near const& near : row_) add_surely_full(near, n[0]);
    std::sort(full_.begin(), full_.end(),
              [](Run const& a, Run const& b) { return a.first < b.first; });
    auto next = full_.begin();
    for (std::int64_t x = 0; x < n[0] && cells.size() < wanted; ++x) {
        for (; next != full_.end() && next->first <= x; ++next) x = std::max(x, next->last + 1);
        if (x >= n[0]) return;
        cell[0] = coordinate(x, 0, n);
        work_ += static_cast<double>(row_.size());
        if (is_clear(cell)) cells.push_back(cell);
    }
}

void PlaceGrid::select(std::vector<Near> const& among, double at, int axis,
                       std::vector<Near>& reaching) {
    reaching.clear();
    work_ += static_cast<double>(among.size()) + 1;
    for (Near const& near : among) {
        double const distance = apart(at, placed_[near.sphere].centre[axis], axis);
        double const square = near.square + distance * distance;
        if (std::sqrt(square) < reach_[near.sphere] * (1 + relative_rounding))
            reaching.push_back({near.sphere, square});
    }
}

/// Marks the cells of the row that lie within the sphere despite rounding. One cell at each end is
/// left to the exact test.
void PlaceGrid::add_surely_full(Near const& near, std::int64_t count) {
    double const reach = reach_[near.sphere],
                 half = std::sqrt(std::max(0.0, reach * reach - near.square)) *
                        (1 - relative_rounding);
    double const centre = placed_[near.sphere].centre[0], n = static_cast<double>(count);
    if (!box_)
        return add_run((centre - half) / width_ + 0.5 * (n - 1),
                       (centre + half) / width_ + 0.5 * (n - 1), count);
    double const edge = (*box_)[0], a_cell = edge / n;
    if (2 * half > edge * (1 + relative_rounding)) return add_run(-2, n + 1, count);
    double const wrapped = centre - edge * std::floor(centre / edge);
    for (int image = -1; image <= 1; ++image)
        add_run((wrapped + image * edge - half) / a_cell - 0.5,
                (wrapped + image * edge + half) / a_cell - 0.5, count);
}

void PlaceGrid::add_run(double first, double last, std::int64_t count) {
    double const n = static_cast<double>(count);
    Run const run{static_cast<std::int64_t>(std::clamp(std::ceil(first) + 1, 0.0, n)),
                  static_cast<std::int64_t>(std::clamp(std::floor(last) - 1, -1.0, n - 1))};
    if (run.first <= run.last) full_.push_back(run);
}

bool PlaceGrid::is_clear(Vec3 const& cell) const {
    return std::none_of(row_.begin(), row_.end(), [&](Near const& near) {
        Vec3 const& centre = placed_[near.sphere].centre;
        Vec3 const difference{{apart(cell[0], centre[0], 0), apart(cell[1], centre[1], 1),
                               apart(cell[2], centre[2], 2)}};
        return norm(difference) < reach_[near.sphere];
    });
}

double PlaceGrid::coordinate(std::int64_t index, int axis, Counts const& n) const {
    double const count = static_cast<double>(n[static_cast<std::size_t>(axis)]),
                 at = static_cast<double>(index);
    return box_ ? (at + 0.5) * (*box_)[axis] / count : (at - 0.5 * (count - 1)) * width_;
}

double PlaceGrid::apart(double from, double to, int axis) const {
    double const difference = from - to;
    return box_ ? difference - (*box_)[axis] * std::round(difference / (*box_)[axis]) : difference;
}

/// Cubic grid next to the sphere that reaches farthest along x.
std::vector<Vec3> PlaceGrid::beside(std::size_t wanted) const {
    auto const n =
        static_cast<std::int64_t>(std::ceil(std::cbrt(static_cast<double>(wanted)) - 1e-9));
    Counts const counts{n, n, n};
    double right = 0;
    for (std::size_t i = 0; i < placed_.size(); ++i)
        right = std::max(right, placed_[i].centre[0] + reach_[i]);
    std::vector<Vec3> cells;
    for (std::int64_t k = 0; cells.size() < wanted; ++k)
        cells.push_back({{right + static_cast<double>(k % n) * width_,
                          coordinate(k / n % n, 1, counts), coordinate(k / (n * n), 2, counts)}});
    return cells;
}

}  // namespace catena::scene
