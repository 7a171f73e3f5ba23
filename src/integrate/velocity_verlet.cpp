#include "integrate/joint_integrators.hpp"

namespace catena {
namespace {

class VelocityVerlet final : public JointIntegrator {
  public:
    explicit VelocityVerlet(ChainSystem& system) : system_(system) {}
    int evaluations_a_step() const override { return 1; }
    bool carries_rates() const override { return true; }
    void restored() override { ready_ = true; }
    void prepare() override {
        if (ready_) {
            make_ghosts();
            return;
        }
        system_.solve_joint_groups();
        for (JointDynamics* const group : system_.joint()) group->carry_rates();
        ready_ = true;
    }

    void step(double h) override {
        prepare();
        for (JointDynamics* const group : system_.joint()) group->verlet_move(h);
        system_.solve_joint_groups();
        for (JointDynamics* const group : system_.joint()) group->verlet_finish(h);
    }

  private:
    /// Lists of ghosts belong to the step at which they were asked for: a restart makes them there.
    void make_ghosts() {
        if (system_.openmm() && system_.openmm()->ghosts_are_due()) system_.evaluate();
    }

    ChainSystem& system_;
    bool ready_ = false;
};

}  // namespace

std::unique_ptr<JointIntegrator> make_velocity_verlet(ChainSystem& system) { return std::make_unique<VelocityVerlet>(system); }

}  // namespace catena
