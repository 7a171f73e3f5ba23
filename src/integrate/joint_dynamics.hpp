// Forward dynamics of body chains in joint coordinates: state -> accelerations, by one matrix and one bias sweep.
#pragma once

#include <memory>
#include <vector>

#include "chain/joint_kinematics.hpp"
#include "dca/solver.hpp"
#include "integrate/absolute_dynamics.hpp"
#include "integrate/body_loads.hpp"
#include "integrate/jointed_tips.hpp"

namespace catena {

/// Time derivatives of JointState's velocities.
struct JointRates {
    Field<3> qdd;                         // second derivatives of q; spherical, free: derivative of the components of qd, B
    std::vector<Vec3> base_acceleration;  // one a piece: of a free base's origin, W
};

class JointDynamics final : public BeadHost {
  public:
    JointDynamics(ChainGroup const&, Scene const&, Executor const&, Communicator const&, std::unique_ptr<ChainSolver>);

    JointRates make_rates() const;
    /// Kinematics, matrices and rates: the three below. Collective.
    void evaluate(JointState const&, JointRates&);
    /// What a state alone decides, and where carried beads are. Clears their forces. Collective.
    void update_configuration(JointState const&);
    /// At the configuration updated last. Needs no forces. Collective.
    void assemble_matrices();
    /// With the forces of now, at the state of the configuration updated last. Collective.
    void solve(JointState const&, JointRates&);
    ConstView<3> bead_positions() override;
    View<3> bead_forces() override { return carried_.forces(); }
    /// Only the kinematics of a state, positions included. Collective.
    BodyMotion const& motion(JointState const&);
    /// Of the state and solution evaluated last. Collective.
    BodyResults results() const;
    /// Largest local backward residual of the solution evaluated last: Newton-Euler of every body and the closing of every joint,
    /// each relative to the sizes of its own terms (formulas, "Residuals"). Over all ranks; collective.
    double residual();
    PotentialEnergy potential(JointState const&, BodyMotion const&) const;
    /// Corrects positions by so many Newton steps and velocities by one, each by the least in the metric of the masses, so that jointed
    /// tips close again; nothing happens where there are none. Collective.
    static constexpr int usual_corrections = 2;
    void close_tips(JointState&, int corrections = usual_corrections);
    /// Largest opening of a jointed tip over the chains' reach, over all ranks. Collective.
    double closure_error(JointState const&);
    ChainSolver const& solver() const { return *solver_; }
    ChainGroup const& group() const override { return group_; }

  private:
    void joint_torques(JointState const&);
    void loads(JointState const&);
    Vec3 joint_velocity_term(JointState const&, std::int64_t k, Vec3& linear) const;
    void add_joint_loads(std::int64_t k, Mat3 const& turn, Vec3& torque, Vec3& force) const;
    void rates(JointState const&, JointRates&);
    Vec3 rate_of_joint(JointState const&, std::int64_t k, Vec3 const& relative_alpha, double relative_slide) const;
    void correct(JointState&, bool velocities);
    void add_across_plane(BodyResults&) const;
    Mat3 axes2(std::int64_t k) const { return as_matrix(group_.moving_meeting() ? motion_.axes2[k] : group_.axes2[k]); }
    Vec3 r2(std::int64_t k) const { return group_.moving_meeting() ? motion_.r2[k] : group_.r2[k]; }
    Screw<double> screw(std::int64_t k) const;
    Mat3 orientation(std::int64_t k) const { return to_matrix(as_quaternion(motion_.orientation[k])); }
    /// omega x J omega.
    Vec3 gyroscopic_torque(std::int64_t k) const { return cross(motion_.omega[k], as_symmetric(group_.inertia[k]) * motion_.omega[k]); }
    /// From outside the chain and from carried beads.
    Wrench wrench(std::int64_t k) const;

    ChainGroup const& group_;
    Executor const& executor_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    JointKinematics kinematics_;
    BodyLoads given_;
    BodyMotion motion_;
    JointedTips tips_;
    CarriedBeadForces carried_;
    bool has_wrenches_, has_forces_, needs_positions_;
    Field<4>
        joint_load_;  // known load of joint k on body k: torque along the joint's axes and force along its last one; halo from outboard
    Field<3> torque_, force_;
    Field<3> alpha_, acceleration_;
    Field<4> outboard_;  // of body k along the axes of its outboard joint: angular acceleration; that of handle 2 along the last axis
    DirectionsField bias_, joint_force_, tip_bias_, tip_force_;
};

}  // namespace catena
