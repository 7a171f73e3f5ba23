// Projection of positions to the lengths of a chain's links by the least change.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/linear.hpp"
#include "scene/branches.hpp"

namespace catena::scene {

/// Units in the order of their chain: points, or rigid shapes that translate without rotation.
struct LinkedUnits {
    /// Positions of the units, which the projection changes.
    std::span<Vec3> at;
    /// Length of the link from the preceding unit to this one; entry 0 is ignored.
    std::span<double const> length;
    /// Inverse weight of each unit: 0 holds it fixed, empty means 1.
    std::span<double const> mobility = {};
    /// Ends of a unit's links relative to `at`; empty means zero.
    std::span<Vec3 const> inboard = {};
    std::span<Vec3 const> outboard = {};
    /// Length of a link from the last unit to the first; 0 means no such link.
    double closing = 0;
    /// Unit at the inboard end of each unit's link, with a smaller number; empty means the
    /// preceding unit. A tree of units has no closing link and holds at most the first unit fixed.
    std::span<std::int64_t const> parent = {};
};

/// Units on which the units of a chain hang if the anchor of a fixed base is unit 0; empty for an
/// unbranched chain.
std::vector<std::int64_t> unit_parents(Parents parents, Base base);

/// Newton's iteration for the lengths of a chain's links. Both ends of a link are displaced along
/// it by its multiplier lambda times their mobility. The linear system is that of the link chain's
/// constraint forces. For equal weights its diagonal is 2 and its off-diagonal entries are minus
/// the cosines between links. Trees are eliminated unit by unit, in 3 x 3 blocks. Cost is O(units)
/// per sweep; the result depends on the arguments alone. An object reuses its memory from call to
/// call.
class LinkProjection {
  public:
    /// Moves the units; returns true if every link has its length. The tolerance is 1e-13 of the
    /// length, as far as the positions' rounding allows. At most 20 sweeps are done.
    bool project(LinkedUnits const&);

  private:
    /// Unit direction and length error of one link.
    struct Link {
        Vec3 along;
        /// Distance of the ends minus the length.
        double error;
        /// True if the error exceeds the tolerance.
        bool wrong;
    };
    static Link link_between(LinkedUnits const&, std::size_t from, std::size_t to, double length);
    bool eliminate(LinkedUnits const&);
    void substitute(LinkedUnits const&);
    bool eliminate_tree(LinkedUnits const&);
    void substitute_tree(LinkedUnits const&);
    bool is_open(LinkedUnits const&);
    void close(LinkedUnits const&);

    std::vector<Vec3> along_;
    std::vector<double> factor_, lambda_, response_;
    Link closing_{};
    /// Trees, per unit: weight with all that hangs on it, and the pull of that on the unit.
    std::vector<Mat3> weight_;
    std::vector<Vec3> pull_;
};

}  // namespace catena::scene
