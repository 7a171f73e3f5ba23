// Motion of joints without coordinates: none.
#pragma once

#include "joints/joint_shape.hpp"
#include "joints/motion_terms.hpp"

namespace catena {

// QuaternionMotion documents the functions.
struct RigidMotion : MotionDefaults {
    template <class Joint>
    static CATENA_HD typename Joint::Rotation turn(Joint const&) {
        return Joint::Rotation::identity();
    }
    template <class Joint>
    static CATENA_HD JointRate<typename Joint::Real> rate(Joint const&) {
        return {Joint::Vector3::zero(), Joint::Vector3::zero()};
    }
    template <class Joint, class Motion>
    static CATENA_HD bool sets_omega(Joint const&, Motion&) {
        return true;
    }
    template <class Joint, class Turn>
    static CATENA_HD Vector<typename Joint::Real, 4> load(Joint const&, Turn const&,
                                                          typename Joint::Vector3 const&) {
        return Vector<typename Joint::Real, 4>::zero();
    }
    template <class Joint, class Turn>
    static CATENA_HD int free_motions(Joint const&, Turn const&, Mat3&) {
        return 0;
    }
    /// Second derivatives of the coordinates, see ScrewMotion.
    template <class Joint, class Drift>
    static CATENA_HD typename Joint::Vector3 acceleration(Joint const&,
                                                          typename Joint::Vector3 const&,
                                                          typename Joint::Real const&,
                                                          Drift const&) {
        return Joint::Vector3::zero();
    }
};

}  // namespace catena
