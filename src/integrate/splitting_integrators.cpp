// Kick-drift-kick and BAOAB integrators in joint coordinates (make_kicks()).
#include <cmath>

#include "integrate/joint_integrators.hpp"

namespace catena {
namespace {

/// JointIntegrator of make_kicks().
class SplittingIntegrator final : public JointIntegrator {
  public:
    SplittingIntegrator(ChainSystem& system, JointThermostat const& thermostat)
        : system_(system), thermostat_(thermostat) {
        system.keep_matrices();
    }
    void set_origin(double time) override { origin_ = time; }
    bool carries_rates() const override { return true; }
    void restored(Checkpoint const&) override { ready_ = true; }
    void prepare() override {
        if (ready_) return make_ghosts(system_);
        for (JointDynamics* const group : system_.joint()) group->drift(0.0);
        accelerate(0.0);
        ready_ = true;
    }

    void step(double h) override {
        prepare();
        for (JointDynamics* const group : system_.joint()) {
            auto const number =
                static_cast<std::uint64_t>(std::llround((group->time() - origin_) / h));
            group->kick_by_carried(0.5 * h);
            group->drift(is_warm() ? 0.5 * h : h);
            if (!is_warm()) continue;
            group->thermalise(thermostat_of(std::exp(-thermostat_.friction * h), thermostat_.kt,
                                            thermostat_.seed),
                              number);
            group->drift(0.5 * h);
        }
        accelerate(0.5 * h);
    }

  private:
    /// True for Langevin dynamics.
    bool is_warm() const { return thermostat_.friction > 0; }
    /// Computes velocities and accelerations at the middle of a kick, `before` after its start. The
    /// present velocities are those at the start of the kick.
    void accelerate(double before) {
        system_.solve_joint_groups();
        for (JointDynamics* const group : system_.joint()) group->kick(before);
        system_.solve_joint_groups_again();
        for (JointDynamics* const group : system_.joint()) {
            group->carry_rates();
            group->kick(before);
        }
    }

    ChainSystem& system_;
    JointThermostat thermostat_;
    double origin_ = 0;
    bool ready_ = false;
};

}  // namespace

std::unique_ptr<JointIntegrator> make_kicks(ChainSystem& system,
                                            JointThermostat const& thermostat) {
    return std::make_unique<SplittingIntegrator>(system, thermostat);
}

}  // namespace catena
