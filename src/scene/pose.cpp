// Implements joint motions and the composition of poses.
#include "scene/pose.hpp"

#include "joints/joint_models.hpp"

namespace catena::scene {

Pose operator*(Pose const& a, Pose const& b) {
    return {normalized(a.orientation * b.orientation),
            a.origin + to_matrix(a.orientation) * b.origin};
}

Pose joint_motion(JointType type, Vec3 const& axis, Vec3 const& first_axis, double pitch,
                  std::array<double, 4> const& q) {
    JointDisplacement const motion = displacement_of(type, {axis, first_axis, pitch}, q);
    return {motion.turn, motion.shift};
}

Pose next_pose(BodyArrays const& bodies, std::size_t k, Pose const& inboard) {
    Vec3 const first_axis = bodies.first_axis.empty() ? Vec3::zero() : bodies.first_axis[k];
    double const pitch = bodies.pitch.empty() ? 0 : bodies.pitch[k];
    Pose const motion =
        joint_motion(bodies.joint[k], bodies.axis[k], first_axis, pitch, bodies.q[k]);
    if (floats(bodies.joint[k])) return {normalized(motion.orientation), bodies.free_base.position};
    Pose const frame{to_quaternion(bodies.rotation[k]), bodies.translation[k]};
    return (k == 0 ? Pose{} : inboard) * frame * motion;
}

}  // namespace catena::scene
