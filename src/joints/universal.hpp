// Joint model of a universal joint: rotation by q[0] about the first axis, fixed in the inboard
// body, then by q[1] about the second one, fixed in the outboard body.
#pragma once

#include "joints/universal_motion.hpp"

namespace catena {

/// Universal joint. Its two axes must not be parallel; its handles have the normal of both as their
/// first axis.
struct UniversalJoint : JointDefaults {
    using Motion = UniversalMotion;
    static constexpr JointType type = JointType::universal;
    static constexpr char const* name = "universal";
    static constexpr int code = 4, freedom = 2, restricted = 4, numbers = 2, rates = 2, axes = 2;
    static constexpr bool turns_twice = true, mixed = true;

    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const& shape, std::array<double, 4> const& q) {
        return {from_axis_angle(shape.first_axis, q[0]) * from_axis_angle(shape.axis, q[1]),
                Vec3::zero()};
    }
    /// Closure error of a ring.
    static JointOpening opening(JointShape const& shape, Quat const& turn, Vec3 const& origin) {
        return {norm(origin), std::abs(dot(shape.first_axis, to_matrix(turn) * shape.axis) -
                                       dot(shape.first_axis, shape.axis))};
    }
    /// Second axis at position q, J.
    static Vec3 second_axis(JointShape const& shape, std::array<double, 4> const& q) {
        Vec3 const &first = shape.first_axis, &axis = shape.axis;
        double const c = std::cos(q[0]), s = std::sin(q[0]);
        return c * axis + s * cross(first, axis) + (1 - c) * dot(first, axis) * first;
    }
    static std::array<Twist, freedom> twists(JointShape const& shape,
                                             std::array<double, 4> const& q) {
        return {{{shape.first_axis, Vec3::zero()}, {second_axis(shape, q), Vec3::zero()}}};
    }
    /// Draws a position; angles and rotations are uniform.
    template <class Draws>
    static std::array<double, 4> random_position(Draws& draws) {
        double const first = random_angle(draws);
        return {first, random_angle(draws), 0, 0};
    }
};

}  // namespace catena
