// Joint model of a link: a rod of fixed length, in absolute coordinates.
#pragma once

#include "joints/rigid_motion.hpp"

namespace catena {

/// Link between beads or between points of bodies. It restricts the distance of its ends alone.
struct LinkJoint : JointDefaults {
    using Motion = RigidMotion;
    static constexpr JointType type = JointType::link;
    static constexpr char const* name = "link";
    static constexpr int code = 1, freedom = 5, restricted = 1, numbers = 0, rates = 0;
    static constexpr bool rod = true, absolute = true;

    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const&, std::array<double, 4> const&) {
        return {};
    }
};

}  // namespace catena
