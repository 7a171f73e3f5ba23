// Poses of bodies in joint coordinates: the joints' own motions and their composition.
#pragma once

#include <cmath>

#include "math/rotation.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Orientation and origin of a frame relative to another frame.
struct Pose {
    Quat orientation = Quat::identity();
    Vec3 origin = Vec3::zero();
};
/// Composition X_AC = X_AB X_BC.
Pose operator*(Pose const& a, Pose const& b);

/// X(q) of B in J, as BodyArrays defines it. For a free joint q holds the quaternion; the origin is
/// zero. A weld and a link have the identity.
Pose joint_motion(JointType type, Vec3 const& axis, Vec3 const& first_axis, double pitch,
                  std::array<double, 4> const& q);

/// Pose in W of body k + 1, given that of body k (ignored if k = 0).
Pose next_pose(BodyArrays const& bodies, std::size_t k, Pose const& inboard);

/// Coordinate, rate and acceleration of a prescribed motion at time t.
CATENA_HD double value_at(PrescribedMotion const& c, double t) {
    return c.offset + c.rate * t +
           c.amplitude * cos_sin(6.283185307179586476925 * c.frequency * t + c.phase).sin;
}
CATENA_HD double rate_at(PrescribedMotion const& c, double t) {
    double const omega = 6.283185307179586476925 * c.frequency;
    return c.rate + c.amplitude * omega * cos_sin(omega * t + c.phase).cos;
}
CATENA_HD double acceleration_at(PrescribedMotion const& c, double t) {
    double const omega = 6.283185307179586476925 * c.frequency;
    return -c.amplitude * omega * omega * cos_sin(omega * t + c.phase).sin;
}

}  // namespace catena::scene
