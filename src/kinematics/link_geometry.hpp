// Geometry of links of fixed length, along a chain and from its last bead or body to the ground or
// to the first one. Ground axes (W), nm and ps, unless the scene has `units: si`.
#pragma once

#include <cmath>
#include <cstdint>

#include "math/linear.hpp"

namespace catena {

/// The attachment of a chain's last bead or body: a link or a joint to the ground or, in a ring, to
/// the first bead or body.
struct HeldTip {
    /// Last body, local; -1 if this rank holds only the first body of a ring.
    std::int64_t body = -1;
    Vec3 anchor;             // Attachment point on the ground, W.
    double length = 0;       // Length of the link, nm.
    std::int64_t ring = -1;  // Index in LocalEnds::rings; -1 if attached to the ground.
    /// First body of the ring, local; -1 if it is on another rank.
    std::int64_t first = -1;
};

/// Length error of a link d to first order: (|d|^2 - length^2) / (2 length). Each sweep of a drift
/// corrects what the previous sweep left; the corrections act along the directions at the drift's
/// start, whose error is larger than that of this linearisation. It has no square root and no
/// division, because a sweep over few beads waits for their latency.
CATENA_HD double excess(Vec3 const& d, double length, double half_over_length) {
    return half_over_length * (dot(d, d) - length * length);
}

/// Velocity bias |v_rel, perpendicular|^2 / length of a link along u whose ends separate with
/// velocity v (src/dca/README.md, "Link chains": -c).
CATENA_HD double velocity_bias(Vec3 const& v, Vec3 const& u, double length) {
    Vec3 const across = plus_scaled(v, -dot(v, u), u);
    return dot(across, across) / length;
}

}  // namespace catena
