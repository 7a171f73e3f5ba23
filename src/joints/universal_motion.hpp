// Motion of universal joints. Their meeting frame M is the joint frame J rotated by q[0] about the
// first axis.
#pragma once

#include "joints/joint_shape.hpp"
#include "joints/motion_terms.hpp"

namespace catena {

// QuaternionMotion documents the functions.
struct UniversalMotion : MotionDefaults {
    template <class Joint>
    static CATENA_HD typename Joint::Rotation turn(Joint const& j) {
        return from_axis_angle(j.axis(), j.coordinate(1));
    }
    template <class Joint>
    static CATENA_HD typename Joint::Rotation meeting(Joint const& j,
                                                      typename Joint::Rotation const& frame) {
        return frame * from_axis_angle(j.first_axis(), j.coordinate(0));
    }
    template <class Joint>
    static CATENA_HD JointRate<typename Joint::Real> rate(Joint const& j) {
        auto const qd = j.rates();
        return {qd[0] * j.first_axis() + qd[1] * j.axis(), Joint::Vector3::zero()};
    }
    /// The torque lies in the plane of the two axes.
    template <class Joint, class Turn>
    static CATENA_HD Vector<typename Joint::Real, 4> load(Joint const& j, Turn const&,
                                                          typename Joint::Vector3 const& along) {
        using Real = typename Joint::Real;
        auto const axes = j.axes();
        auto const first = j.first_axis(), second = axes.column(2);
        Real const g = dot(first, second), x = (along[0] - g * along[1]) / (Real(1) - g * g),
                   y = along[1] - g * x;
        auto const t = transposed_times(axes, plus_scaled(x * first, y, second));
        return {{t[0], t[1], t[2], Real(0)}};
    }
    template <class Joint, class Turn>
    static CATENA_HD int free_motions(Joint const& j, Turn const&, Mat3& motions) {
        motions.set_column(0, transposed_times(j.axes(), j.first_axis()));
        motions.set_column(1, Vec3{{0, 0, 1}});
        return 2;
    }
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 with_drift(Joint const& j,
                                                        typename Joint::Vector3 const& angular) {
        auto const qd = j.rates();
        return plus_scaled(angular, qd[0] * qd[1], cross(j.first_axis(), j.axes().column(2)));
    }
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 with_prescribed(Joint const& j, Vec3 const& qdd,
                                                             typename Joint::Vector3 const& angular,
                                                             typename Joint::Vector3&) {
        return angular + qdd[0] * j.first_axis() + qdd[1] * j.axes().column(2);
    }
    /// Second derivatives of the coordinates, see ScrewMotion.
    template <class Joint, class Drift>
    static CATENA_HD typename Joint::Vector3 acceleration(
        Joint const& j, typename Joint::Vector3 const& relative_alpha, typename Joint::Real const&,
        Drift const& drift) {
        auto const axes = j.axes();
        auto const relative = relative_alpha - transposed_times(axes, drift().angular);
        // First axis, (0, y, z) in the joint's axes, where the second axis is (0, 0, 1).
        auto const first = transposed_times(axes, j.first_axis());
        auto const u1 = relative[1] / first[1];
        return {{u1, relative[2] - first[2] * u1, typename Joint::Real(0)}};
    }
};

}  // namespace catena
