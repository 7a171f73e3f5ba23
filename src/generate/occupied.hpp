// Points in a periodic box, by cells, that are inserted and removed one by one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "generate/cells.hpp"
#include "math/linear.hpp"

namespace catena::scene {

/// Points in the cells of a periodic box, inserted and removed by their number.
class Occupied {
  public:
    /// `width` is the largest distance of interest; points have numbers below `points`.
    Occupied(Vec3 const& box, double width, std::size_t points)
        : images_(box),
          cells_(box, width, points),
          head_(cells_.size(), none),
          next_(points, none),
          at_(points) {}

    /// Inserts point i.
    void put(std::size_t i, Vec3 const& point) {
        at_[i] = images_.wrapped(point);
        std::int32_t& head = head_[cells_.of(at_[i])];
        next_[i] = head;
        head = static_cast<std::int32_t>(i);
    }
    /// Removes point i, which must have been inserted.
    void take(std::size_t i) {
        std::int32_t* link = &head_[cells_.of(at_[i])];
        while (*link != static_cast<std::int32_t>(i))
            link = &next_[static_cast<std::size_t>(*link)];
        *link = next_[i];
    }
    /// Square of the distance from `point` to the nearest point, at most `most`. Point
    /// `passed_over` is ignored (none: -1). The search may end early once the result is at most
    /// `least`; it then returns any such value.
    double clearance(Vec3 const& point, std::int32_t passed_over, double least, double most) const {
        Vec3 const here = images_.wrapped(point);
        double nearest = most;
        cells_.any_around(here, [&](std::size_t cell) {
            for (std::int32_t j = head_[cell]; j != none; j = next_[static_cast<std::size_t>(j)]) {
                if (j == passed_over) continue;
                Vec3 const apart = images_.shortest(here - at_[static_cast<std::size_t>(j)]);
                nearest = std::min(nearest, dot(apart, apart));
            }
            return nearest <= least;
        });
        return nearest;
    }

    static std::int32_t constexpr none = -1;

  private:
    Images images_;
    Cells cells_;
    std::vector<std::int32_t> head_, next_;
    std::vector<Vec3> at_;
};

}  // namespace catena::scene
