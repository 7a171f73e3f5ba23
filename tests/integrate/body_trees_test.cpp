// Motion of branched chains of rigid bodies: energy, momenta, the order of the integrators, the
// thermostat, and bits that threads and a restart do not change.
#include <gtest/gtest.h>

#include "integrate/joint_integrators.hpp"
#include "observe/observables.hpp"
#include "oracle/oracle.hpp"
#include "tests/integrate/constrained_run.hpp"
#include "tests/support/integrators.hpp"
#include "tests/support/random_tree.hpp"

namespace catena::test {
namespace {

/// A tree of 14 bodies without driven joints and loads but springs.
Scene tree_scene(Base base, RandomJoints joints, std::uint64_t seed = 4, bool springs = true) {
    Scene scene;
    scene.chains = {random_tree(
        seed, {.bodies = 14, .joints = joints, .base = base, .loaded = false, .springs = springs},
        TreeShape::bushy)};
    scene.chains[0].name = "tree";
    scene.chains[0].bodies.damping.clear();
    scene.solver.backend = Backend::serial;
    return scene;
}

/// A run of an integrator in joint coordinates.
class JointRun {
  public:
    JointRun(Scene const& scene, Integrator kind)
        : scene_(scene),
          system_(scene_, Axes::joint, *communicator_),
          integrator_(make_joint(system_, kind)) {}
    void run(int steps, double step) {
        for (int i = 0; i < steps; ++i) {
            system_.joint().front()->set_time(done_++ * step);
            integrator_->step(step);
        }
    }
    double energy() {
        double e = kinetic_energy(scene_, system_.snapshot());
        for (EnergyTerm const& term : system_.potential_energy()) e += term.value;
        return e;
    }
    SceneMotion snapshot() { return system_.snapshot(); }
    JointDynamics& dynamics() { return *system_.joint().front(); }

  private:
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
    Scene scene_;
    ChainSystem system_;
    std::unique_ptr<JointIntegrator> integrator_;
    int done_ = 0;
};

TEST(BodyTrees, RungeKuttaKeepsTheEnergyToItsOrder) {
    for (Base const base : {Base::free, Base::fixed})
        for (RandomJoints const joints :
             {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::all}) {
            Scene scene = tree_scene(base, joints);
            scene.forces.gravity = {{0, 1, -5}};
            double error[2];
            for (int half = 0; half < 2; ++half) {
                JointRun run(scene, Integrator::rk4);
                double const before = run.energy();
                run.run(half ? 200 : 100, half ? 0.001 : 0.002);
                error[half] = std::abs(run.energy() - before);
            }
            // Energies err by the fourth or the fifth power of the step.
            EXPECT_GE(error[0] / error[1], 11) << static_cast<int>(joints);
            EXPECT_LE(error[1], 1e-5) << static_cast<int>(joints);
        }
}

TEST(BodyTrees, FreeOnesKeepTheirMomenta) {
    for (RandomJoints const joints : {RandomJoints::mixed, RandomJoints::all}) {
        Scene scene = tree_scene(Base::free, joints, 6);
        JointRun run(scene, Integrator::rk4);
        Momenta const before = momenta(scene, run.snapshot());
        run.run(400, 0.0005);
        Momenta const after = momenta(scene, run.snapshot());
        EXPECT_LE(norm(after.linear - before.linear), 1e-8 * before.size);
        EXPECT_LE(norm(after.angular - before.angular), 1e-8 * before.size);
        EXPECT_GT(norm(after.angular), 1e-3 * before.size);
    }
}

TEST(BodyTrees, DampersTakeEnergy) {
    Scene scene = tree_scene(Base::fixed, RandomJoints::all);
    scene.chains[0].bodies.damping.assign(scene.chains[0].size(), {{0.5, 0.5, 0.5}});
    JointRun run(scene, Integrator::rk4);
    double before = run.energy();
    for (int i = 0; i < 10; ++i) {
        run.run(20, 0.001);
        EXPECT_LT(run.energy(), before);
        before = run.energy();
    }
}

/// log2 of the ratio of errors at two step sizes against a reference with many steps.
double order_of(Scene const& scene, Integrator kind) {
    double constexpr time = 0.1;
    auto const end_of = [&](int steps, Integrator of) {
        JointRun run(scene, of);
        run.run(steps, time / steps);
        return run.snapshot().position;
    };
    auto const exact = end_of(2000, Integrator::rk4);
    auto const error_of = [&](int steps) {
        auto const x = end_of(steps, kind);
        double worst = 0;
        for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, norm(x[i] - exact[i]));
        return worst;
    };
    int const coarse = traits_of(kind).order == 4 ? 40 : 80;
    return std::log2(error_of(coarse) / error_of(2 * coarse));
}

TEST(BodyTrees, IntegratorsHaveTheirOrder) {
    for (Base const base : {Base::free, Base::fixed}) {
        Scene scene = tree_scene(base, RandomJoints::all, 9);
        scene.chains[0].bodies.damping.assign(scene.chains[0].size(), {{0.2, 0.2, 0.2}});
        scene.forces.gravity = {{0, 1, -2}};
        EXPECT_NEAR(order_of(scene, Integrator::rk4), 4.0, 0.5);
        for (Integrator const second : {Integrator::velocity_verlet, Integrator::leapfrog})
            EXPECT_NEAR(order_of(scene, second), 2.0, 0.4) << name_of(second);
    }
}

/// Positions of a run are those of the oracle at the same coordinates.
TEST(BodyTrees, MoveAsTheirCoordinatesSay) {
    for (Base const base : {Base::free, Base::fixed}) {
        Scene scene = tree_scene(base, RandomJoints::all, 12);
        JointRun run(scene, Integrator::rk4);
        run.run(50, 0.002);
        JointState const state = run.dynamics().state();
        BodyArrays& b = scene.chains[0].bodies;
        for (std::size_t k = 0; k < b.size(); ++k) {
            auto const at = static_cast<std::int64_t>(k);
            for (int i = 0; i < 4; ++i) b.q[k][static_cast<std::size_t>(i)] = state.q[at][i];
            b.qd[k] = state.qd[at];
        }
        b.free_base = {state.base_position[0], state.base_velocity[0]};
        auto const exact = oracle::kinematics<double>(scene.chains[0], {});
        SceneMotion const found = run.snapshot();
        for (std::size_t k = 0; k < b.size(); ++k) {
            EXPECT_LE(norm(found.position[k] - exact.com_position[k]), 1e-12);
            EXPECT_LE(norm(found.velocity[k] - exact.com_velocity[k]), 1e-11);
        }
        EXPECT_NEAR(kinetic_energy(scene, found), exact.kinetic_energy,
                    1e-12 * exact.kinetic_energy);
    }
}

TEST(BodyTrees, AStateCarriesAllThatARestartNeeds) {
    Scene const scene = tree_scene(Base::free, RandomJoints::all, 15);
    JointRun whole(scene, Integrator::rk4), first(scene, Integrator::rk4),
        second(scene, Integrator::rk4);
    whole.run(40, 0.002);
    first.run(20, 0.002);
    second.dynamics().set_state(first.dynamics().state());
    second.run(20, 0.002);
    SceneMotion const a = whole.snapshot(), b = second.snapshot();
    for (std::size_t k = 0; k < a.position.size(); ++k)
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(a.position[k][i], b.position[k][i]);
            EXPECT_EQ(a.velocity[k][i], b.velocity[k][i]);
        }
}

}  // namespace
}  // namespace catena::test
