// What an evaluation of rigid chains in absolute coordinates found, on the host.
#pragma once

#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/body_loads.hpp"

namespace catena {

/// Energy of springs and gravity; `orientation` with its halo.
PotentialEnergy potential_of(ChainGroup const&, BodyLoads const&, Field<3> const& position,
                             Field<4> const& orientation);

/// What the last evaluate() of rigid chains found, on the host.
struct RigidSolution {
    ChainGroup const& group;
    ConstView<4> orientation;
    ConstView<3> omega, force, torque, moment, alpha, acceleration, direction, tip_direction;
    ConstDirectionsView bias, joint_force, tip_bias, tip_force;
    BodyResults results() const;
    /// Collective.
    double residual(Communicator const&) const;

  private:
    struct HandleAcceleration {
        Vec3 value;
        double terms;
    };
    Mat3 axes(std::int64_t k) const { return to_matrix(as_quaternion(orientation.load(k))); }
    /// Of the inboard joint on body k, W; of the tip's joint on the ground; on the outboard
    /// neighbour or the ground.
    Vec3 inboard_force(std::int64_t k) const;
    Vec3 force_of_tip(std::int64_t k) const;
    Vec3 outboard_force(std::int64_t k) const;
    HandleAcceleration handle_acceleration(std::int64_t k, Vec3 const& r) const;
    /// Of what each of the group's tips is joined to, and the size of its terms: the ground, or a
    /// ring's first body. Collective.
    std::vector<Vector<double, 4>> beyond_tips(Communicator const&) const;
    double newton_euler_residual(std::int64_t k) const;
};

}  // namespace catena
