// What the GPU computes has the bits of the same tree on the host: one operation for one, each
// rounded alike.
#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "cuda/device/clusters.hpp"
#include "cuda/space/memory.hpp"
#include "integrate/chain_system.hpp"
#include "reader/load_scene.hpp"
#include "tests/support/gpu.hpp"
#include "tests/support/random_chain.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

using Accelerations = ChainSystem::Accelerations;

void expect_same_bits(Accelerations const& a, Accelerations const& b) {
    EXPECT_TRUE(same_bits(a.joint_acceleration, b.joint_acceleration));
    EXPECT_TRUE(same_bits(a.acceleration, b.acceleration));
    EXPECT_TRUE(same_bits(a.alpha, b.alpha));
    EXPECT_TRUE(same_bits(a.base_acceleration, b.base_acceleration));
    EXPECT_TRUE(same_bits(a.joint_force, b.joint_force));
    EXPECT_TRUE(same_bits(a.tip_force, b.tip_force));
}

class Gpu : public ::testing::Test {
  protected:
    void SetUp() override { need_gpu(); }
    /// Matrices and biases `apart`, and then so many times at once; several times without a host
    /// between them, too.
    Accelerations solve(Scene scene, Backend backend, Axes axes, int at_once = 0,
                        bool apart = true) const {
        scene.solver.backend = backend;
        ChainSystem system(scene, axes, *communicator_);
        EXPECT_EQ(system.backend(), backend);
        if (apart) system.evaluate();
        for (int i = 0; i < at_once; ++i) system.evaluate(false);
        if (at_once > 1)
            system.absolute().empty() ? system.joint().front()->time_at_once(at_once, 1)
                                      : system.absolute().front()->time_at_once(at_once, 1);
        EXPECT_LE(system.residual(), system.residual_bound());
        return system.accelerations();
    }
    void expect_same(Scene const& scene, Axes axes = Axes::joint) const {
        Accelerations const device = solve(scene, Backend::cuda, axes);
        expect_same_bits(device, solve(scene, Backend::segments, axes));
        SCOPED_TRACE("a second time");
        expect_same_bits(device, solve(scene, Backend::cuda, axes));
    }
    /// One chain whose tip is free: up to 8,192 bodies there is a launch of its own for it.
    void expect_same_short(char const* joint, int bodies, char const* base, int times) const {
        SCOPED_TRACE(std::string(joint) + " " + std::to_string(bodies) + " " + base);
        Axes const axes = joint == std::string("link") ? Axes::joint : Axes::world;
        Scene scene = scene_of(std::string("{base: ") + base + ", generator: {random: {bodies: " +
                                   std::to_string(bodies) + ", joint: " + joint + ", seed: 2}}}",
                               Handles::projected);
        scene.solver.simd = SimdLevel::off;
        std::int64_t const before = cuda::short_launches;
        Accelerations const device = solve(scene, Backend::cuda, axes, times);
        EXPECT_EQ(cuda::short_launches > before, bodies <= 8192 && cuda::knows_clusters());
        expect_same_bits(device, solve(scene, Backend::segments, axes, times));
    }
    /// Chains too long for that: a launch's blocks wait for the one above them. Several times in a
    /// row.
    void expect_same_together(std::string const& chains, Axes axes = Axes::joint,
                              bool above_groups = false) const {
        SCOPED_TRACE(chains);
        Scene scene = scene_of(chains, Handles::projected);
        scene.solver.simd = SimdLevel::off;
        bool const by_cluster = above_groups && cuda::knows_clusters();
        std::atomic<std::int64_t> const& launches =
            by_cluster ? cuda::groups_turned : cuda::turns_together;
        std::int64_t const before = launches;
        Accelerations const device = solve(scene, Backend::cuda, axes, 3);
        EXPECT_GE(launches, before + (by_cluster || cuda::blocks_at_once() > 0 ? 4 : 0));
        expect_same_bits(device, solve(scene, Backend::segments, axes, 3));
    }
    /// Matrices and biases in one sweep, of any number of bodies; it finds nothing of others before
    /// it.
    void expect_same_at_once(std::string const& chain, Axes axes) const {
        SCOPED_TRACE(chain);
        Scene scene = scene_of(chain, Handles::projected);
        scene.solver.simd = SimdLevel::off;
        expect_same_bits(solve(scene, Backend::cuda, axes, 2, false),
                         solve(scene, Backend::segments, axes, 2, false));
    }
    static std::string random_chain_of(int bodies, std::string const& joint,
                                       std::string const& rest = "base: fixed") {
        return "{" + rest + ", generator: {random: {bodies: " + std::to_string(bodies) +
               ", joint: " + joint + ", seed: 2}}}";
    }
    static Scene scene_of(std::string const& generator, Handles handles) {
        Scene scene = parse_scene("chains: [" + generator + "]\nforces: {gravity: [1, 2, -9.81]}",
                                  "scene.yaml");
        scene.solver.handles = handles;
        return scene;
    }
    static Scene scene_of(ChainSpec const& chain, Handles handles) {
        Scene scene;
        scene.chains = {chain};
        scene.forces.gravity = {{1, 2, -9.81}};
        scene.solver.handles = handles;
        return scene;
    }
    static std::vector<Handles> kinds(bool open_bodies) {
        std::vector<Handles> all{Handles::projected, Handles::full};
        if (open_bodies) all.push_back(Handles::articulated);
        return all;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

TEST_F(Gpu, EveryKindAndSize) {
    for (char const* const joint :
         {"link", "planar", "spherical", "universal", "revolute", "prismatic", "helical",
          "cylindrical", "planar3", "weld", "mixed"})
        for (int const bodies : {1, 2, 3, 31, 32, 33, 255, 256, 257, 2047, 2048, 2049})
            for (Handles const handles : kinds(std::string(joint) != "link"))
                for (char const* const base : {"free", "fixed"}) {
                    SCOPED_TRACE(std::string(joint) + " " + std::to_string(bodies) + " " + base +
                                 " " + name_of(handles));
                    expect_same(
                        scene_of(std::string("{base: ") + base + ", generator: {random: {bodies: " +
                                     std::to_string(bodies) + ", joint: " + joint + ", seed: 1}}}",
                                 handles));
                    if (HasFailure()) return;
                }
}

TEST_F(Gpu, ShortChains) {
    for (int const bodies :
         {1,    2,    4,    5,    15,   16,   17,   100,  127,  128,  129,  511, 1000,
          1024, 1025, 2047, 2048, 2049, 4095, 4096, 4097, 5000, 8191, 8192, 8193})
        for (char const* const joint : {"link", "spherical"})
            for (char const* const base : {"free", "fixed"}) {
                expect_same_short(joint, bodies, base, 1);
                if (HasFailure()) return;
            }
}

/// For the checkers: the next launch starts while the last one may still go on.
TEST_F(Gpu, ShortChainsInARow) {
    for (int const bodies : {129, 1025, 8192})
        for (char const* const joint : {"link", "spherical"})
            expect_same_short(joint, bodies, "fixed", 2);
}

TEST_F(Gpu, BlocksThatTurnTogether) {
    for (char const* const joint :
         {"link", "planar", "spherical", "universal", "revolute", "helical"})
        for (int const bodies : {8193, 20011, 131072, 270001}) {
            expect_same_together(random_chain_of(bodies, joint), Axes::joint,
                                 bodies == 270001 && joint == std::string("link"));
            if (HasFailure()) return;
        }
    for (int const bodies : {16384, 131072})
        expect_same_together(random_chain_of(bodies, "spherical"), Axes::world);
    std::string const tip = "base: fixed, tip: {joint: {type: spherical}}";
    expect_same_together(random_chain_of(20000, "spherical", tip + ", name: a") + ", " +
                         random_chain_of(700, "spherical", "name: b") + ", " +
                         random_chain_of(9000, "spherical", tip + ", name: c"));
    expect_same_together(random_chain_of(9000, "link", "name: a") + ", " +
                         random_chain_of(30, "link", "name: b, count: 200") + ", " +
                         random_chain_of(40000, "link", "name: c"));
}

/// Two groups, each of which wants most of the GPU at once.
TEST_F(Gpu, GroupsThatTurnTogether) {
    for (int i = 0; i < 5; ++i)
        expect_same_together(random_chain_of(131072, "link", "name: a") + ", " +
                             random_chain_of(131072, "spherical", "name: b"));
}

/// For the checkers.
TEST_F(Gpu, ShortTurnsTogether) {
    for (char const* const joint : {"link", "spherical"})
        expect_same_together(random_chain_of(8500, joint));
}

/// What never changes of bodies that are all alike has one tile of memory.
TEST_F(Gpu, AlikeBodies) {
    auto const expect_one_tile = [&](Scene const& scene) {
        ChainSystem const system(scene, Axes::joint, *communicator_);
        ChainGroup const& group = *system.groups().front();
        bool const one = group.size > 512;
        EXPECT_EQ(cuda::one_tile_serves(group.bodies.inverse_mass), one);
        EXPECT_EQ(group.bodies.r1.size() > 0 && cuda::one_tile_serves(group.bodies.r1),
                  one && group.bodies.r1.size() > 0);
        EXPECT_EQ(group.bodies.r2.size() > 0 && cuda::one_tile_serves(group.bodies.r2),
                  one && group.bodies.r2.size() > 0);
    };
    auto const of = [](std::string const& generator, int bodies,
                       std::string const& rest = "base: fixed") {
        return "{" + rest + ", generator: {" + generator + std::to_string(bodies) +
               ", mass: 2, length: 1.5}}}";
    };
    std::string const rods = "elastic_rod: {bend: 3, twist: 2, radius: 0.1, bodies: ",
                      beads = "freely_jointed: {beads: ",
                      ring = "polygon: {joint: spherical, spin: [0.1, 0.2, 0.3], bodies: ";
    for (int const bodies : {512, 513, 2049, 20011, 140001}) {
        SCOPED_TRACE(bodies);
        for (std::string const& kind :
             {of("pendulum: {links: ", bodies), of(beads, bodies), of(rods, bodies)})
            expect_one_tile(scene_of(kind, Handles::projected));
        expect_same(scene_of(of("pendulum: {links: ", bodies), Handles::projected));
        for (char const* const base : {"base: fixed", "base: free"}) {
            expect_same(scene_of(of(beads, bodies, base), Handles::projected));
            expect_same_at_once(of(beads, bodies, base), Axes::joint);
            expect_same(scene_of(of(rods, bodies, base), Handles::projected));
        }
        expect_same(scene_of(of(rods, bodies, "base: free"), Handles::projected),
                    Axes::world);  // a fixed one is welded
        expect_same_at_once(of(rods, bodies, "base: free"), Axes::world);
        if (HasFailure()) return;
    }
    for (Handles const handles : {Handles::projected, Handles::full}) {
        expect_same(scene_of(
            of(ring, 700, "base: free, tip: {ring: {type: spherical, translation: [1.5, 0, 0]}}"),
            handles));
        expect_same(scene_of(of(rods, 700, "name: a, count: 3") + ", " +
                                 of("pendulum: {links: ", 600, "name: b, base: fixed"),
                             handles));
    }
}

TEST_F(Gpu, AMillionAndOne) {
    for (char const* const joint : {"link", "spherical", "revolute"})
        expect_same(
            scene_of(std::string("{base: fixed, generator: {random: {bodies: 1000001, joint: ") +
                         joint + ", seed: 1}}}",
                     Handles::projected));
    expect_same(
        scene_of("{base: fixed, generator: {random: {bodies: 300001, joint: revolute, seed: 1}}}",
                 Handles::articulated));
}
/// Of one chain of so many links warps join 32 runs each, and one cluster takes the tree above
/// these, in sweeps of both.
TEST_F(Gpu, GroupsOfOneChain) {
    for (int const bodies : {270001, 524288, 524289, 1048576, 1048577})
        for (char const* const base : {"base: fixed", "base: free"}) {
            std::int64_t const before = cuda::groups_turned, together = cuda::turns_together;
            expect_same_at_once(random_chain_of(bodies, "link", base), Axes::joint);
            bool const by_cluster = bodies <= 1048576 && cuda::knows_clusters();
            EXPECT_EQ(cuda::groups_turned > before, by_cluster);
            EXPECT_EQ(cuda::turns_together > together, !by_cluster && cuda::blocks_at_once() > 0);
            if (HasFailure()) return;
        }
    std::int64_t const before = cuda::groups_turned;
    expect_same_at_once(random_chain_of(300000, "link, rigid: 0.3"), Axes::joint);
    EXPECT_EQ(cuda::groups_turned > before, cuda::knows_clusters());
}
/// For the checkers.
TEST_F(Gpu, GroupsInARow) {
    std::int64_t const before = cuda::groups_turned;
    expect_same_at_once(random_chain_of(270001, "link"), Axes::joint);
    EXPECT_EQ(cuda::groups_turned > before, cuda::knows_clusters());
}

TEST_F(Gpu, ManyChainsAndTips) {
    std::string const of = "generator: {random: {joint: ",
                      tip = ", seed: 3}}, tip: {joint: {type: spherical}}}";
    expect_same(
        scene_of("{name: a, count: 50, generator: {random: {joint: link, bodies: 70, rigid: 0.3, "
                 "seed: 2}}}, "
                 "{name: b, base: fixed, " +
                     of + "spherical, bodies: 40" + tip + ", {name: c, base: fixed, " + of +
                     "mixed, bodies: 50" + tip +
                     ", {name: d, base: fixed, tip: {joint: {type: link, anchor: [1, 2, 3]}}, " +
                     of + "link, bodies: 33, seed: 4}}}",
                 Handles::projected));
}

TEST_F(Gpu, AbsoluteCoordinates) {
    for (Handles const handles : {Handles::projected, Handles::full})
        for (char const* const base : {"free", "fixed"})
            for (char const* const tip : {"", ", tip: {joint: {type: spherical}}"})
                expect_same(
                    scene_of(std::string("{base: ") + base +
                                 ", generator: {random: {bodies: 300, joint: spherical, seed: 1}}" +
                                 tip + "}",
                             handles),
                    Axes::world);
}

TEST_F(Gpu, ManyArticulatedChains) {
    expect_same(scene_of(
        "{name: a, count: 3000, generator: {random: {joint: spherical, bodies: 70, seed: 2}}}, "
        "{name: b, base: fixed, generator: {random: {joint: helical, bodies: 4000, seed: 2}}}",
        Handles::articulated));
}

/// Wrenches on all bodies, joint torques, springs, dampers, drag, prescribed motions, and every
/// joint at the tip.
TEST_F(Gpu, LoadsDrivesAndTips) {
    using enum JointType;
    std::optional<JointType> const tips[] = {std::nullopt, spherical, revolute,    universal, weld,
                                             prismatic,    helical,   cylindrical, planar3};
    std::uint64_t seed = 0;
    for (RandomJoints const joints :
         {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::mixed,
          RandomJoints::universal, RandomJoints::weld, RandomJoints::prismatic,
          RandomJoints::helical, RandomJoints::planar, RandomJoints::any, RandomJoints::cylindrical,
          RandomJoints::planar3, RandomJoints::all})
        for (std::optional<JointType> const tip : tips)
            for (Base const base : {Base::fixed, Base::free}) {
                // Joints that cannot turn, or only in a plane, hold a tip a second time.
                if (tip && base == Base::fixed &&
                    (joints == RandomJoints::prismatic || joints == RandomJoints::planar))
                    continue;
                SCOPED_TRACE("seed " + std::to_string(++seed));
                ChainSpec const chain = random_chain(seed, {.bodies = 40,
                                                            .joints = joints,
                                                            .base = base,
                                                            .springs = true,
                                                            .drag = true,
                                                            .driven = 0.2,
                                                            .tip = tip});
                for (Handles const handles : kinds(!tip)) expect_same(scene_of(chain, handles));
                if (HasFailure()) return;
            }
}

/// Short, for the checkers: joints that move their meeting frames, drives, loads and a tip that
/// slides.
TEST_F(Gpu, SlidingAndDriven) {
    RandomChainOptions options{.bodies = 40,
                               .joints = RandomJoints::all,
                               .base = Base::fixed,
                               .springs = true,
                               .drag = true,
                               .driven = 0.2};
    expect_same(scene_of(random_chain(9, options), Handles::articulated));
    options.tip = JointType::helical;
    expect_same(scene_of(random_chain(9, options), Handles::projected));
}

TEST_F(Gpu, LinksWithTips) {
    for (Base const base : {Base::fixed, Base::free})
        for (Tip const tip : {Tip::free, Tip::jointed}) {
            expect_same(scene_of(random_bead_chain(5, 300, base, tip), Handles::projected));
            expect_same(scene_of(random_linked_chain(5, 300, base, tip), Handles::projected));
        }
}

}  // namespace
}  // namespace catena::test
