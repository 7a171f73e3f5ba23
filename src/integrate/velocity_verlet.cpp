// Velocity Verlet in joint coordinates, for accelerations that depend on velocities.
#include "integrate/joint_integrators.hpp"

namespace catena {
namespace {

/// JointIntegrator of make_velocity_verlet().
class VelocityVerlet final : public JointIntegrator {
  public:
    explicit VelocityVerlet(ChainSystem& system) : system_(system) {}
    bool carries_rates() const override { return true; }
    void restored(Checkpoint const&) override { ready_ = true; }
    void prepare() override {
        if (ready_) {
            make_ghosts(system_);
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
    ChainSystem& system_;
    bool ready_ = false;
};

}  // namespace

std::unique_ptr<JointIntegrator> make_velocity_verlet(ChainSystem& system) {
    return std::make_unique<VelocityVerlet>(system);
}

}  // namespace catena
