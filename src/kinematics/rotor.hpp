// Free rotation of a rigid body, on host and device, by the NO_SQUISH scheme (Miller, Eleftheriou,
// Pattnaik, Ndirango, Newns, Martyna, J. Chem. Phys. 116, 8649, 2002). It rotates about the
// principal axes in the order 1 2 3 2 1 and is symplectic and reversible. Here it is written with
// the angular momentum in body axes instead of the quaternion's conjugate momentum.
#pragma once

#include "math/rotation.hpp"

namespace catena {

/// Principal frame P of a body: quaternion of P in B, and the moments of inertia about its axes
/// (amu nm^2).
struct PrincipalFrame {
    Quat rotation;
    Vec3 moments;
};

/// Orientation and angular velocity of a body.
struct RotorState {
    Quat orientation;  // Quaternion of B in W.
    Vec3 omega;        // Angular velocity, B axes, rad/ps.
};

/// Rotates about principal axis `axis` for time h. `q` is the quaternion of P in W, `momentum` the
/// angular momentum in P axes; both are updated.
CATENA_HD void turn_about(int axis, double h, Vec3 const& moments, Quat& q, Vec3& momentum) {
    double const angle = h * momentum[axis] / moments[axis];
    auto const [c, s] = cos_sin(angle);
    int const i = (axis + 1) % 3, j = (axis + 2) % 3;
    double const li = momentum[i], lj = momentum[j];
    momentum[i] = fused(c, li, s * lj);
    momentum[j] = fused(c, lj, -(s * li));
    Vec3 unit = Vec3::zero();
    unit[axis] = 1.0;
    q = q * from_axis_angle(unit, angle);
}

/// The state after time h without torque. The error is of third order in h per step; the angular
/// momentum in W is conserved to rounding.
CATENA_HD RotorState free_rotor(PrincipalFrame const& frame, RotorState const& start, double h) {
    Quat q = start.orientation * frame.rotation;
    Mat3 const to_body = to_matrix(frame.rotation);
    Vec3 momentum = transposed_times(to_body, start.omega);
    for (int i = 0; i < 3; ++i) momentum[i] = frame.moments[i] * momentum[i];
    turn_about(0, 0.5 * h, frame.moments, q, momentum);
    turn_about(1, 0.5 * h, frame.moments, q, momentum);
    turn_about(2, h, frame.moments, q, momentum);
    turn_about(1, 0.5 * h, frame.moments, q, momentum);
    turn_about(0, 0.5 * h, frame.moments, q, momentum);
    for (int i = 0; i < 3; ++i) momentum[i] = momentum[i] / frame.moments[i];
    return {normalized(q * conjugate(frame.rotation)), to_body * momentum};
}

}  // namespace catena
