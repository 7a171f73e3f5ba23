// Joint model of a weld: the outboard body is fixed in the inboard body.
#pragma once

#include "joints/rigid_motion.hpp"

namespace catena {

/// Weld. It has no coordinates; as every joint, it has a frame J.
struct WeldJoint : JointDefaults {
    using Motion = RigidMotion;
    static constexpr JointType type = JointType::weld;
    static constexpr char const* name = "weld";
    static constexpr int code = 5, freedom = 0, restricted = 6, numbers = 0, rates = 0;
    static constexpr bool rigid = true, mixed = true;
    static constexpr PlaneRole plane = PlaneRole::carries;

    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const&, std::array<double, 4> const&) {
        return {};
    }
    /// Closure error of a ring.
    static JointOpening opening(JointShape const&, Quat const& turn, Vec3 const& origin) {
        return {norm(origin), norm(rotation_vector(turn))};
    }
};

}  // namespace catena
