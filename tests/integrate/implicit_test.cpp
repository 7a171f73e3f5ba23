// Joints whose springs and dampers stand in the matrices: against a dense solve, in order, in
// stability, in equilibrium.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "integrate/constrained_integrator.hpp"
#include "integrate/joint_integrators.hpp"
#include "observe/observables.hpp"
#include "oracle/oracle.hpp"
#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "scene/pose.hpp"
#include "tests/support/integrators.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/variants.hpp"

namespace catena::test {
namespace {

using Real = long double;
using DenseMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using DenseVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

Scene scene_of(ChainSpec const& chain) {
    Scene scene;
    scene.chains = {chain};
    scene.chains[0].name = "a";
    scene.dynamics.given = true;
    scene.dynamics.integrator = Integrator::staggered;
    return scene;
}

/// A coordinate with a spring or a damper.
struct Coordinate {
    std::size_t body;
    int number;
};
std::vector<Coordinate> resisting(BodyArrays const& bodies) {
    std::vector<Coordinate> all;
    for (std::size_t k = 0; k < bodies.size(); ++k)
        for (int i = 0; scene::resists(bodies, k) && i < scene::coordinates_of(bodies.joint[k]);
             ++i)
            all.push_back({k, i});
    return all;
}

/// The block of M^-1 that these coordinates see: answers to unit torques.
DenseMatrix mobility(ChainSpec const& chain, std::vector<Coordinate> const& at) {
    oracle::Loads const loads;
    auto const answer = [&](ChainSpec const& loaded) {
        auto const qdd = oracle::aba<Real>(loaded, loads).qdd;
        DenseVector v(static_cast<Eigen::Index>(at.size()));
        for (std::size_t i = 0; i < at.size(); ++i)
            v[static_cast<Eigen::Index>(i)] = qdd[at[i].body][at[i].number];
        return v;
    };
    ChainSpec still = chain;
    BodyArrays& b = still.bodies;
    b.qd.assign(b.size(), Vec3::zero());
    b.stiffness.clear(), b.damping.clear(), b.wrench.clear();
    for (DrivenJoint& driven : b.driven)
        for (PrescribedMotion& course : driven.course)
            course = {scene::value_at(course, 0), 0, 0, 0, 0};
    b.free_base.velocity = Vec3::zero();
    b.torque.assign(b.size(), Vec3::zero());
    auto const n = static_cast<Eigen::Index>(at.size());
    DenseMatrix m(n, n);
    for (std::size_t i = 0; i < at.size(); ++i) {
        ChainSpec loaded = still;
        loaded.bodies.torque[at[i].body][at[i].number] = 1;
        m.col(static_cast<Eigen::Index>(i)) = answer(loaded);
    }
    return m;
}

double inertia(BodyArrays const& b, Coordinate const& c, double h) {
    return 0.5 * h * h * b.stiffness[c.body][c.number] + 0.5 * h * b.damping[c.body][c.number];
}

/// (M + B) u' = M a, a the accelerations of forward dynamics; spherical joints keep B in the
/// outboard body, as a rotor.
DenseVector expected_rates(ChainSpec const& chain, std::vector<Coordinate> const& at, double h) {
    ChainSpec turning = chain;
    BodyArrays& b = turning.bodies;
    for (std::size_t k = 0; k < b.size(); ++k) {
        if (b.joint[k] != JointType::spherical || !scene::resists(b, k)) continue;
        Vec3 momentum;
        for (int i = 0; i < 3; ++i) momentum[i] = 0.5 * h * h * b.stiffness[k][i] * b.qd[k][i];
        b.torque[k] = b.torque[k] - cross(b.qd[k], momentum);
    }
    auto const n = static_cast<Eigen::Index>(at.size());
    auto const free = oracle::aba<Real>(turning, {}).qdd;
    DenseMatrix matrix = mobility(chain, at);
    DenseVector a(n), rotor(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        Coordinate const& c = at[static_cast<std::size_t>(i)];
        a[i] = free[c.body][c.number];
        rotor[i] = static_cast<Real>(inertia(b, c, h));
        matrix(i, i) += 1 / rotor[i];
    }
    return matrix.fullPivLu().solve(a).cwiseQuotient(rotor);
}

class Implicit : public WithVariant {};

TEST_P(Implicit, AccelerationsAreThoseOfADenseSolve) {
    double worst = 0;
    for (std::uint64_t seed = 1; seed <= 90; ++seed) {
        RandomChainOptions options;
        options.bodies = seed % 10 == 0 ? 40 : 1 + seed % 8;
        options.joints = static_cast<RandomJoints>(seed % 9);
        options.base = seed % 2 ? Base::free : Base::fixed;
        options.springs = true;
        options.driven = seed % 5 == 0 ? 0.2 : 0;
        ChainSpec chain = random_chain(seed, options);
        double const h =
            std::pow(10.0, static_cast<double>(seed % 13) - 6);  // B from far below M to far above
        Scene const scene = with_backend(scene_of(chain));
        ChainSystem system(scene, Axes::joint, *communicator_, h);
        system.joint().front()->apply({JointOperator::drift},
                                      0.0);  // whose velocities are those before a kick
        system.evaluate();
        auto const found = system.accelerations().joint_acceleration;
        for (DrivenJoint const& driven : chain.bodies.driven)
            chain.bodies.stiffness[static_cast<std::size_t>(driven.body)] = Vec3::zero(),
            chain.bodies.damping[static_cast<std::size_t>(driven.body)] = Vec3::zero();
        std::vector<Coordinate> const at = resisting(chain.bodies);
        if (at.empty()) continue;
        DenseVector const exact = expected_rates(chain, at, h);
        auto const& alpha = system.accelerations().alpha;
        double error = 0, size = 0, speed = 0;
        for (Vec3 const& qd : chain.bodies.qd) speed += norm(qd);
        size = speed * speed;  // of the velocities' terms, which may cancel
        for (std::size_t i = 0; i < at.size(); ++i)
            error =
                std::max(error, std::abs(found[at[i].body][at[i].number] -
                                         static_cast<double>(exact[static_cast<Eigen::Index>(i)])));
        for (std::size_t k = 0; k < chain.size(); ++k)
            size = std::max({size, norm(alpha[k]), norm(found[k])});
        // Rates are differences of bodies' accelerations; those go through n eliminations, whose
        // pivots differ by what masses do.
        double const bound = 1e4 * static_cast<double>(options.bodies) * 0x1p-53 * size;
        EXPECT_LE(error, bound) << "seed " << seed << ", " << options.bodies << " bodies, joints "
                                << static_cast<int>(options.joints) << ", h " << h;
        EXPECT_LE(system.residual(), system.residual_bound()) << "seed " << seed;
        worst = std::max(worst, error / bound);
    }
    RecordProperty("worst_error_over_bound", std::to_string(worst));
}

/// Springs and dampers of spherical, universal, revolute, prismatic and helical joints, with loads
/// and a start in motion.
Scene swinging(RandomJoints joints, Base base, bool damped) {
    RandomChainOptions options;
    options.bodies = 6;
    options.joints = joints;
    options.base = base;
    options.springs = true;
    ChainSpec chain = random_chain(5, options);
    if (!damped) chain.bodies.damping.clear();
    Scene scene = scene_of(chain);
    scene.forces.gravity = {{0, 1, -2}};
    return scene;
}

using Make = std::unique_ptr<JointIntegrator> (*)(ChainSystem&);
std::unique_ptr<JointIntegrator> make_staggered(ChainSystem& system) {
    return make_joint(system, Integrator::staggered);
}

/// Positions after `time` in so many steps.
std::vector<Vec3> end_of(Scene const& scene, Make make, double time, int steps) {
    auto const communicator = serial_communicator();
    double const h = time / steps;
    ChainSystem system(scene, Axes::joint, *communicator, make == make_runge_kutta4 ? 0.0 : h);
    auto const integrator = make(system);
    for (int i = 0; i < steps; ++i) integrator->step(h);
    return system.snapshot().position;
}
double distance(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, norm(a[i] - b[i]));
    return worst;
}

TEST(Staggered, IsOfSecondOrder) {
    for (RandomJoints const joints :
         {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::universal,
          RandomJoints::prismatic, RandomJoints::helical, RandomJoints::mixed,
          RandomJoints::cylindrical, RandomJoints::planar3})
        for (Base const base : {Base::fixed, Base::free})
            for (bool const damped : {false, true}) {
                double constexpr time = 0.2;
                Scene const scene = swinging(joints, base, damped);
                auto const exact = end_of(scene, make_runge_kutta4, time, 1600);
                auto const error = [&](int steps) {
                    return distance(end_of(scene, make_staggered, time, steps), exact);
                };
                EXPECT_NEAR(std::log2(error(200) / error(400)), 2.0, 0.1)
                    << static_cast<int>(joints) << ' ' << static_cast<int>(base) << ' ' << damped;
            }
}

/// The stiffest mode's frequency, from the eigenvalues of M^-1 K.
double stiffest(ChainSpec const& chain) {
    std::vector<Coordinate> const at = resisting(chain.bodies);
    DenseMatrix m = mobility(chain, at);
    for (Eigen::Index j = 0; j < m.cols(); ++j) {
        Coordinate const& c = at[static_cast<std::size_t>(j)];
        m.col(j) *= static_cast<Real>(chain.bodies.stiffness[c.body][c.number]);
    }
    return std::sqrt(static_cast<double>(m.eigenvalues().real().maxCoeff()));
}

/// Joints a little off their rests.
Scene plucked(RandomJoints joints, double off) {
    RandomChainOptions options;
    options.bodies = 8;
    options.joints = joints;
    options.moving = options.loaded = false;
    options.springs = true;
    ChainSpec chain = random_chain(7, options);
    BodyArrays& b = chain.bodies;
    b.damping.clear();
    for (std::size_t k = 0; k < b.size(); ++k) {
        b.stiffness[k] = b.joint[k] == JointType::spherical ? Vec3{{3, 4, 5}} : b.stiffness[k];
        b.rest[k] = b.q[k];
        if (b.joint[k] == JointType::spherical) {
            Quat const q = Quat{b.rest[k][0], b.rest[k][1], b.rest[k][2], b.rest[k][3]} *
                           from_rotation_vector(off * Vec3{{0.5, -0.6, 0.7}});
            b.q[k] = {q.w, q.x, q.y, q.z};
        } else {
            b.q[k][0] += off;
        }
    }
    return scene_of(chain);
}

double energy_of(Scene const& scene, ChainSystem& system) {
    double sum = kinetic_energy(scene, system.snapshot());
    for (EnergyTerm const& term : system.potential_energy()) sum += term.value;
    return sum;
}

/// Velocities at whole steps are those of the chain with its rotors, slower than the chain's alone:
/// the energy falls from where it starts at rest and comes back to it.
TEST(Staggered, IsStableHoweverStiff) {
    auto const communicator = serial_communicator();
    for (RandomJoints const joints :
         {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::universal,
          RandomJoints::mixed, RandomJoints::cylindrical, RandomJoints::planar3})
        for (double const times : {1e1, 1e3, 1e4, 1e6}) {  // omega h
            Scene const scene = plucked(joints, 0.01);
            double const h = times / stiffest(scene.chains[0]);
            ChainSystem system(scene, Axes::joint, *communicator, h);
            auto const integrator = make_staggered(system);
            double const start = energy_of(scene, system);
            double most = 0;
            for (int i = 0; i < 5000; ++i) {
                integrator->step(h);
                most = std::max(most, energy_of(scene, system));
            }
            EXPECT_LE(most, 1.5 * start) << static_cast<int>(joints) << ", omega h " << times;
        }
}

/// Copies of a chain of three bodies with stiff springs, far from friction's and the step's small
/// limits: the mean square of every coordinate over kt / K, which is 1 whatever the step (BAOAB is
/// exact for harmonic springs, and a rotor changes no equilibrium).
TEST(Staggered, SamplesHarmonicSpringsExactly) {
    double constexpr stiffness = 4e4, kt = 2.5;
    std::string const joint = "stiffness: 4e4";
    std::string const scene_text =
        "chains: [{name: a, count: 100, base: fixed, bodies: ["
        "{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: {type: revolute, axis: [0, 1, "
        "0], " +
        joint +
        "}},"
        "{mass: 2, com: [0.1, 0, 0], inertia: [1, 2, 2], joint: {type: universal, axes: [[1, 0, "
        "0], [0, 1, 0]], translation: [0.3, 0, "
        "0], " +
        joint +
        "}},"
        "{mass: 1, com: [0, 0.1, 0], inertia: [1, 1, 1.5], joint: {type: revolute, axis: [0, 0, "
        "1], translation: [0.5, 0, 0], " +
        joint +
        "}}]}]\n"
        "dynamics: {integrator: implicit-baoab, step: 1, steps: 1}\n";
    auto const communicator = serial_communicator();
    Scene const scene = parse_scene(scene_text, "scene.yaml");
    for (double const times : {0.5, 10.0, 1000.0}) {
        double const h = times / stiffest(scene.chains[0]);
        ChainSystem system(scene, Axes::joint, *communicator, h);
        auto const integrator =
            make_program(system, program_of(Integrator::baoab, true), {1.5 / h, kt, 11});
        double sum = 0;
        std::int64_t samples = 0;
        for (int i = 0; i < 1200; ++i) {
            system.joint().front()->set_time(i * h);
            integrator->step(h);
            if (i < 100 || i % 10 != 0) continue;
            JointState const state = system.joint().front()->state();
            for (std::int64_t k = 0; k < state.q.size(); ++k, ++samples)
                sum += state.q[k][0] * state.q[k][0] * stiffness / kt;
        }
        // Ten steps at this friction apart they are all but independent: half the samples at worst.
        double const error = std::sqrt(2.0 / (0.5 * static_cast<double>(samples)));
        EXPECT_NEAR(sum / static_cast<double>(samples), 1.0, 4 * error) << times;
    }
}

/// In absolute coordinates: rods at friction 0, against RATTLE at a far smaller step.
TEST(ImplicitLangevin, IsOfSecondOrderWithoutFriction) {
    auto const communicator = serial_communicator();
    Scene const scene = parse_scene(
        "chains: [{generator: {elastic_rod: {bodies: 12, mass: 6500, length: 3.4, radius: 1, bend: "
        "50, twist: 100, seed: 2}}}]\n"
        "dynamics: {integrator: implicit-g-baoab, step: 1, steps: 1}\n",
        "scene.yaml");
    auto const end = [&](Integrator kind, int steps) {
        double const h = 40.0 / steps;
        ChainSystem system(scene, Axes::world, *communicator, is_implicit(kind) ? h : 0.0);
        for (AbsoluteDynamics* group : system.absolute()) group->update_configuration();
        ConstrainedIntegrator integrator({kind, h, 0, 0, 1, 1e-12}, system.absolute());
        system.forces_and_matrices(nullptr);
        integrator.choose_sweeps();
        for (int i = 0; i < steps; ++i) {
            integrator.step(i);
            system.forces_and_matrices(nullptr);
        }
        integrator.observe();
        return system.snapshot().position;
    };
    auto const exact = end(Integrator::rattle, 3200);
    double const slope = std::log2(distance(end(Integrator::implicit_g_baoab, 100), exact) /
                                   distance(end(Integrator::implicit_g_baoab, 200), exact));
    EXPECT_NEAR(slope, 2.0, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Backends, Implicit,
                         testing::Values(Variant{Backend::serial, Handles::projected},
                                         Variant{Backend::segments, Handles::projected},
                                         Variant{Backend::openmp, Handles::projected},
                                         Variant{Backend::cuda, Handles::projected}),
                         name_of_variant);

}  // namespace
}  // namespace catena::test
