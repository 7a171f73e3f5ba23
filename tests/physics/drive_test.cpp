// What a prescribed motion puts into a chain is what the chain's energy gains.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "integrate/joint_integrators.hpp"
#include "observe/observables.hpp"
#include "reader/load_scene.hpp"
#include "tests/support/integrators.hpp"

namespace catena::test {
namespace {

std::string const crank = R"(units: si
chains:
  - name: crank
    base: fixed
    bodies:
      - {mass: 1.0, com: [0.1, 0, 0], inertia: [0.001, 0.004, 0.004],
         joint: {type: revolute, axis: [0, 1, 0], motion: {rate: 6, amplitude: 0.3, frequency: 1.5}}}
      - {mass: 0.4, com: [0, 0.02, -0.1], inertia: [0.0015, 0.0012, 0.0004], joint: {type: spherical, translation: [0.2, 0, 0]}}
      - {mass: 0.5, com: [0.1, 0, 0], inertia: [0.0005, 0.002, 0.002],
         joint: {type: universal, axes: [[0, 0, 1], [0, 1, 0]], translation: [0.2, 0, 0.1], motion: [{amplitude: 0.5, frequency: 2, phase: 1}, {rate: 3}]}}
      - {mass: 0.4, com: [0, 0, -0.1], inertia: [0.0015, 0.0015, 0.0004], joint: {type: revolute, axis: [1, 0, 0], translation: [0, 0, -0.2], stiffness: 0.3}}
forces: {gravity: [0, 0, -9.81]}
)";

/// Steps of Runge-Kutta; the work is that of all driven joints, summed by Simpson's rule over pairs
/// of steps.
class Driven {
  public:
    explicit Driven(int steps)
        : step_(1.0 / steps), steps_(steps), integrator_(make_runge_kutta4(system_)) {}
    struct Result {
        double work, gain;
    };
    Result run() {
        double const before = energy();
        double work = power();
        for (int i = 1; i <= steps_; ++i) {
            system_.joint().front()->set_time((i - 1) * step_);
            integrator_->step(step_);
            system_.joint().front()->set_time(i * step_);
            work += (i == steps_ ? 1 : i % 2 == 1 ? 4 : 2) * power();
        }
        return {work * step_ / 3, energy() - before};
    }

  private:
    double energy() {
        double e = kinetic_energy(scene_, system_.snapshot());
        for (EnergyTerm const& term : system_.potential_energy()) e += term.value;
        return e;
    }
    /// Constraint torques of driven joints (they turn, none slides) along the relative turning;
    /// what holds a joint does no work.
    double power() {
        system_.evaluate();
        auto const force = system_.accelerations().joint_force;
        SceneMotion const at = system_.snapshot();
        double sum = 0;
        for (DrivenJoint const& d : scene_.chains[0].bodies.driven) {
            auto const k = static_cast<std::size_t>(d.body);
            Vec3 rate = to_matrix(at.orientation[k]) * at.omega[k];
            if (k > 0) rate = rate - to_matrix(at.orientation[k - 1]) * at.omega[k - 1];
            sum += dot(Vec3{{force[k][0], force[k][1], force[k][2]}}, rate);
        }
        return sum;
    }
    double step_;
    int steps_;
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
    Scene scene_ = parse_scene(crank, "crank.yaml");
    ChainSystem system_{scene_, Axes::joint, *communicator_};
    std::unique_ptr<JointIntegrator> integrator_;
};

TEST(Drive, WorkIsTheEnergysRise) {
    Driven::Result const coarse = Driven(2000).run(), fine = Driven(8000).run();
    double const error = std::abs(coarse.work - coarse.gain),
                 least = std::abs(fine.work - fine.gain);
    fmt::print(
        "work {:.12f} J, energy's rise {:.12f} J; difference {:.1e} J in 2000 steps, {:.1e} J in "
        "8000\n",
        fine.work, fine.gain, error, least);
    EXPECT_GT(error / least, 64.0);  // fourth order: 256
    EXPECT_LE(least, 1e-8 * std::abs(fine.gain));
}

}  // namespace
}  // namespace catena::test
