// Joint model of a helical joint: rotation by q about one axis, and translation by pitch q along
// it.
#pragma once

#include "joints/screw_motion.hpp"

namespace catena {

/// Helical joint. Its coordinate is the angle; handles follow the screw {c, s}.
struct HelicalJoint : JointDefaults {
    using Motion = ScrewMotion;
    static constexpr JointType type = JointType::helical;
    static constexpr char const* name = "helical";
    static constexpr int code = 7, axes = 1;
    static constexpr bool slides = true, pitched = true, mixed = true;

    static Vec3 screw(double pitch) {
        double const rate = std::hypot(1.0, pitch);
        return {{1 / rate, pitch / rate, rate}};
    }
    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const& shape, std::array<double, 4> const& q) {
        return {from_axis_angle(shape.axis, q[0]), (shape.pitch * q[0]) * shape.axis};
    }
    /// The motion repeats after each rotation by 2 pi: only the remainder of its translation
    /// counts.
    static JointOpening opening(JointShape const& shape, Quat const& turn, Vec3 const& origin) {
        double const a_turn = 2 * std::acos(-1.0) * std::abs(shape.pitch);
        double const along =
            dot(shape.axis, origin) - shape.pitch * dot(shape.axis, rotation_vector(turn));
        return {std::hypot(norm(cross(shape.axis, origin)), std::remainder(along, a_turn)),
                tilt_of(shape.axis, turn)};
    }
    static std::array<Twist, freedom> twists(JointShape const& shape,
                                             std::array<double, 4> const&) {
        return {{{shape.axis, shape.pitch * shape.axis}}};
    }
    /// Draws a position; angles and rotations are uniform.
    template <class Draws>
    static std::array<double, 4> random_position(Draws& draws) {
        return {random_angle(draws), 0, 0, 0};
    }
};

}  // namespace catena
