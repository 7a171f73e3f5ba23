// What acts on bodies besides the joints' constraints, as the scene gives it.
#pragma once

#include <cmath>

#include "chain/joint_kinematics.hpp"

namespace catena {

/// Joint torques, springs, dampers and wrenches of a group's bodies, and gravity. Fields are empty where no body has any.
struct BodyLoads {
    Vec3 gravity = Vec3::zero();          // W
    Field<3> torque, stiffness, damping;  // rules of BodyArrays
    Field<4> rest;
    Field<3> wrench_torque, wrench_force;  // W, at the centre of mass
    Field<2> drag;                         // {linear, angular}
    bool joint_loads = false, springs = false, dampers = false, wrenches = false, dragged = false;
};
BodyLoads make_body_loads(ChainGroup const&, Scene const&);

/// Of a body: sqrt(tr J / (2 m)).
inline double radius_of_gyration(Sym3 const& inertia, double mass) {
    return std::sqrt(0.5 * (inertia.data[0] + inertia.data[2] + inertia.data[5]) / mass);
}

/// Torque of the spring (and damper) of a spherical joint on the outboard body, B. The energy is 1/2 sum k_i theta_i^2, theta the
/// rotation vector of B from `rest`; its gradient turns with the inverse right Jacobian of SO(3) (Sola et al., "A micro Lie theory", 2018,
/// eq 144).
Vec3 spherical_spring_torque(Vec3 const& stiffness, Quat const& rest, Quat const& turn);
/// 1/2 sum k_i theta_i^2.
double spherical_spring_energy(Vec3 const& stiffness, Quat const& rest, Quat const& turn);

}  // namespace catena
