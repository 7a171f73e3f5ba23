// Implements joint motions and the composition of poses.
#include "scene/pose.hpp"

namespace catena::scene {

Pose operator*(Pose const& a, Pose const& b) {
    return {normalized(a.orientation * b.orientation),
            a.origin + to_matrix(a.orientation) * b.origin};
}

Pose joint_motion(JointType type, Vec3 const& axis, Vec3 const& first_axis, double pitch,
                  std::array<double, 4> const& q) {
    switch (type) {
        case JointType::revolute:
            return {from_axis_angle(axis, q[0]), Vec3::zero()};
        case JointType::prismatic:
            return {Quat::identity(), q[0] * axis};
        case JointType::helical:
            return {from_axis_angle(axis, q[0]), (pitch * q[0]) * axis};
        case JointType::universal:
            return {from_axis_angle(first_axis, q[0]) * from_axis_angle(axis, q[1]), Vec3::zero()};
        case JointType::spherical:
        case JointType::free:
            return {{q[0], q[1], q[2], q[3]}, Vec3::zero()};
        case JointType::weld:
        case JointType::link:
            break;
    }
    return {};
}

Pose next_pose(BodyArrays const& bodies, std::size_t k, Pose const& inboard) {
    Vec3 const first_axis = bodies.first_axis.empty() ? Vec3::zero() : bodies.first_axis[k];
    double const pitch = bodies.pitch.empty() ? 0 : bodies.pitch[k];
    Pose const motion =
        joint_motion(bodies.joint[k], bodies.axis[k], first_axis, pitch, bodies.q[k]);
    if (bodies.joint[k] == JointType::free)
        return {normalized(motion.orientation), bodies.free_position};
    Pose const frame{to_quaternion(bodies.rotation[k]), bodies.translation[k]};
    return (k == 0 ? Pose{} : inboard) * frame * motion;
}

}  // namespace catena::scene
