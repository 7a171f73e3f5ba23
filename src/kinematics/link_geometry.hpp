// Links of fixed length along a chain, and from the last bead or body to the ground.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/linear.hpp"

namespace catena {

/// Where a chain's last bead or body is held: by a link or a joint to the ground or, in a ring, to
/// its first one.
struct HeldTip {
    std::int64_t body = -1;   // the last one, local; -1: of a ring that only begins on this rank
    Vec3 anchor;              // in the ground, W
    double length = 0;        // of the link
    std::int64_t ring = -1;   // index in ChainGroup::rings; -1: held by the ground
    std::int64_t first = -1;  // of a ring: its first body, local; -1: on another rank
};

/// How much too long a link d is, to first order: each sweep of a drift takes what the one before
/// it has left, and what all of them close along are the directions at the drift's start, which
/// leave more of it. No root, no division: a sweep of few beads waits for them.
CATENA_HD double excess(Vec3 const& d, double length, double half_over_length) {
    return half_over_length * (dot(d, d) - length * length);
}

/// |v_rel, perpendicular|^2 / length of a link along u whose ends part with velocity v
/// (src/dca/README.md, "Link chains": -c).
CATENA_HD double swing(Vec3 const& v, Vec3 const& u, double length) {
    Vec3 const across = plus_scaled(v, -dot(v, u), u);
    return dot(across, across) / length;
}

}  // namespace catena
