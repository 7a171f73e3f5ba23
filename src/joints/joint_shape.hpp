// Geometry that joint models compute on the host, and the properties that a model need not state.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "joints/joint_type.hpp"
#include "math/linear.hpp"
#include "math/rotation.hpp"

namespace catena {

/// Constants of a joint, as BodyArrays and TipJoint define them. A type ignores what it has not.
struct JointShape {
    /// Unit axis (universal: the second axis, B; planar3: the normal). First axis in J (universal:
    /// of rotation; planar3: of translation, perpendicular to `axis`).
    Vec3 axis, first_axis;
    /// Translation per radian of a helical joint.
    double pitch = 0;
};

/// Motion X(q) of the outboard body's frame B in the joint frame J.
struct JointDisplacement {
    Quat turn = Quat::identity();
    Vec3 shift = Vec3::zero();
};

/// Distance of the frame B from the nearest pose that a joint allows, and angle from it in rad.
struct JointOpening {
    double distance = 0, angle = 0;
};

/// Velocity of a body relative to a frame, in the frame's axes: angular, and linear of the point at
/// the frame's origin.
struct Twist {
    Vec3 angular = Vec3::zero(), linear = Vec3::zero();
};
/// Rotations about the three axes of a frame.
inline constexpr std::array<Twist, 3> rotations{
    {{{{1, 0, 0}}, {{0, 0, 0}}}, {{{0, 1, 0}}, {{0, 0, 0}}}, {{{0, 0, 1}}, {{0, 0, 0}}}}};

/// {c, s, rate}: a coordinate q rotates the joint by c rate q about its axis and slides it by
/// s rate q; c^2 + s^2 = 1 (LocalJoints::screw).
inline constexpr Vec3 pure_rotation{{1, 0, 1}};

/// Order of the directions of a joint's handles. Numbers 0-2 stand for forces along the joint's
/// axes, 3-5 for torques about them; a screw combines 2 and 5 (dca/joint_directions.hpp). The
/// directions that the joint restricts come first; the others are among the last three.
inline constexpr int usual_order = 0;  // 0 1 2 3 4 5
/// Returns the order with these directions at its places.
constexpr int in_order(std::array<int, 6> const& directions) {
    int order = 0;
    for (int i = 0; i < 6; ++i) order |= directions[static_cast<std::size_t>(i)] << 3 * i;
    return order;
}
/// Returns the direction at a place of an order.
CATENA_HD constexpr int direction_at(int order, int place) {
    return order == usual_order ? place : order >> 3 * place & 7;
}

/// Effect of a joint on the normal of a plane in which the bodies before it move. breaks: the
/// bodies after it leave the plane. starts: no joint before it, so any plane may follow. carries:
/// the normal is fixed in both bodies. turns: the bodies stay in the plane if the axis is normal to
/// it.
enum class PlaneRole : std::uint8_t { breaks, starts, carries, turns };

/// Properties of a joint model, with the values that hold unless the model states others.
struct JointDefaults {
    /// Degrees of freedom of a body on this joint, and number of directions that the joint
    /// restricts.
    static constexpr int freedom = 1, restricted = 5;
    /// Number of components of torque, stiffness and damping, and of the rates qd.
    static constexpr int numbers = 1, rates = 1;
    /// Number of axes that a scene gives.
    static constexpr int axes = 0;
    /// True if q is a unit quaternion.
    static constexpr bool quaternion = false;
    /// Bit i is set if coordinate i is a length.
    static constexpr int lengths = 0;
    /// Order of the directions of the joint's handles; direction 5 stays last.
    static constexpr int order = usual_order;
    /// True if the joint translates, and if it does so by a pitch as it rotates.
    static constexpr bool slides = false, pitched = false;
    /// True if the joint translates along its first two axes, across the last one.
    static constexpr bool glides = false;
    /// True if the joint rotates about two axes, the first one fixed in the inboard body, the
    /// second one in the outboard body.
    static constexpr bool turns_twice = false;
    /// True for the joint that attaches body 1 of a free base to nothing.
    static constexpr bool floats = false;
    /// True for a rod of fixed length between two points.
    static constexpr bool rod = false;
    /// True if the joint rotates about every axis, with rates and torques as vectors in B.
    static constexpr bool ball = false;
    /// True if the joint rotates about one axis and does nothing else.
    static constexpr bool pivots = false;
    /// True if the joint allows no motion.
    static constexpr bool rigid = false;
    /// True if the solvers in absolute coordinates support the joint.
    static constexpr bool absolute = false;
    /// True if random chains of kind `mixed` contain it. A type that is added later stays out:
    /// the chains of a seed must not change.
    static constexpr bool mixed = false;
    /// Name of the type for chains that promise to move in a plane; null if there is none.
    static constexpr char const* name_in_plane = nullptr;
    static constexpr PlaneRole plane = PlaneRole::breaks;

    /// Screw {c, s, rate} of the joint, see pure_rotation.
    static Vec3 screw(double) { return pure_rotation; }
    /// Closure error of a ring: `turn` and `origin` are the pose of B in J.
    static JointOpening opening(JointShape const&, Quat const&, Vec3 const& origin) {
        return {norm(origin), 0};
    }
    /// Twists that span the motion of B relative to J at position q, as many as `freedom`. A link
    /// lists none.
    static std::array<Twist, 0> twists(JointShape const&, std::array<double, 4> const&) {
        return {};
    }
    /// Position of a joint without coordinates; draws nothing.
    template <class Draws>
    static std::array<double, 4> random_position(Draws&) {
        return {0, 0, 0, 0};
    }
};

/// Draws a uniform angle in [-pi, pi].
template <class Draws>
double random_angle(Draws& draws) {
    return draws.between(-Draws::pi, Draws::pi);
}
/// Draws a uniform rotation as a unit quaternion.
template <class Draws>
std::array<double, 4> random_quaternion(Draws& draws) {
    Quat const q = draws.rotation();
    return {q.w, q.x, q.y, q.z};
}
/// Sine of the angle between a joint's axis on both of its sides.
inline double tilt_of(Vec3 const& axis, Quat const& turn) {
    return norm(cross(axis, to_matrix(turn) * axis));
}

}  // namespace catena
