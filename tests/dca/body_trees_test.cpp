// Branched chains of rigid bodies: accelerations and joint forces against the oracles and against
// Pinocchio, the same bits on any number of threads, and what is refused.
#include <gtest/gtest.h>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "measure/solution.hpp"
#include "scene/branch_limits.hpp"
#include "tests/dca/campaign.hpp"
#include "tests/support/random_tree.hpp"
#include "tests/support/reference_data.hpp"

namespace catena::test {
namespace {

RandomJoints constexpr kinds[] = {RandomJoints::revolute,  RandomJoints::spherical,
                                  RandomJoints::universal, RandomJoints::prismatic,
                                  RandomJoints::helical,   RandomJoints::cylindrical,
                                  RandomJoints::planar3,   RandomJoints::weld,
                                  RandomJoints::mixed,     RandomJoints::all};
TreeShape constexpr shapes[] = {TreeShape::any, TreeShape::long_paths, TreeShape::bushy,
                                TreeShape::star};

/// Multiplies masses and inertias by random powers of ten within three decades.
void spread_masses(std::uint64_t seed, BodyArrays& bodies) {
    Random random(seed + 99);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
        double const factor = std::pow(10, random.uniform(-1.5, 1.5));
        bodies.mass[k] *= factor;
        for (double& moment : bodies.inertia[k].data) moment *= factor;
    }
}

CampaignCase tree_case(std::uint64_t seed, Backend backend) {
    CampaignCase c{.seed = seed, .kind = "tree", .chain = {}, .loads = {}};
    Random random(seed);
    RandomChainOptions const options{.bodies = 1 + static_cast<std::size_t>(random.uniform(0, 64)),
                                     .joints = kinds[seed % std::size(kinds)],
                                     .base = random.chance(0.5) ? Base::fixed : Base::free,
                                     .moving = random.chance(0.9),
                                     .loaded = random.chance(0.8),
                                     .springs = random.chance(0.4),
                                     .drag = random.chance(0.3),
                                     .driven = random.chance(0.25) ? 0.2 : 0};
    c.chain = random_tree(seed, options, shapes[(seed / std::size(kinds)) % std::size(shapes)]);
    spread_masses(seed, c.chain.bodies);
    if (random.chance(0.8)) c.loads.gravity = random.vector(10);
    c.backend = backend;
    return c;
}

TEST(BodyTrees, AgreeWithTheOracles) {
    double acceleration = 0, force = 0, oracles = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        CampaignCase const c = tree_case(seed, seed % 2 ? Backend::serial : Backend::segments);
        CampaignErrors const e = campaign_errors(c, c.chain);
        EXPECT_TRUE(e.good()) << "seed " << seed << ", " << c.chain.size()
                              << " bodies: " << e.text();
        EXPECT_LE(e.oracles, 1e-11) << "seed " << seed;
        acceleration = std::max(acceleration, e.acceleration);
        force = std::max(force, e.force);
        oracles = std::max(oracles, e.oracles);
        if (HasFailure()) break;
    }
    std::printf("largest error: accelerations %.1e, forces %.1e, between the oracles %.1e\n",
                acceleration, force, oracles);
}

/// A comparison that cannot fail shows nothing: a wrong parent must be found.
TEST(BodyTrees, AWrongParentIsFound) {
    CampaignCase const c = tree_case(3, Backend::serial);
    ASSERT_GT(c.chain.size(), 4U);
    ChainSpec wrong = c.chain;
    wrong.parent.back() = wrong.parent.back() == 0 ? 1 : 0;
    EXPECT_FALSE(campaign_errors(c, wrong).good());
}

Scene scene_of(ChainSpec const& chain, Vec3 const& gravity, Backend backend) {
    Scene scene;
    scene.chains = {chain};
    scene.chains[0].name = "tree";
    scene.forces.gravity = gravity;
    scene.solver.backend = backend;
    scene.solver.threads = 2;
    return scene;
}

TEST(BodyTrees, ReachPinocchio) {
    auto const communicator = serial_communicator();
    for (ReferenceChain const& r : reference_trees()) {
        Scene const scene = scene_of(r.chain, r.gravity, Backend::serial);
        ChainSystem system(scene, Axes::joint, *communicator);
        system.evaluate();
        ChainSystem::Accelerations const a = system.accelerations();
        EXPECT_LE(relative_difference(a.joint_acceleration, r.qdd), 1e-13) << r.name;
        EXPECT_LE(relative_difference(a.acceleration, r.com_acceleration), 1e-13) << r.name;
        EXPECT_LE(relative_difference(a.alpha, r.alpha), 1e-13) << r.name;
        EXPECT_LE(norm(a.base_acceleration[0] - r.base_acceleration), 1e-12) << r.name;
        auto const exact = oracle::aba<long double>(r.chain, {r.gravity, {}});
        EXPECT_LE(relative_difference(converted<long double>(a.joint_acceleration), exact.qdd),
                  1e-13L);
        std::vector<Vec3> torque, force, torque_of_it, force_of_it;
        for (std::size_t k = 0; k < r.chain.size(); ++k) {
            auto const& w = r.joint_wrench[k];
            torque.push_back({{w[0], w[1], w[2]}}), force.push_back({{w[3], w[4], w[5]}});
        }
        for (auto const& f : oracle::aba<double>(r.chain, {r.gravity, {}}).joint_force)
            torque_of_it.push_back(f.torque), force_of_it.push_back(f.force);
        EXPECT_LE(relative_difference(torque_of_it, torque), 1e-13) << r.name;
        EXPECT_LE(relative_difference(force_of_it, force), 1e-13) << r.name;
        auto const at = oracle::kinematics<double>(r.chain, {r.gravity, {}});
        EXPECT_LE(relative_difference(at.com_position, r.com_position), 1e-14) << r.name;
        SceneMotion const motion = system.snapshot();
        EXPECT_LE(relative_difference(motion.position, r.com_position), 1e-14) << r.name;
        EXPECT_LE(relative_difference(motion.velocity, r.com_velocity), 1e-14) << r.name;
    }
}

std::vector<double> accelerations_of(Scene const& scene) {
    auto const communicator = serial_communicator();
    ChainSystem system(scene, Axes::joint, *communicator);
    system.evaluate();
    return solution_of(system).acceleration;
}

/// Levels of 700 bodies are shared by threads.
TEST(BodyTrees, TheSameBitsOnAnyThreads) {
    for (TreeShape const shape : {TreeShape::any, TreeShape::star}) {
        ChainSpec const tree =
            random_tree(5, {.bodies = 1500, .joints = RandomJoints::all, .springs = true}, shape);
        Vec3 const gravity{{1, 2, -9}};
        std::vector<double> const alone =
            accelerations_of(scene_of(tree, gravity, Backend::serial));
        EXPECT_EQ(accelerations_of(scene_of(tree, gravity, Backend::segments)), alone);
        if (openmp_is_built()) {
            EXPECT_EQ(accelerations_of(scene_of(tree, gravity, Backend::openmp)), alone);
        }
    }
}

/// Bodies may be listed in any order with parents first.
TEST(BodyTrees, DoNotDependOnTheOrderOfTheList) {
    ReferenceChain const& r = reference_trees()[0];
    std::vector<std::size_t> const order{0, 1, 7, 4, 5, 2, 9, 3, 11, 10, 8, 6};
    ChainSpec other = r.chain;
    std::vector<std::int64_t> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<std::int64_t>(i);
    auto const reorder = [&](auto& values) {
        auto const old = values;
        for (std::size_t i = 0; i < order.size(); ++i) values[i] = old[order[i]];
    };
    BodyArrays& b = other.bodies;
    reorder(b.mass), reorder(b.com), reorder(b.inertia), reorder(b.joint), reorder(b.axis);
    reorder(b.rotation), reorder(b.translation), reorder(b.q), reorder(b.qd), reorder(b.torque);
    reorder(b.wrench), reorder(other.parent);
    for (std::int64_t& parent : other.parent)
        if (parent >= 0) parent = place[static_cast<std::size_t>(parent)];
    auto const communicator = serial_communicator();
    Scene const scene = scene_of(other, r.gravity, Backend::serial);
    ChainSystem system(scene, Axes::joint, *communicator);
    system.evaluate();
    std::vector<Vec3> found(order.size());
    ChainSystem::Accelerations const a = system.accelerations();
    for (std::size_t i = 0; i < order.size(); ++i) found[order[i]] = a.joint_acceleration[i];
    EXPECT_LE(relative_difference(found, r.qdd), 1e-13);
}

/// The solver's answer to residuals alone is the correction of a refinement.
TEST(BodyTrees, AreRefined) {
    ChainSpec tree = random_tree(8, {.bodies = 60, .joints = RandomJoints::all}, TreeShape::bushy);
    spread_masses(8, tree.bodies);
    Scene scene = scene_of(tree, {{0, 0, -9.81}}, Backend::serial);
    scene.solver.refine = 2;
    auto const communicator = serial_communicator();
    ChainSystem system(scene, Axes::joint, *communicator);
    system.evaluate();
    auto const exact = oracle::aba<long double>(tree, {scene.forces.gravity, {}});
    EXPECT_LE(relative_difference(converted<long double>(system.accelerations().joint_acceleration),
                                  exact.qdd),
              1e-13L);
    EXPECT_LE(system.correction(), 1e-13);
}

std::string refusal(Scene const& scene) {
    try {
        scene::refuse_unsupported_branches(scene);
    } catch (InputError const& error) {
        return error.what();
    }
    return {};
}

TEST(BodyTrees, RefuseWhatTheyDoNotSupport) {
    Scene scene =
        scene_of(random_tree(2, {.bodies = 6, .springs = true}), Vec3::zero(), Backend::automatic);
    EXPECT_EQ(refusal(scene), "");
    scene.solver.handles = Handles::full;
    EXPECT_NE(refusal(scene).find("articulated handles only"), std::string::npos);
    scene.solver.handles = Handles::articulated;
    EXPECT_EQ(refusal(scene), "");
    scene.dynamics.given = true;
    scene.dynamics.integrator = Integrator::rattle;
    EXPECT_NE(refusal(scene).find("joint coordinates only"), std::string::npos);
    scene.dynamics.integrator = Integrator::staggered;
    EXPECT_NE(refusal(scene).find("implicit springs"), std::string::npos);
    scene.dynamics.integrator = Integrator::rk4;
    EXPECT_EQ(refusal(scene), "");
    scene.chains[0].tip = Tip::jointed;
    EXPECT_NE(refusal(scene).find("a jointed tip"), std::string::npos);
}

}  // namespace
}  // namespace catena::test
