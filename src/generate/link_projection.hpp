// The least change of positions that gives the links of a chain their lengths.
#pragma once

#include <span>
#include <vector>

#include "math/linear.hpp"

namespace catena::scene {

/// Units (points, or rigid shapes that are shifted and not turned) in the order of their chain.
struct LinkedUnits {
    std::span<Vec3> at;  // what is moved
    std::span<double const>
        length;  // of the link from the unit before to this one; entry 0 means nothing
    std::span<double const> mobility =
        {};  // the inverse of each unit's weight, 0: it is held; empty: 1
    std::span<Vec3 const> inboard = {};  // ends of a unit's links from `at`; empty: zero
    std::span<Vec3 const> outboard = {};
    double closing = 0;  // length of a link from the last unit to the first; 0: there is none
};

/// Newton's iteration for the lengths of a chain's links. Shifts of both ends along the links,
/// equal and opposite where the weights are equal, by lambda: the system is that of the link
/// chain's constraint forces (for equal weights diagonal 2, beside it minus the cosines between
/// links). O(units) a sweep; a function of its arguments alone. An object keeps its memory from
/// call to call.
class LinkProjection {
  public:
    /// Whether every link has its length, to 1e-13 of it as far as the positions' rounding allows,
    /// after 20 sweeps at most.
    bool project(LinkedUnits const&);

  private:
    struct Link {
        Vec3 along;
        double error;
        bool wrong;
    };
    static Link link_between(LinkedUnits const&, std::size_t from, std::size_t to, double length);
    bool eliminate(LinkedUnits const&);
    void substitute(LinkedUnits const&);
    bool is_open(LinkedUnits const&);
    void close(LinkedUnits const&);

    std::vector<Vec3> along_;
    std::vector<double> factor_, lambda_, response_;
    Link closing_{};
};

}  // namespace catena::scene
