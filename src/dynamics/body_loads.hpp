// Forces on bodies other than the joints' constraints, as the scene specifies them. Frames: W
// ground axes, B body axes.
#pragma once

#include <cmath>

#include "chain/chain_group.hpp"

namespace catena {

/// Joint torques, springs, dampers, external wrenches and drag of a group's bodies, and gravity.
/// Fields are empty if no body has such a load.
struct BodyLoads {
    Vec3 gravity = Vec3::zero();          // W, nm/ps^2.
    Field<3> torque, stiffness, damping;  // One number per joint coordinate, as in BodyArrays.
    Field<4> rest;
    /// External torque and force at the centre of mass, W.
    Field<3> wrench_torque, wrench_force;
    Field<2> drag;  // {linear, angular}: amu/ps and amu nm^2/ps.
    /// Kinds of load that occur in the group; joint_loads includes springs and dampers.
    bool joint_loads = false, springs = false, dampers = false, wrenches = false, dragged = false;
};
/// Loads of the group's local bodies. Bodies on links have gravity only, besides forces on their
/// beads.
BodyLoads make_body_loads(ChainGroup const&, Scene const&);

/// Plain pointers to the fields of BodyLoads, for loops over bodies.
struct BodyLoadsView {
    Vec3 gravity;
    ConstView<3> torque, stiffness, damping;
    ConstView<4> rest;
    ConstView<3> wrench_torque, wrench_force;
    ConstView<2> drag;
    bool joint_loads = false, springs = false, dampers = false, wrenches = false, dragged = false;
};
/// BodyLoads copied to a Space. The host's BodyLoads must outlive it.
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

/// Radius of gyration of a body: sqrt(tr J / (2 m)).
inline double radius_of_gyration(Sym3 const& inertia, double mass) {
    return std::sqrt(0.5 * (inertia.data[0] + inertia.data[2] + inertia.data[5]) / mass);
}

/// Torque of a spherical joint's spring on the outboard body, B. `rotation` is the rotation of B in
/// the joint frame. The energy is 1/2 sum k_i theta_i^2, with theta the rotation vector of B from
/// `rest`. Its gradient contains the inverse right Jacobian of SO(3) (Sola et al., "A micro Lie
/// theory", 2018, eq 144).
CATENA_HD Vec3 spherical_spring_torque(Vec3 const& stiffness, Quat const& rest,
                                       Quat const& rotation) {
    Vec3 const theta = rotation_vector(conjugate(rest) * rotation);
    Vec3 const k_theta{{stiffness[0] * theta[0], stiffness[1] * theta[1], stiffness[2] * theta[2]}};
    double const angle = norm(theta);
    CosSin const half = cos_sin(0.5 * angle);
    // Coefficient (1 - (angle/2) cot(angle/2)) / angle^2, with its series (1/12 + ...) for small
    // angles.
    double const c = angle > 1e-3 ? (1.0 - 0.5 * angle * half.cos / half.sin) / (angle * angle)
                                  : 1.0 / 12.0 + angle * angle / 720.0;
    Vec3 const t1 = cross(theta, k_theta), t2 = cross(theta, t1);
    return -1.0 * (k_theta - 0.5 * t1 + c * t2);
}
/// Energy of a spherical joint's spring: 1/2 sum k_i theta_i^2.
double spherical_spring_energy(Vec3 const& stiffness, Quat const& rest, Quat const& rotation);

}  // namespace catena
