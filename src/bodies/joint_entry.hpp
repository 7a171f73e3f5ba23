// One `joint: {...}`: its type, its place and what acts in it.
#pragma once

#include <array>
#include <vector>

#include "scene/fields.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// What a joint says, with the defaults of what it does not say. The members mean what BodyArrays
/// says of them.
struct JointEntry {
    JointType type = JointType::free;
    bool planar = false;  // written `planar`: a revolute joint in a chain of parallel axes
    Vec3 axis = Vec3::zero(), first_axis = Vec3::zero(), translation = Vec3::zero();
    double pitch = 0;
    Mat3 rotation = Mat3::identity();
    std::array<double, 4> q{0, 0, 0, 0}, rest{0, 0, 0, 0};
    Vec3 qd = Vec3::zero(), torque = Vec3::zero(), stiffness = Vec3::zero(), damping = Vec3::zero();
    Vec3 position = Vec3::zero(), velocity = Vec3::zero();  // free
    std::vector<PrescribedMotion> motion;                   // empty: not driven
    bool loaded = false, sprung = false,
         damped = false;  // torque; stiffness or rest; damping is given
};

/// Any joint but a link. InputError for keys that mean nothing for the joint's type and for values
/// that are wrong in themselves.
JointEntry read_joint(Node const& joint);

/// The joint of `tip: {joint: ...}`: any type but free; a link needs its anchor. `ring`: that of
/// `tip: {ring: ...}`, which has neither anchor nor q; joints but links need their translation.
struct TipEntry {
    TipJoint joint;
    bool planar = false;
};
TipEntry read_tip_joint(Node const& joint, bool ring);

/// How many numbers a torque, stiffness or damping of the joint has: 1, 2 or 3; 0 for links, welds
/// and free joints.
int numbers_of(JointType type);

}  // namespace catena::scene
