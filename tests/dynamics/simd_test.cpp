// Runs side by side in a vector's lanes find what they find one after the other, whatever the ranks
// and threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "dca/simd/side_by_side.hpp"
#include "dynamics/joint/joint_lanes.hpp"
#include "error.hpp"
#include "integrate/joint_integrators.hpp"
#include "kinematics/joint_kinematics.hpp"
#include "reader/load_scene.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/integrators.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

using Accelerations = ChainSystem::Accelerations;

Scene scene_of(std::string const& chains) {
    return parse_scene("chains: [" + chains + "]\nforces: {gravity: [1, 2, -9.81]}", "scene.yaml");
}
std::string chain(std::string const& joint, int bodies) {
    return std::string("{base: ") + (bodies % 2 == 1 ? "fixed" : "free") +
           ", generator: {random: {bodies: " + std::to_string(bodies) + ", joint: " + joint +
           ", seed: 3}}}";
}

Accelerations found(Scene scene, Axes axes, SimdLevel level, int threads,
                    Communicator const& communicator) {
    scene.solver.backend = threads == 1 ? Backend::segments : Backend::openmp;
    scene.solver.threads = threads;
    scene.solver.simd = level;
    ChainSystem system(scene, axes, communicator);
    system.evaluate(false);
    EXPECT_LE(system.residual(), system.residual_bound());
    for (SolverReport const& report : system.solver_reports())
        EXPECT_TRUE(report.simd == level || report.simd == SimdLevel::off);
    return system.accelerations();
}

bool same(Accelerations const& a, Accelerations const& b) {
    return same_bits(a.acceleration, b.acceleration) && same_bits(a.alpha, b.alpha) &&
           same_bits(a.joint_force, b.joint_force) && same_bits(a.tip_force, b.tip_force);
}

/// Largest difference over the largest value.
double difference(std::vector<Vec3> const& a, std::vector<Vec3> const& b) {
    double most = 0, worst = 0;
    for (Vec3 const& v : a) most = std::max(most, norm(v));
    for (std::size_t k = 0; k < a.size(); ++k) worst = std::max(worst, norm(a[k] - b[k]));
    return worst == 0 ? 0 : worst / most;
}

/// The same operations in the same order, in vectors of any width. Where the rest of the program
/// rounds products before it adds, a chain of n bodies lets the last digits of that grow like n.
void expect_found(Scene const& scene, Axes axes, std::string const& what) {
    auto const alone = serial_communicator();
    Communicator const& world = testing::world();
    Accelerations const expected = found(scene, axes, SimdLevel::off, 1, *alone);
    std::optional<Accelerations> narrow;  // in the first vectors
    for (SimdLevel const level : simd_levels()) {
        std::string const name = what + ", " + name_of(level);
        Accelerations const one = found(scene, axes, level, 1, *alone),
                            shared = found(scene, axes, level, 1, world);
        double const tolerance = 64 * static_cast<double>(scene.bodies()) * 0x1p-53;
        EXPECT_LE(difference(expected.acceleration, one.acceleration), tolerance) << name;
        EXPECT_LE(difference(expected.alpha, one.alpha), tolerance) << name;
        bool const as_one_by_one = rounds_as_vectors();
        EXPECT_TRUE(!as_one_by_one || same(expected, one)) << name;
        if (level != SimdLevel::off && !narrow) narrow = one;
        EXPECT_TRUE(!rounds_as_vectors() || !narrow || same(*narrow, one))
            << name << ", other vectors";
        EXPECT_TRUE(world.rank() > 0 || same(one, shared))
            << name << ", " << world.size() << " ranks";
        if (world.size() > 1 || !openmp_is_built()) continue;
        for (int const threads : {2, 3})
            EXPECT_TRUE(same(one, found(scene, axes, level, threads, *alone)))
                << name << ", " << threads;
    }
}

class Simd : public ::testing::TestWithParam<char const*> {};

TEST_P(Simd, IsUsedWhereAChainHasRunsForIt) {
    std::string const joint = GetParam();
    auto const alone = serial_communicator();
    Scene scene = scene_of(chain(joint, 255));
    scene.solver.backend = Backend::segments;
    for (SimdLevel const level : simd_levels()) {
        scene.solver.simd = level;
        ChainSystem const system(scene, Axes::joint, *alone);
        // Handles carry more directions than these joints restrict, which no vector does.
        bool const padded = joint == "mixed" || joint == "cylindrical" || joint == "planar3";
        EXPECT_EQ(system.solver_reports().front().simd, padded ? SimdLevel::off : level) << joint;
    }
}

TEST_P(Simd, FindsTheSame) {
    for (int const bodies : {1, 2, 3, 31, 32, 33, 34, 50, 51, 133, 255, 256, 257, 2047, 2048, 2049})
        expect_found(scene_of(chain(GetParam(), bodies)), Axes::joint,
                     std::string(GetParam()) + " " + std::to_string(bodies));
}
TEST_P(Simd, FindsTheSameInSeveralChains) {
    std::string const joint = GetParam();
    expect_found(scene_of(chain(joint, 70) + ", " + chain(joint, 333) + ", " + chain(joint, 16) +
                          ", " + chain("mixed", 80) +
                          ", {count: 9, base: free, generator: {random: {bodies: 49, joint: " +
                          joint + ", seed: 4}}}"),
                 Axes::joint, "several chains, " + joint);
}
INSTANTIATE_TEST_SUITE_P(Joints, Simd,
                         ::testing::Values("link", "planar", "spherical", "universal", "revolute",
                                           "prismatic", "helical", "mixed", "cylindrical",
                                           "planar3"),
                         [](auto const& each) { return std::string(each.param); });

TEST(SimdInAbsoluteCoordinates, FindsTheSame) {
    for (char const* const joint : {"link", "spherical"})
        for (int const bodies : {1, 31, 48, 256, 257, 2049})
            expect_found(scene_of(chain(joint, bodies)), Axes::world,
                         std::string(joint) + " " + std::to_string(bodies));
    expect_found(scene_of("{generator: {random: {bodies: 300, joint: link, rigid: 0.5, seed: 8}}}"),
                 Axes::world, "bodies on links");
}

/// Whole runs up to where they are closed.
TEST(SimdOfClosedChains, FindsTheSame) {
    expect_found(scene_of("{base: fixed, tip: {joint: {type: spherical}}, generator: {random: "
                          "{bodies: 64, joint: spherical, seed: 4}}}"),
                 Axes::joint, "jointed tip");
    expect_found(scene_of("{base: free, tip: {ring: {type: spherical, translation: [1, 0, 0]}}, "
                          "generator: {polygon: {bodies: 64, joint: "
                          "spherical, spin: [1, 2, 3]}}}"),
                 Axes::joint, "ring");
}

/// Some joints restrict less than handles carry: their runs and merges go one by one among the
/// others.
TEST(SimdOfMixedJoints, FindsTheSame) {
    for (std::size_t const distance : {16, 24, 96}) {
        RandomChainOptions options;
        options.bodies = 1500;
        options.joints = RandomJoints::revolute;
        Scene scene;
        scene.chains = {random_chain(5, options)};
        scene.chains[0].name = "chain";
        BodyArrays& b = scene.chains[0].bodies;
        for (std::size_t k = distance; k < b.size(); k += distance) {
            b.joint[k] = JointType::spherical;
            b.q[k] = {1, 0, 0, 0};
        }
        expect_found(scene, Axes::joint,
                     "a spherical joint after " + std::to_string(distance) + " bodies");
    }
}

/// What a step moves and what it needs for that, with every kind of load, and angles of many turns.
TEST(SimdOfSteps, FindTheSame) {
    auto const alone = serial_communicator();
    for (RandomJoints const joints :
         {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::universal,
          RandomJoints::prismatic, RandomJoints::helical, RandomJoints::planar, RandomJoints::any,
          RandomJoints::cylindrical, RandomJoints::planar3, RandomJoints::all})
        for (bool const springs : {false, true}) {
            RandomChainOptions options;
            options.bodies = 150;
            options.joints = joints;
            options.base = springs ? Base::free : Base::fixed;
            options.springs = options.drag = springs;
            Scene scene;
            scene.chains = {random_chain(7, options)};
            scene.chains[0].name = "chain";
            scene.forces.gravity = {{1, 2, -9.81}};
            if (!springs && (joints == RandomJoints::revolute || joints == RandomJoints::universal))
                for (std::size_t k = 1; k < options.bodies;
                     k += 3)  // where a cosine's argument is reduced in another way, and beyond
                    scene.chains[0].bodies.q[k][0] += k % 2 == 1
                                                          ? 3e5 + 7.1 * static_cast<double>(k)
                                                          : -1e12 * static_cast<double>(k);
            auto const after_steps = [&](SimdLevel level, Communicator const& communicator,
                                         int threads = 1) {
                scene.solver.simd = level;
                scene.solver.backend = threads == 1 ? Backend::segments : Backend::openmp;
                scene.solver.threads = threads;
                ChainSystem system(scene, Axes::joint, communicator);
                auto const rk4 = make_runge_kutta4(system),
                           pair = make_dormand_prince(system, 1e-6, 1e-4);
                for (int i = 0; i < 5; ++i) (i < 3 ? rk4 : pair)->step(1e-4);
                return system.snapshot();
            };
            auto const expected = after_steps(SimdLevel::off, *alone);
            std::optional<SceneMotion> narrow;  // in the first vectors
            for (SimdLevel const level : simd_levels()) {
                std::string const name = std::string(name_of(level)) + ", joints " +
                                         std::to_string(static_cast<int>(joints)) +
                                         (springs ? ", springs" : ", many turns");
                auto const found = after_steps(level, *alone),
                           shared = after_steps(level, testing::world());
                auto const same_state = [](SceneMotion const& a, SceneMotion const& b) {
                    return same_bits(a.position, b.position) && same_bits(a.velocity, b.velocity) &&
                           same_bits(a.orientation, b.orientation);
                };
                bool const as_one_by_one = rounds_as_vectors();
                EXPECT_TRUE(!as_one_by_one || same_state(found, expected)) << name;
                double const tolerance = 64 * static_cast<double>(options.bodies) * 0x1p-53;
                EXPECT_LE(difference(expected.position, found.position), tolerance) << name;
                EXPECT_LE(difference(expected.velocity, found.velocity), tolerance) << name;
                if (level != SimdLevel::off && !narrow) narrow = found;
                EXPECT_TRUE(!rounds_as_vectors() || !narrow || same_state(*narrow, found))
                    << name << ", other vectors";
                EXPECT_TRUE(testing::world().rank() > 0 || same_state(found, shared))
                    << name << ", ranks";
                if (testing::world().size() > 1 || !openmp_is_built()) continue;
                EXPECT_TRUE(same_state(found, after_steps(level, *alone, 2))) << name;
            }
        }
}

/// Of a chain's bodies all go side by side but those near its ends and near other joints, whose
/// neighbours differ.
TEST(SimdOfSteps, DealOutBodiesOfOneType) {
    auto const alone = serial_communicator();
    Scene const scene = scene_of(chain("revolute", 100));
    auto const groups = make_groups(scene, Axes::joint, Handles::projected, false, *alone);
    for (SimdLevel const level : simd_levels()) {
        JointLanes const lanes(*groups.front(), false, false, level);
        ASSERT_EQ(lanes.any(), level != SimdLevel::off && rounds_as_vectors());
        if (!lanes.any()) continue;
        std::vector<int> seen(100, 0);
        std::int64_t several = 0;
        auto const executor = serial_executor(level);
        lanes.each(
            HostSpace(*executor), false,
            [&](JointLoops const&, BodyLanes const& bodies, std::int64_t begin, std::int64_t end) {
                for (std::int64_t i = begin; i < end; ++i, ++several)
                    for (int j = 0; j < lanes_of(level); ++j)
                        ++seen[static_cast<std::size_t>(bodies.first[i] + j)];
            },
            [&](std::int64_t k) { ++seen[static_cast<std::size_t>(k)]; });
        EXPECT_EQ(seen, std::vector<int>(100, 1));
        EXPECT_EQ(several, 98 / lanes_of(level));
    }
}

/// The scan along the chains with their runs in lanes leaves the bits of the one without.
template <bool positions>
void expect_followed(Scene const& scene, std::string const& what) {
    Communicator const& ranks = testing::world();
    for (auto const& group : make_groups(scene, Axes::joint, Handles::projected, false, ranks))
        for (SimdLevel const level : simd_levels()) {
            JointLanes const lanes(*group, false, false, level);
            if (!lanes.any()) continue;
            auto const executor = serial_executor(level);
            HostSpace const space(*executor);
            JointState state = make_joint_state(*group, scene);
            BodyMotion one(*group, space), several(*group, space);
            JointKinematics<HostSpace> kinematics(*group, space, ranks);
            kinematics.evaluate(state.view(), positions, one.view());
            JointScan const scan = kinematics.scan(state.view(), several.view());
            for (std::int64_t k = 0; k < group->size; ++k) scan.set_relative<positions>(k);
            lanes.follow(space, positions, scan);
            kinematics.sweep<positions>(scan, lanes.tree(), BodyExchange<4>::none());
            for (std::int64_t k = 0; k < group->size; ++k) scan.set_motion<positions>(k);
            std::string const name =
                what + ", " + name_of(level) + (positions ? ", positions" : "");
            auto const same_field = [](auto& a, auto& b) {
                auto const x = a.storage(), y = b.storage();
                return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size_bytes()) == 0;
            };
            EXPECT_TRUE(same_field(one.orientation, several.orientation)) << name;
            EXPECT_TRUE(same_field(one.omega, several.omega)) << name;
            EXPECT_TRUE(same_field(one.origin, several.origin)) << name;
            EXPECT_TRUE(same_field(one.velocity, several.velocity)) << name;
        }
}
TEST(SimdOfScans, FollowRunsAsOneByOne) {
    for (RandomJoints const joints :
         {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::universal,
          RandomJoints::helical, RandomJoints::planar, RandomJoints::any, RandomJoints::cylindrical,
          RandomJoints::planar3, RandomJoints::all})
        for (Base const base : {Base::fixed, Base::free})
            for (std::size_t const bodies : {96U, 303U}) {
                RandomChainOptions options;
                options.bodies = bodies;
                options.joints = joints;
                options.base = base;
                Scene scene;
                scene.chains = {random_chain(11, options), random_chain(12, options)};
                scene.chains[0].name = "one", scene.chains[1].name = "two";
                std::string const what = "joints " + std::to_string(static_cast<int>(joints)) +
                                         ", " + std::to_string(bodies) + " bodies";
                expect_followed<false>(scene, what);
                expect_followed<true>(scene, what);
            }
}

/// On one rank: the oracle of all ranks' is the same.
TEST(SimdOfLongChains, FindsTheSame) {
    if (testing::world().size() > 1)
        GTEST_SKIP() << "NOT RUN: its oracle of all ranks' chains is the same on one rank";
    for (char const* const joint : {"link", "spherical", "revolute"})
        expect_found(scene_of(chain(joint, 100001)), Axes::joint, joint);
}

TEST(SimdLevels, AreNamedAndRefusedWhereTheyCannotRun) {
    EXPECT_EQ(simd_levels().front(), SimdLevel::off);
    EXPECT_EQ(best_simd_level(), simd_levels().back());
    Scene scene = scene_of(chain("link", 40));
    scene.solver.simd = SimdLevel::avx512;
    bool const here = simd_levels().back() == SimdLevel::avx512;
    if (here)
        EXPECT_EQ(choose_simd_level(scene, testing::world()), SimdLevel::avx512);
    else
        EXPECT_THROW(choose_simd_level(scene, testing::world()), InputError);
}

constexpr dca::RunsTaken whole{false, false}, of_parts{true, false}, within_chains{false, true};

/// Which runs go side by side depends on the scene alone; lanes that are left over repeat one.
TEST(SimdLevels, DealOutWholeRuns) {
    auto const alone = serial_communicator();
    Scene const scene = scene_of(chain("revolute", 16 * 12 + 5));
    auto const groups = make_groups(scene, Axes::joint, Handles::projected, false, *alone);
    dca::RunsDealtOut dealt = dca::deal_out_runs(*groups.front(), 8, whole);
    ASSERT_EQ(dealt.items.size(), 2u);
    EXPECT_EQ(dealt.others.size(), 1u);  // the last, of five bodies
    EXPECT_EQ(dealt.items[0].body[0], 0);
    EXPECT_EQ(dealt.items[1].body[3], 16 * 11);
    EXPECT_EQ(dealt.items[1].body[7], 16 * 8);
    dealt = dca::deal_out_runs(*groups.front(), 8, within_chains);
    EXPECT_EQ(dealt.others.size(), 2u);  // and the first, which has no neighbour
    EXPECT_EQ(dealt.items[0].body[0], 16);
}

/// A shorter run has the last columns of its lane, down to a part's bodies.
TEST(SimdLevels, DealOutShorterRuns) {
    auto const alone = serial_communicator();
    for (int const last : {1, 3, 4, 5, 15, 16}) {
        Scene const scene = scene_of(chain("revolute", 16 * 3 + last));
        auto const groups = make_groups(scene, Axes::joint, Handles::projected, false, *alone);
        dca::RunsDealtOut const dealt = dca::deal_out_runs(*groups.front(), 8, of_parts);
        bool const taken = last >= 4;
        ASSERT_EQ(dealt.items.size(), 1u);
        EXPECT_EQ(dealt.others.size(), taken ? 0u : 1u) << last;
        dca::RunsInLanes const& item = dealt.items.front();
        EXPECT_EQ(item.late, taken && last < 16 ? 0x08 : 0) << last;
        EXPECT_EQ(item.begins[0], 0xff);
        for (int j = 0; j < 8; ++j) {
            std::int64_t const run = j < (taken ? 4 : 3) ? j : 0;
            int const skipped = run == 3 ? 16 - last : 0;
            EXPECT_EQ(item.body[j], 16 * run) << j;
            EXPECT_EQ(item.skipped[j], skipped) << j;
            EXPECT_EQ(item.column[j], 16 * run - skipped) << j;
            EXPECT_EQ(item.begins[skipped] >> j & 1, 1) << j;
        }
    }
    // Not alone in a vector; with others of its kind.
    auto const left = [&](std::string const& chains) {
        Scene const scene = scene_of(chains);
        return dca::deal_out_runs(
                   *make_groups(scene, Axes::joint, Handles::projected, false, *alone).front(), 8,
                   of_parts)
            .others.size();
    };
    EXPECT_EQ(left(chain("revolute", 16 * 8 + 5)), 1u);
    EXPECT_EQ(left(chain("revolute", 16 * 8 + 5) + ", " + chain("revolute", 16 * 8 + 7)), 2u);
    EXPECT_EQ(
        left(
            "{count: 3, base: free, generator: {random: {bodies: 133, joint: revolute, seed: 4}}}"),
        0u);
}

/// Nor one whose tip is joined to the ground, nor few.
TEST(SimdLevels, LeaveJointedTipsAndShortChainsToOthers) {
    auto const alone = serial_communicator();
    Scene const few = scene_of(chain("spherical", 32)),
                enough = scene_of(chain("spherical", 32) + ", " + chain("spherical", 16));
    EXPECT_TRUE(
        dca::deal_out_runs(
            *make_groups(few, Axes::joint, Handles::projected, false, *alone).front(), 8, whole)
            .items.empty());
    EXPECT_EQ(
        dca::deal_out_runs(
            *make_groups(enough, Axes::joint, Handles::projected, false, *alone).front(), 8, whole)
            .items.size(),
        1u);
    for (bool const jointed : {false, true}) {
        std::string const tip = jointed ? "tip: {joint: {type: spherical}}, " : "";
        Scene const scene =
            scene_of("{base: fixed, " + tip +
                     "generator: {random: {bodies: 48, joint: spherical, seed: 4}}}");
        auto const groups = make_groups(scene, Axes::joint, Handles::projected, false, *alone);
        EXPECT_EQ(dca::deal_out_runs(*groups.front(), 8, whole).others.size(), jointed ? 1u : 0u);
    }
}

}  // namespace
}  // namespace catena::test
