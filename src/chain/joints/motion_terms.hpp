// Functions of joint motions for one body or several side by side, on host and device.
//
// A motion reads its joint through an accessor `Joint` (JointAt in kinematics/joint_motion.hpp):
// axis(), axes() and first_axis() in the meeting frame M, screw(), coordinate(i), quaternion(),
// rate(i), rates() and type(), with the types Real, Vector3, Matrix3 and Rotation.
#pragma once

#include "chain/joints/joint_shape.hpp"
#include "math/linear.hpp"
#include "math/rotation.hpp"

namespace catena {

/// Relative motion that a joint's rates q' produce: angular and linear velocity of the outboard
/// side relative to the inboard side, M axes.
template <class Real>
struct JointRate {
    Vector<Real, 3> angular, linear;
};

/// Functions of a motion that need no statement of its own.
struct MotionDefaults {
    /// Rotation of the meeting frame M in the inboard body's axes; `frame` is that of J.
    template <class Joint>
    static CATENA_HD typename Joint::Rotation meeting(Joint const&,
                                                      typename Joint::Rotation const& frame) {
        return frame;
    }
    /// Adds the relative angular acceleration that rates produce in axes that move in both bodies.
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 with_drift(Joint const&,
                                                        typename Joint::Vector3 const& angular) {
        return angular;
    }
    /// Adds prescribed second derivatives of the coordinates to a relative acceleration, M.
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 with_prescribed(Joint const&, Vec3 const&,
                                                             typename Joint::Vector3 const& angular,
                                                             typename Joint::Vector3&) {
        return angular;
    }
    /// Sets omega and velocity of `motion`, a motion whose rotation is B in M, from the joint's
    /// rate; B axes.
    template <class Rate, class Rotation, class Motion>
    static CATENA_HD void set_from_rate(Rate const& rate, Rotation const& turn, Motion& motion) {
        auto const to_meeting = to_matrix(turn);
        motion.omega = transposed_times(to_meeting, rate.angular);
        motion.velocity = transposed_times(to_meeting, rate.linear);
    }
};

}  // namespace catena
