// Articulated handles: open chains of every joint against the oracles, the same bits on any number
// of ranks and threads, and chains that lose all digits in the mobilities of floating runs.
#include "dca/articulated.hpp"

#include <gtest/gtest.h>

#include "error.hpp"
#include "generate/generators.hpp"
#include "integrate/chain_system.hpp"
#include "measure/oracle_accelerations.hpp"
#include "measure/solution.hpp"
#include "measure/solver_errors.hpp"
#include "oracle/oracle.hpp"
#include "reader/load_scene.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/reference_data.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

double constexpr eps = 0x1p-53;

Scene scene_of(ChainSpec const& chain, Backend backend = Backend::segments) {
    Scene scene;
    scene.chains = {chain};
    scene.chains[0].name = "chain";
    scene.forces.gravity = {{0.3, -2.0, 9.0}};
    scene.solver.backend = backend;
    scene.solver.handles = Handles::articulated;
    scene.solver.threads = 2;
    return scene;
}

/// As far off as articulated bodies in double, which is what these sweeps are over a tree, and the
/// roundings of n bodies.
double bound_of(double in_double, std::size_t bodies) {
    return 8 * in_double + 64 * static_cast<double>(bodies + 8) * eps;
}

TEST(ArticulatedHandles, ChainsOfEveryJointAgreeWithArticulatedBodies) {
    RandomJoints const later[] = {RandomJoints::cylindrical, RandomJoints::planar3,
                                  RandomJoints::all};
    for (std::uint64_t seed = 1; seed <= 390; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomChainOptions options = options_in_turn(seed, 100);
        if (seed > 300) options.joints = later[seed % 3];
        ChainSpec const chain = random_chain(seed, options);
        Scene const scene = scene_of(chain);
        ChainSystem system(scene, Axes::joint, testing::world());
        system.evaluate();
        double const residual = system.residual(), residual_bound = system.residual_bound();
        ChainSystem::Accelerations const a = system.accelerations();
        if (testing::world().rank() != 0) continue;
        oracle::Loads const loads{scene.forces.gravity, {}};
        auto const expected = oracle::aba<long double>(chain, loads);
        auto const in_double = oracle::aba<double>(chain, loads);
        auto const error = [&](auto const& found, auto const& exact) {
            return static_cast<double>(relative_difference(converted<long double>(found), exact));
        };
        EXPECT_LE(error(a.joint_acceleration, expected.qdd),
                  bound_of(error(in_double.qdd, expected.qdd), chain.size()));
        EXPECT_LE(residual, residual_bound);
        std::vector<Vec3> wrench, wrench_in_double;
        std::vector<Vector<long double, 3>> wrench_expected;
        for (std::size_t k = 0; k < chain.size(); ++k) {
            auto const& w = a.joint_force[k];
            wrench.insert(wrench.end(), {{{w[0], w[1], w[2]}}, {{w[3], w[4], w[5]}}});
            wrench_in_double.insert(wrench_in_double.end(), {in_double.constraint_force[k].torque,
                                                             in_double.constraint_force[k].force});
            wrench_expected.push_back(expected.constraint_force[k].torque);
            wrench_expected.push_back(expected.constraint_force[k].force);
        }
        EXPECT_LE(error(wrench, wrench_expected),
                  bound_of(error(wrench_in_double, wrench_expected), chain.size()));
        if (HasFailure()) break;
    }
}

std::vector<double> accelerations_of(Scene const& scene, Communicator const& communicator) {
    ChainSystem system(scene, Axes::joint, communicator);
    system.evaluate();
    return solution_of(system).acceleration;
}

TEST(ArticulatedHandles, TheSameBitsOnAnyRanksAndThreads) {
    auto const alone = serial_communicator();
    for (int const bodies : {1, 2, 3, 17, 64, 65, 257, 1000}) {
        Scene scene = scene_of(
            random_chain(static_cast<std::uint64_t>(bodies),
                         {.bodies = static_cast<std::size_t>(bodies),
                          .joints = bodies % 2 == 0 ? RandomJoints::any : RandomJoints::all}));
        std::vector<double> const together = accelerations_of(scene, testing::world());
        std::vector<double> const expected = accelerations_of(scene, *alone);
        if (testing::world().rank() == 0) {
            EXPECT_EQ(together, expected) << bodies;
        }
        if (!openmp_is_built()) continue;
        scene.solver.backend = Backend::openmp;
        std::vector<double> const by_threads = accelerations_of(scene, testing::world());
        EXPECT_EQ(by_threads, together) << bodies;
    }
}

Solution with(Solution layout, std::vector<double> const& accelerations) {
    layout.acceleration = accelerations;
    return layout;
}

/// Every fourth rod half as thick and long as every second one, and so on: of the mobilities'
/// digits none is left from a thousand on.
TEST(ArticulatedHandles, KeepTheDigitsOfADill) {
    for (Backend const backend : {Backend::serial, Backend::segments})
        for (std::int64_t const bodies : {1000, 16384}) {
            scene::Rods rods;
            rods.bodies = bodies;
            Scene scene = scene_of({}, backend);
            scene.chains[0].base = Base::fixed;
            scene.chains[0].bodies = scene::dill(rods, {});
            std::vector<double> const found = accelerations_of(scene, testing::world());
            if (testing::world().rank() != 0) continue;
            Solution const layout = layout_of(scene);
            auto const exact = oracle_accelerations<long double>(scene, {});
            double const in_double = largest_difference(
                scene, with(layout, oracle_accelerations<double>(scene, {})), exact);
            EXPECT_LE(largest_difference(scene, with(layout, found), exact),
                      bound_of(in_double, static_cast<std::size_t>(bodies)));
        }
}

TEST(ArticulatedHandles, OtherChainsAreRefused) {
    auto const refused = [](std::string const& chain, Axes axes) {
        try {
            Scene const scene = parse_scene(
                "chains: [{name: c, " + chain + "}]\nsolver: {handles: articulated}", "scene.yaml");
            ChainSystem const system(scene, axes, testing::world());
        } catch (InputError const& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    auto const holds = [](std::string const& text, char const* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_PRED2(holds, refused("generator: {random: {bodies: 9, joint: link}}", Axes::joint),
                 "for chain `c`, which has links (scene.yaml");
    std::string const closed =
        "base: fixed, generator: {random: {bodies: 9, joint: spherical}}, tip: {joint: {type: "
        "spherical}}";
    EXPECT_PRED2(holds, refused(closed, Axes::joint),
                 "for chain `c`, which has a jointed tip (scene.yaml");
    EXPECT_PRED2(holds, refused("generator: {random: {bodies: 9, joint: spherical}}", Axes::world),
                 "absolute coordinates (solver.handles");
    EXPECT_EQ(refused("generator: {random: {bodies: 9, joint: spherical}}", Axes::joint), "");
}

/// A turn is orthonormal and leaves an upper triangle behind, whatever the sizes of the columns.
TEST(ArticulatedHandles, TurnedDirectionsAreUpperTriangular) {
    Random random(3);
    for (int const rows : {1, 3, 5, 6})
        for (double const size : {1.0, 1e-150, 1e12}) {
            Matrix<double, 6, 6> a;
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j)
                    a(i, j) = random.uniform() * (j == 2 ? size : 1) * (j < 3 ? 1 : 0);
            auto const turned = dca::turned_to_upper(a, rows);
            Matrix<double, 6, 6> const unit = turned.orthogonal * transpose(turned.orthogonal),
                                       expected = turned.orthogonal * a;
            EXPECT_EQ(turned.rank, std::min(rows, 3));
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j) {
                    double const rounding = 8 * eps * std::max(1.0, size);
                    EXPECT_NEAR(unit(i, j), i == j ? 1 : 0, 16 * eps);
                    EXPECT_NEAR(turned.upper(i, j), i < rows ? expected(i, j) : 0, rounding);
                }
            for (int i = 0; i < turned.rank; ++i)
                for (int k = 0; k < i; ++k) EXPECT_EQ(turned.upper(i, turned.order[k]), 0);
        }
}

/// What refined solutions lack, and residuals, are found by all threads: to the bit what one finds.
TEST(ArticulatedHandles, RefinementDoesNotHangOnThreads) {
    for (Handles const handles : {Handles::articulated, Handles::projected})
        for (bool const held : {false, true}) {
            if (held && handles == Handles::articulated) continue;
            RandomChainOptions options{
                .bodies = 700, .joints = RandomJoints::any, .base = Base::fixed, .springs = true};
            if (held) options.tip = JointType::spherical;
            ChainSpec const chain = random_chain(21, options);
            ChainSystem::Accelerations found[2];
            double residual[2];
            for (Backend const backend : {Backend::segments, Backend::openmp}) {
                if (backend == Backend::openmp && !openmp_is_built())
                    GTEST_SKIP() << "NOT RUN: built without OpenMP";
                Scene scene = scene_of(chain, backend);
                scene.solver.handles = handles;
                scene.solver.threads = 3;
                ChainSystem system(scene, Axes::joint, testing::world());
                system.evaluate();
                system.refine();
                int const which = backend == Backend::openmp;
                residual[which] = system.residual();
                found[which] = system.accelerations();
            }
            EXPECT_EQ(residual[0], residual[1]);
            EXPECT_TRUE(same_bits(found[0].joint_acceleration, found[1].joint_acceleration));
            EXPECT_TRUE(same_bits(found[0].joint_force, found[1].joint_force));
        }
}

/// What a light body hides in a sum stays in its parts: mobilities of 1e30 along one direction and
/// 1 along the others.
TEST(ArticulatedHandles, ALightLastBodyHidesNothing) {
    Random random(5);
    dca::ArticulatedMatrix<double, 6> inboard{
        Symmetric<double, 6>::zero(), Matrix<double, 6, 6>::identity(),
        Matrix<double, 6, 6>::zero(), Matrix<double, 6, 6>::identity()};
    dca::ArticulatedMatrix<double, 6> const outboard{inboard.inertia, inboard.carry, inboard.tip,
                                                     inboard.tip};
    Vector<double, 6> soft;
    for (int i = 0; i < 6; ++i) soft[i] = random.uniform() + 0.1;
    soft = (1 / norm(soft)) * soft;
    for (int i = 0; i < 6; ++i) inboard.tip(i, 2) = 1e15 * soft[i];
    dca::ArticulatedMatrix<double, 6> heavy = outboard;
    for (int i = 0; i < 6; ++i) heavy.inertia(i, i) = 1;
    dca::ArticulatedJoint<double, 6> joint;
    dca::ArticulatedMatrix<double, 6> const joined = join(inboard, heavy, 6, joint);
    // With mobility 1 + 1e30 s s^T and inertia 1: (1 + C)^-1 is 1/2 across s and 0 along it.
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j)
            EXPECT_NEAR(joined.inertia(i, j), 0.5 * ((i == j ? 1 : 0) - soft[i] * soft[j]),
                        32 * eps);
}

}  // namespace
}  // namespace catena::test
