// Joint model of a revolute joint: rotation by q about one axis.
#pragma once

#include "joints/screw_motion.hpp"

namespace catena {

/// Revolute joint. Written `planar`, it promises a chain whose axes are all parallel.
struct RevoluteJoint : JointDefaults {
    using Motion = ScrewMotion;
    static constexpr JointType type = JointType::revolute;
    static constexpr char const *name = "revolute", *name_in_plane = "planar";
    static constexpr int code = 3, axes = 1;
    static constexpr bool pivots = true, mixed = true;
    static constexpr PlaneRole plane = PlaneRole::turns;

    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const& shape, std::array<double, 4> const& q) {
        return {from_axis_angle(shape.axis, q[0]), Vec3::zero()};
    }
    /// Closure error of a ring.
    static JointOpening opening(JointShape const& shape, Quat const& turn, Vec3 const& origin) {
        return {norm(origin), tilt_of(shape.axis, turn)};
    }
    static std::array<Twist, freedom> twists(JointShape const& shape,
                                             std::array<double, 4> const&) {
        return {{{shape.axis, Vec3::zero()}}};
    }
    /// Draws a position; angles and rotations are uniform.
    template <class Draws>
    static std::array<double, 4> random_position(Draws& draws) {
        return {random_angle(draws), 0, 0, 0};
    }
};

}  // namespace catena
