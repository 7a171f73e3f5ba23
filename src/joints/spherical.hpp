// Joint model of a spherical joint: rotation about every axis through one point.
#pragma once

#include "joints/quaternion_motion.hpp"

namespace catena {

/// Spherical joint. Its position is the quaternion of B in J; its rates are the relative angular
/// velocity, B.
struct SphericalJoint : JointDefaults {
    using Motion = QuaternionMotion;
    static constexpr JointType type = JointType::spherical;
    static constexpr char const* name = "spherical";
    static constexpr int code = 2, freedom = 3, restricted = 3, numbers = 3, rates = 3;
    static constexpr bool quaternion = true, ball = true, absolute = true, mixed = true;

    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const&, std::array<double, 4> const& q) {
        return {{q[0], q[1], q[2], q[3]}, Vec3::zero()};
    }
    static std::array<Twist, freedom> twists(JointShape const&, std::array<double, 4> const&) {
        return rotations;
    }
    /// Draws a position; angles and rotations are uniform.
    template <class Draws>
    static std::array<double, 4> random_position(Draws& draws) {
        return random_quaternion(draws);
    }
};

}  // namespace catena
