// Chains of rigid bodies with loops: accelerations and forces against the oracles, for every
// backend on the host and every kind of handles.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "joints/joint_models.hpp"
#include "oracle/oracle.hpp"
#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "scene/loops.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/reference_data.hpp"
#include "tests/support/same_bits.hpp"
#include "tests/support/variants.hpp"

namespace catena::test {
namespace {

Variant const variants[] = {
    {Backend::serial, Handles::projected},     {Backend::serial, Handles::full},
    {Backend::segments, Handles::projected},   {Backend::segments, Handles::full},
    {Backend::segments, Handles::articulated}, {Backend::openmp, Handles::projected}};

JointType const types[] = {JointType::spherical,   JointType::revolute,  JointType::universal,
                           JointType::weld,        JointType::prismatic, JointType::helical,
                           JointType::cylindrical, JointType::planar3};

RandomJoints const kinds[] = {RandomJoints::spherical, RandomJoints::mixed,  RandomJoints::revolute,
                              RandomJoints::any,       RandomJoints::planar, RandomJoints::all};

class Loops : public WithVariant {};
INSTANTIATE_TEST_SUITE_P(Variants, Loops, testing::ValuesIn(variants), name_of_variant);

/// A random chain whose loops leave it some motion; `count` is the largest number of loops.
ChainSpec looped_chain(std::uint64_t seed, std::size_t bodies, std::size_t count, JointType type) {
    RandomChainOptions options;
    options.bodies = bodies;
    options.joints = kinds[seed % std::size(kinds)];
    options.base = seed % 2 == 0 ? Base::fixed : Base::free;
    options.springs = seed % 3 == 0;
    options.drag = seed % 4 == 0;
    ChainSpec chain = random_chain(seed, options);
    std::int64_t const free = scene::degrees_of_freedom(chain);
    auto const most =
        static_cast<std::size_t>(std::max<std::int64_t>(1, (free - 2) / restricted_by(type)));
    add_random_loops(chain, 77 + seed, std::min(count, most), type);
    return chain;
}

Scene scene_of(ChainSpec chain) {
    Scene scene;
    scene.chains.push_back(std::move(chain));
    scene.forces.gravity = {{1, 2, -9.81}};
    return scene;
}

/// How much errors in the closing of joints, relative to the accelerations, grow in the
/// accelerations; at least 1. Loops near a singular position are sensitive.
double growth(Scene const& scene, oracle::OracleResult<long double> const& exact) {
    double const small = 1e-8;
    double size = 0, most = 1;
    for (auto const& a : exact.com_acceleration)
        for (int i = 0; i < 3; ++i) size = std::max(size, std::abs(static_cast<double>(a[i])));
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Random random(seed);
        oracle::Loads loads{scene.forces.gravity, {}};
        for (std::size_t k = 0; k < scene.chains[0].size(); ++k)
            loads.gaps.emplace_back(random.vector(small * size), random.vector(small * size));
        auto const moved = oracle::aba<long double>(scene.chains[0], loads);
        for (auto const& [a, b] : {std::pair{&moved.com_acceleration, &exact.com_acceleration},
                                   std::pair{&moved.alpha, &exact.alpha}})
            most = std::max(most, static_cast<double>(relative_difference(*a, *b)) / small);
    }
    return most;
}

struct Errors {
    double acceleration = 0, residual = 0, bound = 0;
};
Errors errors(Scene const& scene, oracle::OracleResult<long double> const& exact,
              Communicator const& communicator) {
    ChainSystem system(scene, Axes::joint, communicator);
    system.evaluate();
    ChainSystem::Accelerations const found = system.accelerations();
    auto const error = [](std::vector<Vec3> const& values,
                          std::vector<Vector<long double, 3>> const& right) {
        return static_cast<double>(relative_difference(converted<long double>(values), right));
    };
    return {std::max(error(found.acceleration, exact.com_acceleration),
                     error(found.alpha, exact.alpha)),
            system.residual(), system.residual_bound()};
}

/// Expects the accelerations of articulated bodies in another scalar, and a residual within its
/// bound.
void expect_articulated_bodies(Scene const& scene, Communicator const& communicator) {
    auto const exact = oracle::aba<long double>(scene.chains[0], {scene.forces.gravity, {}});
    Errors const e = errors(scene, exact, communicator);
    // Loop forces grow by the same factor, and their rounding with them.
    double const grown = growth(scene, exact);
    EXPECT_LE(e.acceleration, std::max(1e-10, 1e-15 * grown * grown));
    EXPECT_LE(e.residual, e.bound);
}

/// All constraints at once, in another scalar and by another solver.
TEST_P(Loops, agree_with_one_dense_system) {
    double worst = 0;
    for (JointType const type : types)
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            SCOPED_TRACE(fmt::format("{} {}", name_of(type), seed));
            Scene const scene = with_backend(scene_of(looped_chain(seed, 9, 6, type)));
            auto const exact =
                oracle::dense<long double>(scene.chains[0], {scene.forces.gravity, {}});
            Errors const e = errors(scene, exact, *communicator_);
            EXPECT_LE(e.acceleration, 1e-10);
            EXPECT_LE(e.residual, e.bound);
            worst = std::max(worst, e.acceleration);
        }
    RecordProperty("acceleration_error", fmt::format("{:.1e}", worst));
}

/// Longer chains with up to six loops, against articulated bodies and unit wrenches.
TEST_P(Loops, agree_with_articulated_bodies) {
    for (JointType const type : types)
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            SCOPED_TRACE(fmt::format("{} {}", name_of(type), seed));
            Scene const scene = with_backend(scene_of(looped_chain(seed, 40, 6, type)));
            ASSERT_EQ(scene.chains[0].loops.size(), 6U);
            expect_articulated_bodies(scene, *communicator_);
        }
}

/// Branched chains: cranks on one body, joined to each other.
TEST_P(Loops, close_in_trees_as_in_chains) {
    if (GetParam().handles != Handles::articulated)
        GTEST_SKIP() << "trees have articulated handles";
    for (JointType const type : types)
        for (std::uint64_t seed = 0; seed < 6; ++seed) {
            SCOPED_TRACE(fmt::format("{} {}", name_of(type), seed));
            ChainSpec chain =
                random_chain(seed, {.bodies = 30,
                                    .joints = kinds[seed % 3],
                                    .base = seed % 2 == 0 ? Base::fixed : Base::free});
            Random random(seed);
            chain.parent = {-1};
            for (std::int64_t k = 1; k < 30; ++k)
                chain.parent.push_back(static_cast<std::int64_t>(static_cast<double>(k) *
                                                                 std::sqrt(random.uniform())));
            add_random_loops(chain, seed, 4, type);
            Scene const scene = with_backend(scene_of(chain));
            expect_articulated_bodies(scene, *communicator_);
        }
}

/// A planar linkage of two loops is held three times more than it needs by either.
TEST_P(Loops, of_a_planar_linkage_are_redundant_in_space) {
    Scene scene = with_backend(load_scene(CATENA_SOURCE_DIR "/inputs/six-bar.yaml"));
    ChainSpec& chain = scene.chains[0];
    EXPECT_EQ(chain.redundant_directions, 6);
    EXPECT_EQ(scene::degrees_of_freedom(chain), 1);
    oracle::project_velocities(chain);
    EXPECT_GT(norm(chain.bodies.qd[4]), 0.1);
    auto const exact = oracle::aba<long double>(chain, {scene.forces.gravity, {}});
    Errors const e = errors(scene, exact, *communicator_);
    EXPECT_LE(e.acceleration, 1e-10);
    EXPECT_LE(e.residual, e.bound);
}

/// A joint of the last body to the ground is the same as a tip or as a loop.
TEST_P(Loops, act_as_tips_do) {
    if (GetParam().handles == Handles::articulated) GTEST_SKIP() << "tips have other handles";
    for (JointType const type : types) {
        SCOPED_TRACE(name_of(type));
        Scene tipped = with_backend(scene_of(random_chain(
            5, {.bodies = 9, .joints = RandomJoints::mixed, .base = Base::fixed, .tip = type})));
        Scene looped = tipped;
        ChainSpec& chain = looped.chains[0];
        LoopClosure loop;
        loop.inboard = 8;
        loop.joint = chain.tip_joint;
        chain.tip = Tip::free;
        scene::Pose const end = scene::held_frame(scene::start_poses(chain), loop);
        loop.end_rotation = to_matrix(end.orientation);
        loop.end_translation = end.origin;
        chain.loops = {loop};
        auto const solved = [&](Scene const& scene) {
            ChainSystem system(scene, Axes::joint, *communicator_);
            system.evaluate();
            return system.accelerations();
        };
        ChainSystem::Accelerations const as_tip = solved(tipped), as_loop = solved(looped);
        EXPECT_LE(relative_difference(as_loop.acceleration, as_tip.acceleration), 1e-11);
        EXPECT_LE(relative_difference(as_loop.joint_acceleration, as_tip.joint_acceleration),
                  1e-11);
        ASSERT_EQ(as_loop.loop_force.size(), 1U);
        double const size = norm(as_tip.tip_force[0].wrench);
        EXPECT_GT(size, 0.1);
        EXPECT_LE(norm(as_loop.loop_force[0].wrench - as_tip.tip_force[0].wrench), 1e-10 * size);
    }
}

/// Refined solutions meet the equations as well, loops among them.
TEST_P(Loops, are_refined) {
    Scene scene = with_backend(scene_of(looped_chain(3, 20, 4, JointType::universal)));
    scene.solver.refine = 1;
    auto const exact = oracle::aba<long double>(scene.chains[0], {scene.forces.gravity, {}});
    ChainSystem system(scene, Axes::joint, *communicator_);
    system.evaluate();
    double const before = system.residual();
    system.refine();
    EXPECT_LE(system.residual(), std::max(before, 1e-15));
    EXPECT_LE(
        static_cast<double>(relative_difference(
            converted<long double>(system.accelerations().acceleration), exact.com_acceleration)),
        1e-11);
}

TEST(LoopsOfAChain, have_the_same_bits_on_any_number_of_threads) {
    if (!openmp_is_built()) GTEST_SKIP() << "NOT RUN: this build is without OpenMP";
    auto const communicator = serial_communicator();
    Scene scene = scene_of(looped_chain(1, 200, 6, JointType::spherical));
    auto const solved = [&](Backend backend, int threads) {
        scene.solver.backend = backend;
        scene.solver.threads = threads;
        ChainSystem system(scene, Axes::joint, *communicator);
        system.evaluate();
        return system.accelerations();
    };
    auto const one = solved(Backend::segments, 1);
    for (int const threads : {1, 2, 3}) {
        auto const many = solved(Backend::openmp, threads);
        EXPECT_TRUE(same_bits(one.acceleration, many.acceleration)) << threads;
        EXPECT_TRUE(same_bits(one.joint_acceleration, many.joint_acceleration)) << threads;
    }
}

/// Chains of one group have systems of their own, of different sizes.
TEST(LoopsOfAChain, do_not_depend_on_other_chains) {
    auto const communicator = serial_communicator();
    ChainSpec const a = looped_chain(3, 20, 4, JointType::revolute),
                    b = looped_chain(9, 30, 2, JointType::revolute);
    Scene both = scene_of(a);
    both.chains.push_back(b);
    both.chains.push_back(random_chain(4, {.bodies = 7, .joints = RandomJoints::mixed}));
    auto const solved = [&](Scene const& scene) {
        ChainSystem system(scene, Axes::joint, *communicator);
        system.evaluate();
        return system.accelerations();
    };
    auto const together = solved(both), of_a = solved(scene_of(a)), of_b = solved(scene_of(b));
    std::vector<Vec3> const first(together.acceleration.begin(),
                                  together.acceleration.begin() + 20),
        second(together.acceleration.begin() + 20, together.acceleration.begin() + 50);
    EXPECT_TRUE(same_bits(first, of_a.acceleration));
    EXPECT_TRUE(same_bits(second, of_b.acceleration));
    EXPECT_EQ(together.loop_force.size(), a.loops.size() + b.loops.size());
}

/// A driven crank moves the linkage; nothing else is free.
TEST(LoopsOfAChain, follow_a_driven_joint) {
    auto const communicator = serial_communicator();
    Scene scene = load_scene(
        CATENA_SOURCE_DIR "/inputs/six-bar.yaml",
        {"chains[0].bodies[0].joint.qd=null", "chains[0].bodies[0].joint.motion={rate: 3}"});
    ChainSpec& chain = scene.chains[0];
    EXPECT_EQ(scene::degrees_of_freedom(chain), 0);
    EXPECT_EQ(chain.redundant_directions, 6);
    oracle::project_velocities(chain);
    EXPECT_EQ(chain.bodies.qd[0][0], 3);
    auto const exact = oracle::aba<long double>(chain, {scene.forces.gravity, {}});
    Errors const e = errors(scene, exact, *communicator);
    EXPECT_LE(e.acceleration, 1e-10);
    EXPECT_LE(e.residual, e.bound);
}

/// Two driven joints contradict the loops: nothing meets all equations.
TEST(LoopsOfAChain, that_contradict_driven_joints_are_refused_by_name) {
    auto const communicator = serial_communicator();
    Scene const scene = load_scene(
        CATENA_SOURCE_DIR "/inputs/six-bar.yaml",
        {"chains[0].bodies[0].joint.qd=null", "chains[0].bodies[0].joint.motion={rate: 3}",
         "chains[0].bodies[1].joint.motion={rate: 5}"});
    ChainSystem system(scene, Axes::joint, *communicator);
    try {
        system.close_tips();
        ADD_FAILURE() << "accepted";
    } catch (ComputationError const& error) {
        EXPECT_EQ(std::string(error.what()),
                  "the prescribed motions of chain linkage contradict its loops: the joint between "
                  "body 3 and the ground would come apart; prescribe fewer joints, or other "
                  "motions");
    }
    system.evaluate();
    EXPECT_GT(system.residual(), 1e3 * system.residual_bound());
}

/// A small gap at the start is closed by the least change, as are velocities that do not fit.
TEST(LoopsOfAChain, are_closed_at_the_start) {
    auto const communicator = serial_communicator();
    Scene const scene = load_scene(CATENA_SOURCE_DIR "/inputs/six-bar.yaml",
                                   {"chains[0].loops[0].end=[2.00001, 0, 0]"});
    ChainSystem system(scene, Axes::joint, *communicator);
    JointDynamics& group = *system.joint().at(0);
    EXPECT_NEAR(group.closure_error() * group.reach(), 1e-5, 1e-9);
    system.close_tips(3);
    EXPECT_LE(group.closure_error(), 1e-15);
    JointState const closed = group.state();
    EXPECT_NE(closed.qd[4][0], 0);
    system.close_tips();
    for (std::int64_t k = 0; k < 5; ++k)
        EXPECT_NEAR(group.state().qd[k][0], closed.qd[k][0], 1e-13);
}

TEST(LoopsOfAChain, need_joint_coordinates) {
    auto const communicator = serial_communicator();
    Scene const scene = scene_of(looped_chain(0, 6, 1, JointType::spherical));
    EXPECT_THROW(ChainSystem(scene, Axes::world, *communicator), InputError);
}

}  // namespace
}  // namespace catena::test
