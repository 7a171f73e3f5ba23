// Joint model of a cylindrical joint: rotation by q[0] about one axis, and translation by q[1]
// along it.
#pragma once

#include "joints/motion_terms.hpp"

namespace catena {

// QuaternionMotion documents the functions.
struct CylindricalMotion : MotionDefaults {
    template <class Joint>
    static CATENA_HD typename Joint::Rotation turn(Joint const& j) {
        return from_axis_angle(j.axis(), j.coordinate(0));
    }
    template <class Joint>
    static CATENA_HD JointRate<typename Joint::Real> rate(Joint const& j) {
        auto const qd = j.rates(), along = j.axis();
        return {qd[0] * along, qd[1] * along};
    }
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 shift(Joint const& j) {
        return j.coordinate(1) * j.axis();
    }
    template <class Joint, class Turn>
    static CATENA_HD Vector<typename Joint::Real, 4> load(Joint const&, Turn const&,
                                                          typename Joint::Vector3 const& along) {
        typename Joint::Real const none(0);
        return {{none, none, along[0], along[1]}};
    }
    template <class Joint, class Turn>
    static CATENA_HD int free_motions(Joint const&, Turn const&, Mat3& motions) {
        motions.set_column(0, Vec3{{0, 0, 1}});
        motions.set_column(1, Vec3{{0, 1, 0}});
        return 2;
    }
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 with_prescribed(Joint const& j, Vec3 const& qdd,
                                                             typename Joint::Vector3 const& angular,
                                                             typename Joint::Vector3& linear) {
        auto const axis = j.axes().column(2);
        linear = plus_scaled(linear, qdd[1], axis);
        return plus_scaled(angular, qdd[0], axis);
    }
    /// Second derivatives of the coordinates, see ScrewMotion.
    template <class Joint, class Drift>
    static CATENA_HD typename Joint::Vector3 acceleration(
        Joint const&, typename Joint::Vector3 const& relative_alpha,
        typename Joint::Real const& relative_slide, Drift const&) {
        return {{relative_alpha[2], relative_slide, typename Joint::Real(0)}};
    }
};

/// Cylindrical joint. Its coordinates are an angle and a length.
struct CylindricalJoint : JointDefaults {
    using Motion = CylindricalMotion;
    static constexpr JointType type = JointType::cylindrical;
    static constexpr char const* name = "cylindrical";
    static constexpr int code = 8, freedom = 2, restricted = 4, numbers = 2, rates = 2, axes = 1;
    static constexpr int lengths = 0b10, order = in_order({0, 1, 4, 3, 2, 5});
    static constexpr bool slides = true;

    /// X(q) of B in J.
    static JointDisplacement displacement(JointShape const& shape, std::array<double, 4> const& q) {
        return {from_axis_angle(shape.axis, q[0]), q[1] * shape.axis};
    }
    /// Closure error of a ring.
    static JointOpening opening(JointShape const& shape, Quat const& turn, Vec3 const& origin) {
        return {norm(cross(shape.axis, origin)), tilt_of(shape.axis, turn)};
    }
    static std::array<Twist, freedom> twists(JointShape const& shape,
                                             std::array<double, 4> const&) {
        return {{{shape.axis, Vec3::zero()}, {Vec3::zero(), shape.axis}}};
    }
    /// Draws a position: a uniform angle, and a length in [-0.5, 0.5].
    template <class Draws>
    static std::array<double, 4> random_position(Draws& draws) {
        double const angle = random_angle(draws);
        return {angle, draws.between(-0.5, 0.5), 0, 0};
    }
};

}  // namespace catena
