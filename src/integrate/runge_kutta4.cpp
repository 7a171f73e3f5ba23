// The classical fourth-order Runge-Kutta integrator in joint coordinates.
#include "integrate/joint_integrators.hpp"

namespace catena {
namespace {

/// Four stages, each after a solution at the stage's state.
class RungeKutta4 final : public JointIntegrator {
  public:
    explicit RungeKutta4(ChainSystem& system) : system_(system) {}

    void step(double h) override {
        for (int stage = 0; stage < 4; ++stage) {
            system_.solve_joint_groups();
            for (JointDynamics* const group : system_.joint()) group->runge_kutta(stage, h);
        }
    }

  private:
    ChainSystem& system_;
};

}  // namespace

std::unique_ptr<JointIntegrator> make_runge_kutta4(ChainSystem& system) {
    return std::make_unique<RungeKutta4>(system);
}

}  // namespace catena
