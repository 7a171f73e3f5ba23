// Joint model of body 1 of a free base: it moves relative to the ground without restriction.
#pragma once

#include "joints/quaternion_motion.hpp"

namespace catena {

/// Free joint 1. Its position is the quaternion of B in W; its rates are the angular velocity, B.
struct FreeJoint : JointDefaults {
    using Motion = QuaternionMotion;
    static constexpr JointType type = JointType::free;
    static constexpr char const* name = "free";
    static constexpr int code = 0, freedom = 6, restricted = 0, numbers = 0, rates = 3;
    static constexpr bool quaternion = true, floats = true, absolute = true;
    static constexpr PlaneRole plane = PlaneRole::starts;

    /// The rotation alone: the position is that of BodyArrays::free_base.
    static JointDisplacement displacement(JointShape const&, std::array<double, 4> const& q) {
        return {{q[0], q[1], q[2], q[3]}, Vec3::zero()};
    }
    static std::array<Twist, freedom> twists(JointShape const&, std::array<double, 4> const&) {
        std::array<Twist, freedom> all;
        for (std::size_t i = 0; i < 3; ++i)
            all[i] = rotations[i], all[i + 3] = {Vec3::zero(), rotations[i].angular};
        return all;
    }
    /// Draws a position; angles and rotations are uniform.
    template <class Draws>
    static std::array<double, 4> random_position(Draws& draws) {
        return random_quaternion(draws);
    }
};

}  // namespace catena
