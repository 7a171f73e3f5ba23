// Results of an evaluation of rigid chains in absolute coordinates, on the host.
#pragma once

#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/body_loads.hpp"

namespace catena {

/// Energy of springs and gravity at the given poses. `orientation` must have its halo.
PotentialEnergy potential_of(ChainGroup const&, BodyLoads const&, Field<3> const& position,
                             Field<4> const& orientation);

/// Results and inputs of the last evaluate(). RigidSteps, RigidLoads, RigidJoints and HandlesView
/// document the fields.
struct RigidSolution {
    ChainGroup const& group;
    ConstView<4> orientation;
    ConstView<3> omega, force, torque, moment, alpha, acceleration, direction, tip_direction;
    ConstDirectionsView bias, joint_force, tip_bias, tip_force;
    BodyResults results() const;
    /// Largest local backward residual over all ranks. Collective.
    double residual(Communicator const&) const;

  private:
    /// Acceleration of a handle, W, and the sum of the sizes of its terms.
    struct HandleAcceleration {
        Vec3 value;
        double terms;
    };
    Mat3 axes(std::int64_t k) const { return to_matrix(as_quaternion(orientation.load(k))); }
    /// Force of the inboard joint on body k, W.
    Vec3 inboard_force(std::int64_t k) const;
    /// Force of the tip's joint on the ground, W.
    Vec3 force_of_tip(std::int64_t k) const;
    /// Force on the outboard neighbour, or on the ground at a jointed tip, W.
    Vec3 outboard_force(std::int64_t k) const;
    /// Acceleration of the point at r (B) from the centre of mass.
    HandleAcceleration handle_acceleration(std::int64_t k, Vec3 const& r) const;
    /// For each of the group's tips, the acceleration of what it is joined to and the size of its
    /// terms: the ground, or a ring's first body. Collective.
    std::vector<Vector<double, 4>> beyond_tips(Communicator const&) const;
    /// Relative residual of the Newton-Euler equations of body k.
    double newton_euler_residual(std::int64_t k) const;
};

}  // namespace catena
