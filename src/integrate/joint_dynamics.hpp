// Forward dynamics of body chains in joint coordinates: state -> accelerations, by one matrix and one bias sweep.
#pragma once

#include <memory>
#include <vector>

#include "chain/joint_kinematics.hpp"
#include "dca/solver.hpp"
#include "integrate/absolute_dynamics.hpp"
#include "integrate/body_loads.hpp"

namespace catena {

/// Time derivatives of JointState's velocities.
struct JointRates {
    Field<3> qdd;                         // revolute {qdd, 0, 0}; spherical, free: derivative of the components of qd, B
    std::vector<Vec3> base_acceleration;  // one a piece: of a free base's origin, W
};

class JointDynamics {
  public:
    JointDynamics(ChainGroup const&, Scene const&, Executor const&, Communicator const&, std::unique_ptr<ChainSolver>);

    JointRates make_rates() const;
    /// Collective.
    void evaluate(JointState const&, JointRates&);
    /// Only the kinematics of a state, positions included. Collective.
    BodyMotion const& motion(JointState const&);
    /// Of the state and solution evaluated last.
    BodyResults results() const;
    /// Largest local backward residual of the solution evaluated last: Newton-Euler of every body and the closing of every joint,
    /// each relative to the sizes of its own terms (formulas, "Residuals"). Over all ranks; collective.
    double residual();
    PotentialEnergy potential(JointState const&, BodyMotion const&) const;
    ChainSolver const& solver() const { return *solver_; }
    ChainGroup const& group() const { return group_; }

  private:
    void joint_torques(JointState const&);
    void loads(JointState const&);
    void rates(JointState const&, JointRates&);

    ChainGroup const& group_;
    Executor const& executor_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    JointKinematics kinematics_;
    BodyLoads given_;
    BodyMotion motion_;
    Field<3> joint_torque_;  // known torque of joint k on body k, joint axes; halo from outboard
    Field<3> torque_, force_;
    Field<3> alpha_, acceleration_;
    Field<3> alpha_outboard_;  // of body k along the axes of its outboard joint; halo from inboard
    DirectionsField bias_, joint_force_;
};

}  // namespace catena
