// What acts on bodies besides the joints' constraints, as the scene gives it.
#pragma once

#include <cmath>

#include "chain/chain_group.hpp"

namespace catena {

/// Joint torques, springs, dampers and wrenches of a group's bodies, and gravity. Fields are empty
/// where no body has any.
struct BodyLoads {
    Vec3 gravity = Vec3::zero();          // W
    Field<3> torque, stiffness, damping;  // rules of BodyArrays
    Field<4> rest;
    Field<3> wrench_torque, wrench_force;  // W, at the centre of mass
    Field<2> drag;                         // {linear, angular}
    bool joint_loads = false, springs = false, dampers = false, wrenches = false, dragged = false;
};
BodyLoads make_body_loads(ChainGroup const&, Scene const&);

/// The same as plain pointers.
struct BodyLoadsView {
    Vec3 gravity;
    ConstView<3> torque, stiffness, damping;
    ConstView<4> rest;
    ConstView<3> wrench_torque, wrench_force;
    ConstView<2> drag;
    bool joint_loads = false, springs = false, dampers = false, wrenches = false, dragged = false;
};
/// BodyLoads in a Space; these must outlive it.
template <class Space>
class BodyLoadsIn {
  public:
    explicit BodyLoadsIn(BodyLoads const& host)
        : host_(host),
          torque_(host.torque),
          stiffness_(host.stiffness),
          damping_(host.damping),
          wrench_torque_(host.wrench_torque),
          wrench_force_(host.wrench_force),
          rest_(host.rest),
          drag_(host.drag) {}
    BodyLoadsView view() const {
        return {host_.gravity,     torque_.view(),        stiffness_.view(),    damping_.view(),
                rest_.view(),      wrench_torque_.view(), wrench_force_.view(), drag_.view(),
                host_.joint_loads, host_.springs,         host_.dampers,        host_.wrenches,
                host_.dragged};
    }

  private:
    BodyLoads const& host_;
    typename Space::template Fixed<3> torque_, stiffness_, damping_, wrench_torque_, wrench_force_;
    typename Space::template Fixed<4> rest_;
    typename Space::template Fixed<2> drag_;
};

/// Of a body: sqrt(tr J / (2 m)).
inline double radius_of_gyration(Sym3 const& inertia, double mass) {
    return std::sqrt(0.5 * (inertia.data[0] + inertia.data[2] + inertia.data[5]) / mass);
}

/// Torque of the spring (and damper) of a spherical joint on the outboard body, B. The energy is
/// 1/2 sum k_i theta_i^2, theta the rotation vector of B from `rest`; its gradient turns with the
/// inverse right Jacobian of SO(3) (Sola et al., "A micro Lie theory", 2018, eq 144).
CATENA_HD Vec3 spherical_spring_torque(Vec3 const& stiffness, Quat const& rest, Quat const& turn) {
    Vec3 const theta = rotation_vector(conjugate(rest) * turn);
    Vec3 const k_theta{{stiffness[0] * theta[0], stiffness[1] * theta[1], stiffness[2] * theta[2]}};
    double const angle = norm(theta);
    CosSin const half = cos_sin(0.5 * angle);
    // (1 - (angle/2) cot(angle/2)) / angle^2, 1/12 for small angles
    double const c = angle > 1e-3 ? (1.0 - 0.5 * angle * half.cos / half.sin) / (angle * angle)
                                  : 1.0 / 12.0 + angle * angle / 720.0;
    Vec3 const t1 = cross(theta, k_theta), t2 = cross(theta, t1);
    return -1.0 * (k_theta - 0.5 * t1 + c * t2);
}
/// 1/2 sum k_i theta_i^2.
double spherical_spring_energy(Vec3 const& stiffness, Quat const& rest, Quat const& turn);

}  // namespace catena
