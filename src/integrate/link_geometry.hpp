// Links of fixed length along a chain, and from the last bead or body to the ground.
#pragma once

#include <cmath>
#include <cstdint>

#include "dca/linear.hpp"

namespace catena {

/// Where a chain's last bead or body is held: by a link to the ground or a joint there.
struct HeldTip {
    std::int64_t body = 0;  // local
    Vec3 anchor;            // W
    double length = 0;      // of the link
};

/// How far a link d is too long along its direction u at the step's start: the s with |d - s u| = length.
CATENA_HD double excess(Vec3 const& d, Vec3 const& u, double length) {
    double const along = dot(d, u), e = dot(d, d) - length * length;
    double const square = along * along - e;
    return e / (along + std::sqrt(square > 0 ? square : 0.0));
}

/// |v_rel, perpendicular|^2 / length of a link along u whose ends part with velocity v (formulas: -c).
CATENA_HD double swing(Vec3 const& v, Vec3 const& u, double length) {
    Vec3 const across = plus_scaled(v, -dot(v, u), u);
    return dot(across, across) / length;
}

}  // namespace catena
