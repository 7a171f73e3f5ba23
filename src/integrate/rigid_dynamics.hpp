// Chains of rigid bodies in absolute coordinates: what bodies on spherical joints and bodies on links have in common.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "integrate/absolute_dynamics.hpp"
#include "integrate/body_loads.hpp"
#include "integrate/rotor.hpp"

namespace catena {

/// Handle 1 of body k lies at x + R r1, handle 2 at x + R r2 (x: centre of mass). A point bead is a body without inertia that never turns.
class RigidDynamics : public AbsoluteDynamics {
  public:
    void assemble_matrices() override { solver_->assemble_matrices(configuration()); }
    void set_simple_forces() override;
    View<3> bead_forces() override { return carried_.forces(); }
    ConstView<3> bead_positions() override;
    void take_bead_forces() override;

    void kick(double h) override { project(h, velocity_.view(), omega_.view()); }
    void observe(double h) override { project(h, observed_velocity_.view(), observed_omega_.view()); }
    /// Impulses along the joints at the start enter momenta before the drift, and the free rotor runs again in every sweep
    /// (formulas, "Rigid bodies under RATTLE").
    void drift(double h, int sweeps) override;
    void thermostat(Thermostat const&, std::uint64_t step) override;
    void draw_velocities(double kt, std::uint64_t seed, std::vector<bool> const& of_chain) override;

    std::vector<StateArray> state() const override;
    void set_state(std::vector<StateArray> const&) override;
    std::vector<StateArray> observed_state() const override;
    void evaluate() override;
    void evaluate_at_once() override;
    std::vector<double> time_at_once(int chained, int repeat) override;
    BodyResults results() const override;
    double residual() override;

    ChainGroup const& group() const override { return group_; }
    ChainSolver& solver() const override { return *solver_; }

  protected:
    RigidDynamics(ChainGroup const&, Scene const&, Executor const&, Communicator const&, std::unique_ptr<ChainSolver>);

    virtual ConfigurationView configuration() = 0;
    /// Biases of inboard joints and tips for a drift that ended at these poses: `scale` times how far each is open along its directions.
    virtual void set_openings(double scale, Field<3> const& position, Field<4> const& orientation) = 0;
    /// Biases of joints for accelerations: their velocity terms, less the centripetal ones of the bodies, at the velocities observed last.
    virtual void set_velocity_biases() = 0;
    /// Torques of joints on both their bodies, W: added to torque[k].
    virtual void add_joint_torques() {}
    /// Force of the inboard joint on body k, W; of the tip's joint on the ground.
    virtual Vec3 joint_force(std::int64_t k) const = 0;
    virtual Vec3 tip_force(std::int64_t k) const = 0;
    /// How far the inboard joint of body k is from closing, given the accelerations of its handles (outboard less inboard), and the size of
    /// its own terms.
    virtual double closing(std::int64_t k, Vec3 const& difference, double terms) const = 0;
    virtual double tip_closing(std::int64_t k, Vec3 const& difference, double terms) const = 0;

    static Mat3 turn(Field<4> const& orientation, std::int64_t k) { return to_matrix(as_quaternion(orientation.view().load(k))); }
    bool is_bead(std::int64_t k) const { return principal_[static_cast<std::size_t>(k)].moments[0] == 0; }
    Vec3 outboard_force(std::int64_t k) const;
    void set_outboard_points(Field<3> const& position, Field<4> const& orientation);
    Vec3 inboard_point(std::int64_t k, Field<3> const& position, Field<4> const& orientation) const;
    void set_bias(std::int64_t k, Vec3 const& value);
    void set_tip_bias(std::int64_t k, Vec3 const& value);
    /// Of handle 1 or 2 of body k at the velocities observed last, W.
    Vec3 handle_velocity(std::int64_t k, Vec3 const& r) const;

    ChainGroup const& group_;
    Executor const& executor_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    BodyLoads given_;
    std::vector<PrincipalFrame> principal_;
    Field<3> position_, velocity_, omega_;
    Field<4> orientation_;
    Field<3> observed_velocity_, observed_omega_, force_, torque_;
    Field<3> momentum_, angular_momentum_, acceleration_, alpha_;
    Field<3> trial_position_, trial_omega_;
    Field<4> trial_orientation_;
    Field<3> outboard_point_;  // handle 2, W; halo from inboard
    DirectionsField bias_, joint_force_, tip_bias_, tip_force_;
    CarriedBeadForces carried_;

  private:
    void set_momenta_and_biases();
    LoadsView loads();
    LoadsView loads_at_once();
    AccelerationsView found();
    struct HandleAcceleration {
        Vec3 value;
        double terms;
    };
    void project(double h, View<3> velocity, View<3> omega);
    void add_noise(std::int64_t k, double c, double spread, std::uint64_t seed, std::uint64_t step, NoiseStage linear, NoiseStage angular);
    HandleAcceleration handle_acceleration(std::int64_t k, Vec3 const& r) const;
    double newton_euler_residual(std::int64_t k) const;
};

}  // namespace catena
