// Motion of joints whose position is a unit quaternion: spherical joints and free bodies.
#pragma once

#include "joints/joint_shape.hpp"
#include "joints/motion_terms.hpp"

namespace catena {

struct QuaternionMotion : MotionDefaults {
    /// Rotation of B in M.
    template <class Joint>
    static CATENA_HD typename Joint::Rotation turn(Joint const& j) {
        return j.quaternion();
    }
    /// Velocity of the outboard side relative to the inboard side, M axes.
    template <class Joint>
    static CATENA_HD JointRate<typename Joint::Real> rate(Joint const& j) {
        return {to_matrix(turn(j)) * j.rates(), Joint::Vector3::zero()};
    }
    /// Sets omega of a motion, B axes, and returns true (MotionDefaults).
    template <class Joint, class Motion>
    static CATENA_HD bool sets_omega(Joint const& j, Motion& m) {
        m.omega = j.rates();
        return true;
    }
    /// Known load on the outboard body along the joint's axes: torque, and force along the last
    /// axis. If the joint glides, the first two components are forces. `along` has the moments
    /// along the coordinates; `turn` is the rotation matrix of B.
    template <class Joint, class Turn>
    static CATENA_HD Vector<typename Joint::Real, 4> load(Joint const& j, Turn const& turn,
                                                          typename Joint::Vector3 const& along) {
        using Real = typename Joint::Real;
        if (j.floats()) return Vector<Real, 4>::zero();
        auto const t = transposed_times(j.axes(), turn() * along);
        return {{t[0], t[1], t[2], Real(0)}};
    }
    /// Sets the columns of P, motion along the last three directions of the joint's handles per
    /// unit rate of each coordinate. Returns the number of coordinates.
    template <class Joint, class Turn>
    static CATENA_HD int free_motions(Joint const& j, Turn const& turn, Mat3& motions) {
        motions = transposed_times(j.axes(), turn());
        return 3;
    }
};

}  // namespace catena
