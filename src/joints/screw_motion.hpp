// Motion of joints with one coordinate about or along one axis, fixed in both bodies: revolute,
// prismatic and helical joints.
#pragma once

#include "joints/joint_shape.hpp"
#include "joints/motion_terms.hpp"

namespace catena {

// QuaternionMotion documents the functions.
struct ScrewMotion : MotionDefaults {
    template <class Joint>
    static CATENA_HD typename Joint::Rotation turn(Joint const& j) {
        auto const s = j.screw();
        return from_axis_angle(j.axis(), s[0] * s[2] * j.coordinate(0));
    }
    template <class Joint>
    static CATENA_HD JointRate<typename Joint::Real> rate(Joint const& j) {
        auto const qd = j.rates(), along = j.axis();
        auto const s = j.screw();
        return {(s[0] * s[2] * qd[0]) * along, (s[1] * s[2] * qd[0]) * along};
    }
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 shift(Joint const& j) {
        auto const s = j.screw();
        return (s[1] * s[2] * j.coordinate(0)) * j.axis();
    }
    template <class Joint, class Motion>
    static CATENA_HD bool sets_omega(Joint const& j, Motion& m) {
        if (!j.pivots()) return false;
        m.omega = j.rate(0) * j.axis();  // The axis has the same components in B and M.
        return true;
    }
    template <class Joint, class Turn>
    static CATENA_HD Vector<typename Joint::Real, 4> load(Joint const& j, Turn const&,
                                                          typename Joint::Vector3 const& along) {
        typename Joint::Real const none(0);
        auto const s = j.screw();
        return {{none, none, s[0] / s[2] * along[0], s[1] / s[2] * along[0]}};
    }
    template <class Joint, class Turn>
    static CATENA_HD int free_motions(Joint const& j, Turn const&, Mat3& motions) {
        motions.set_column(0, Vec3{{0, 0, j.screw()[2]}});
        return 1;
    }
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 with_prescribed(Joint const& j, Vec3 const& qdd,
                                                             typename Joint::Vector3 const& angular,
                                                             typename Joint::Vector3& linear) {
        auto const axis = j.axes().column(2);
        auto const s = j.screw();
        linear = plus_scaled(linear, s[1] * s[2] * qdd[0], axis);
        return plus_scaled(angular, s[0] * s[2] * qdd[0], axis);
    }
    /// Second derivatives of the coordinates. `relative_alpha` is the outboard minus the inboard
    /// angular acceleration along the joint's axes; if the joint glides, its first two components
    /// are the acceleration of the meeting points. `relative_slide` is that of the meeting points
    /// along the last axis. `drift` computes the velocity-dependent relative acceleration, M.
    template <class Joint, class Drift>
    static CATENA_HD typename Joint::Vector3 acceleration(
        Joint const& j, typename Joint::Vector3 const& relative_alpha,
        typename Joint::Real const& relative_slide, Drift const&) {
        typename Joint::Real const none(0);
        if (!j.has_screws()) return {{relative_alpha[2], none, none}};
        auto const s = j.screw();
        return {{(s[0] * relative_alpha[2] + s[1] * relative_slide) / s[2], none, none}};
    }
};

}  // namespace catena
