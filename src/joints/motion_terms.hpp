// Functions of joint motions for one body or several side by side, on host and device.
//
// A motion reads its joint through an accessor `Joint` (JointAt in kinematics/joint_motion.hpp):
// axis(), axes() and first_axis() in the meeting frame M, screw(), coordinate(i), quaternion(),
// rate(i) and rates(); has_screws(), floats() and pivots() say what the chain's joints need. Its
// types are Real, Vector3 and Rotation.
#pragma once

#include "joints/joint_shape.hpp"
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
    /// Translation of the outboard side along the joint's coordinates, J.
    template <class Joint>
    static CATENA_HD typename Joint::Vector3 shift(Joint const&) {
        return Joint::Vector3::zero();
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
    /// Sets omega of a motion and returns true if omega needs no rate() and the velocity is zero.
    /// Otherwise the caller derives both from rate().
    template <class Joint, class Motion>
    static CATENA_HD bool sets_omega(Joint const&, Motion&) {
        return false;
    }
};

}  // namespace catena
