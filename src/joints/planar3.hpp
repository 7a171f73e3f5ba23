// Joint model of a planar joint with three degrees of freedom: translation by q[0] along the first
// axis and by q[1] along the second one, both fixed in the inboard body, then rotation by q[2]
// about their normal.
#pragma once

#include "joints/motion_terms.hpp"

namespace catena {

// QuaternionMotion documents the functions. The joint's axes are the two of its translations and
// the normal.
struct PlanarMotion : MotionDefaults {
    template <class Joint>
    static CATENA_HD typename Joint::Rotation turn(Joint const& j) {
        return from_axis_angle(j.axis(), j.coordinate(2));
    }
    template <class Joint>
    static CATENA_HD JointRate<typename Joint::Real> rate(Joint const& j) {
        auto const qd = j.rates();
        auto const axes = j.axes();
        return {qd[2] * axes.column(2), qd[0] * axes.column(0) + qd[1] * axes.column(1)};
    }
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 shift(Joint const& j) {
        auto const axes = j.axes();
        return j.coordinate(0) * axes.column(0) + j.coordinate(1) * axes.column(1);
    }
    template <class Joint, class Turn>
    static CATENA_HD Vector<typename Joint::Real, 4> load(Joint const&, Turn const&,
                                                          typename Joint::Vector3 const& along) {
        return {{along[0], along[1], along[2], typename Joint::Real(0)}};
    }
    template <class Joint, class Turn>
    static CATENA_HD int free_motions(Joint const&, Turn const&, Mat3& motions) {
        motions = Mat3::identity();
        return 3;
    }
    /// Second derivatives of the coordinates, see ScrewMotion.
    template <class Joint, class Drift>
    static CATENA_HD typename Joint::Vector3 acceleration(Joint const& j,
                                                          typename Joint::Vector3 const& relative,
                                                          typename Joint::Real const&,
                                                          Drift const& drift) {
        auto const linear = transposed_times(j.axes(), drift().linear);
        return {{relative[0] - linear[0], relative[1] - linear[1], relative[2]}};
    }
};

/// Planar joint with three degrees of freedom. Its coordinates are two lengths and an angle.
struct Planar3Joint : JointDefaults {
    using Motion = PlanarMotion;
    static constexpr JointType type = JointType::planar3;
    static constexpr char const* name = "planar3";
    static constexpr int code = 9, freedom = 3, restricted = 3, numbers = 3, rates = 3, axes = 2;
    static constexpr int lengths = 0b11, order = in_order({3, 4, 2, 0, 1, 5});
    static constexpr bool slides = true, glides = true;
    static constexpr PlaneRole plane = PlaneRole::turns;

    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const& shape, std::array<double, 4> const& q) {
        return {from_axis_angle(shape.axis, q[2]),
                q[0] * shape.first_axis + q[1] * cross(shape.axis, shape.first_axis)};
    }
    /// Closure error of a ring.
    static JointOpening opening(JointShape const& shape, Quat const& turn, Vec3 const& origin) {
        return {std::abs(dot(shape.axis, origin)), tilt_of(shape.axis, turn)};
    }
    /// The rotation about J's origin, with the translations, is any rotation in the plane.
    static std::array<Twist, freedom> twists(JointShape const& shape,
                                             std::array<double, 4> const&) {
        return {{{Vec3::zero(), shape.first_axis},
                 {Vec3::zero(), cross(shape.axis, shape.first_axis)},
                 {shape.axis, Vec3::zero()}}};
    }
    /// Draws a position: lengths in [-0.5, 0.5], and a uniform angle.
    template <class Draws>
    static std::array<double, 4> random_position(Draws& draws) {
        double const x = draws.between(-0.5, 0.5), y = draws.between(-0.5, 0.5);
        return {x, y, random_angle(draws), 0};
    }
};

}  // namespace catena
