#include "scene/pose.hpp"

#include <optional>

namespace catena::scene {

namespace {

double constexpr printed_digits = 1e-6;

/// Follows one axis along the chain: in the axes of the body that was added last.
class ParallelAxes {
  public:
    /// Whether the joint leaves all axes so far parallel. `rotation`: of J in the inboard body.
    bool add(JointType type, Vec3 const& axis, Mat3 const& rotation) {
        if (type == JointType::free) return !axis_;
        if (type == JointType::weld) {
            if (axis_) axis_ = transposed_times(rotation, *axis_);
            return true;
        }
        if (type != JointType::revolute) return false;
        bool const parallel = !axis_ || norm(cross(rotation * axis, *axis_)) <= printed_digits;
        axis_ = axis;
        return parallel;
    }
    bool any() const { return axis_.has_value(); }

  private:
    std::optional<Vec3> axis_;
};

}  // namespace

Pose operator*(Pose const& a, Pose const& b) {
    return {normalized(a.orientation * b.orientation), a.origin + to_matrix(a.orientation) * b.origin};
}

Pose joint_motion(JointType type, Vec3 const& axis, Vec3 const& first_axis, double pitch, std::array<double, 4> const& q) {
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
    Pose const motion = joint_motion(bodies.joint[k], bodies.axis[k], first_axis, pitch, bodies.q[k]);
    if (bodies.joint[k] == JointType::free) return {normalized(motion.orientation), bodies.free_position};
    Pose const frame{to_quaternion(bodies.rotation[k]), bodies.translation[k]};
    return (k == 0 ? Pose{} : inboard) * frame * motion;
}

int coordinates_of(JointType type) {
    switch (type) {
        case JointType::free:
            return 6;
        case JointType::link:
            return 5;
        case JointType::spherical:
            return 3;
        case JointType::universal:
            return 2;
        case JointType::revolute:
        case JointType::prismatic:
        case JointType::helical:
            return 1;
        case JointType::weld:
            break;
    }
    return 0;
}

bool axes_are_parallel(ChainSpec const& chain, std::size_t& first_odd) {
    BodyArrays const& bodies = chain.bodies;
    ParallelAxes axes;
    for (first_odd = 0; first_odd < bodies.size(); ++first_odd)
        if (!axes.add(bodies.joint[first_odd], bodies.axis[first_odd], bodies.rotation[first_odd])) return false;
    if (chain.tip == Tip::jointed && !axes.add(chain.tip_joint.type, chain.tip_joint.axis, chain.tip_joint.rotation)) return false;
    return axes.any();
}

}  // namespace catena::scene
