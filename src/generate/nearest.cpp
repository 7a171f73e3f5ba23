// Implements the search for close pairs by cells.
#include "generate/nearest.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "generate/cells.hpp"

namespace catena::scene {

namespace {

/// Edges of a box so large that no point meets the image of another one.
Vec3 edges_around(std::span<Vec3 const> points, double within) {
    Vec3 low = points[0], high = low, edges;
    for (Vec3 const& point : points)
        for (int i = 0; i < 3; ++i)
            low[i] = std::min(low[i], point[i]), high[i] = std::max(high[i], point[i]);
    for (int i = 0; i < 3; ++i) edges[i] = high[i] - low[i] + 3 * within;
    return edges;
}

/// Points wrapped into the box and sorted by their cells.
class PointsByCell {
  public:
    PointsByCell(std::span<Vec3 const> points, Images const& images, double within)
        : cells_(images.edge(), within, points.size()),
          begin_(cells_.size() + 1, 0),
          order_(points.size()) {
        std::vector<std::uint32_t> cell;
        for (Vec3 const& point : points) {
            wrapped_.push_back(images.wrapped(point));
            cell.push_back(static_cast<std::uint32_t>(cells_.of(wrapped_.back())));
            ++begin_[cell.back() + 1];
        }
        for (std::size_t c = 0; c < cells_.size(); ++c) begin_[c + 1] += begin_[c];
        std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
        for (std::size_t i = 0; i < points.size(); ++i)
            order_[next[cell[i]]++] = static_cast<std::uint32_t>(i);
    }

    Vec3 const& at(std::size_t i) const { return wrapped_[i]; }
    /// Calls visit(j) for every point j in the cells around point i.
    template <class Visit>
    void around(std::size_t i, Visit visit) const {
        cells_.any_around(wrapped_[i], [&](std::size_t cell) {
            for (std::uint32_t at = begin_[cell]; at < begin_[cell + 1]; ++at)
                visit(std::size_t{order_[at]});
            return false;
        });
    }

  private:
    Cells cells_;
    std::vector<Vec3> wrapped_;
    std::vector<std::uint32_t> begin_, order_;
};

}  // namespace

void for_each_near_pair(std::span<Vec3 const> points, std::optional<Vec3> const& box, double within,
                        std::function<void(std::size_t, std::size_t, Vec3 const&)> const& visit) {
    if (points.size() < 2) return;
    Images const images(box ? *box : edges_around(points, within));
    PointsByCell const sorted(points, images, within);
    for (std::size_t i = 0; i < points.size(); ++i)
        sorted.around(i, [&](std::size_t j) {
            if (j <= i) return;
            Vec3 const apart = images.shortest(sorted.at(i) - sorted.at(j));
            if (dot(apart, apart) <= within * within) visit(i, j, apart);
        });
}

std::optional<NearPair> nearest_pair(std::span<Vec3 const> points, std::optional<Vec3> const& box,
                                     double within,
                                     std::function<bool(std::size_t, std::size_t)> const& counts) {
    std::optional<NearPair> nearest;
    for_each_near_pair(points, box, within, [&](std::size_t i, std::size_t j, Vec3 const& apart) {
        double const distance = norm(apart);
        if ((!nearest || distance < nearest->distance) && counts(i, j))
            nearest = NearPair{i, j, distance};
    });
    return nearest;
}

}  // namespace catena::scene
