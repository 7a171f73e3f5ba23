// Joint model of a prismatic joint: translation by q along one axis.
#pragma once

#include "joints/screw_motion.hpp"

namespace catena {

/// Prismatic joint. Its coordinate is a length.
struct PrismaticJoint : JointDefaults {
    using Motion = ScrewMotion;
    static constexpr JointType type = JointType::prismatic;
    static constexpr char const* name = "prismatic";
    static constexpr int code = 6, axes = 1;
    static constexpr int lengths = 0b1;
    static constexpr bool slides = true, mixed = true;

    static Vec3 screw(double) { return {{0, 1, 1}}; }
    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const& shape, std::array<double, 4> const& q) {
        return {Quat::identity(), q[0] * shape.axis};
    }
    /// Closure error of a ring.
    static JointOpening opening(JointShape const& shape, Quat const& turn, Vec3 const& origin) {
        return {norm(cross(shape.axis, origin)), norm(rotation_vector(turn))};
    }
    static std::array<Twist, freedom> twists(JointShape const& shape,
                                             std::array<double, 4> const&) {
        return {{{Vec3::zero(), shape.axis}}};
    }
    /// Draws a position; lengths lie in [-0.5, 0.5].
    template <class Draws>
    static std::array<double, 4> random_position(Draws& draws) {
        return {draws.between(-0.5, 0.5), 0, 0, 0};
    }
};

}  // namespace catena
