// The tree cut between two parts, here both on the host with memory of their own: the same bits
// wherever it is cut, on one rank and several.
#include <gtest/gtest.h>

#include <algorithm>

#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/level_solvers.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

class Levels : public ::testing::Test {
  protected:
    void expect_same(Scene const& scene, Axes axes = Axes::joint, bool many = false) const {
        std::vector<Handles> kinds{Handles::projected, Handles::full};
        if (axes == Axes::joint &&
            std::all_of(scene.chains.begin(), scene.chains.end(), scene::takes_articulated_handles))
            kinds.push_back(Handles::articulated);
        for (Handles const handles : kinds)
            expect_same_bits_at_every_cut(scene, axes, handles, dca::host_levels(*executor_),
                                          testing::world(), many);
    }
    static Scene scene_of(std::string const& chains) {
        return parse_scene("chains: [" + chains + "]\nforces: {gravity: [1, 2, -9.81]}",
                           "scene.yaml");
    }
    static std::string random(std::string const& joint, int bodies, char const* base) {
        return std::string("{base: ") + base +
               ", generator: {random: {bodies: " + std::to_string(bodies) + ", joint: " + joint +
               ", seed: 1}}}";
    }
    /// Ranks that share two cores wait for each other's every message: there, fewer sizes.
    static std::vector<int> sizes(std::vector<int> const& of_one_rank,
                                  std::vector<int> const& of_ranks) {
        return testing::world().size() == 1 ? of_one_rank : of_ranks;
    }
    std::unique_ptr<Executor> executor_ = serial_executor();
};

TEST_F(Levels, EveryKindAndSize) {
    for (char const* const joint :
         {"link", "planar", "spherical", "universal", "revolute", "prismatic", "helical",
          "cylindrical", "planar3", "weld", "mixed"})
        for (int const bodies : sizes({1, 2, 3, 31, 32, 33, 255, 257}, {3, 32, 257})) {
            SCOPED_TRACE(std::string(joint) + " " + std::to_string(bodies));
            expect_same(scene_of(random(joint, bodies, bodies % 2 ? "free" : "fixed")));
            if (HasFailure()) return;
        }
}

TEST_F(Levels, ElevenLevels) {
    for (int const bodies : sizes({2047, 2048, 2049}, {2049}))
        expect_same(scene_of(random("revolute", bodies, "fixed")));
}

TEST_F(Levels, EveryPairOfLevels) {
    expect_same(scene_of(random("mixed", 37, "fixed")), Axes::joint, true);
    expect_same(scene_of(random("link", 300, "free")), Axes::joint, true);
}

TEST_F(Levels, ManyChainsAndTips) {
    std::string const of = "generator: {random: {joint: ",
                      tip = ", seed: 3}}, tip: {joint: {type: spherical}}}";
    expect_same(
        scene_of("{name: a, count: 5, generator: {random: {joint: link, bodies: 70, rigid: 0.3, "
                 "seed: 2}}}, {name: b, base: fixed, " +
                 of + "spherical, bodies: 40" + tip + ", {name: c, base: fixed, " + of +
                 "mixed, bodies: 130" + tip +
                 ", {name: d, base: fixed, tip: {joint: {type: link, anchor: [1, 2, 3]}}, " + of +
                 "link, bodies: 33, seed: 4}}}"));
}

TEST_F(Levels, AbsoluteCoordinates) {
    for (char const* const base : {"free", "fixed"})
        for (char const* const tip : {"", ", tip: {joint: {type: spherical}}"})
            expect_same(scene_of(std::string("{base: ") + base +
                                 ", generator: {random: {bodies: 300, joint: spherical, seed: 1}}" +
                                 tip + "}"),
                        Axes::world);
}

/// Springs, drag, drives and tips; where base and tip hold a chain twice, the same refusal.
TEST_F(Levels, LoadsDrivesTipsAndRefusals) {
    using enum JointType;
    std::uint64_t seed = 0;
    for (RandomJoints const joints : {RandomJoints::revolute, RandomJoints::prismatic,
                                      RandomJoints::planar, RandomJoints::any, RandomJoints::all})
        for (JointType const tip : {spherical, revolute, weld, helical}) {
            SCOPED_TRACE("seed " + std::to_string(++seed));
            Scene scene;
            scene.chains = {random_chain(seed, {.bodies = 40,
                                                .joints = joints,
                                                .base = Base::fixed,
                                                .springs = true,
                                                .drag = true,
                                                .driven = 0.2,
                                                .tip = tip})};
            scene.chains[0].name = "chain";
            scene.forces.gravity = {{1, 2, -9.81}};
            expect_same(scene);
            if (HasFailure()) return;
        }
}

TEST_F(Levels, NumbersOfLevels) {
    auto const levels = [](std::string const& text) {
        SolverSpec solver;
        solver.gpu_levels = text;
        return solver.levels_on_gpu();
    };
    for (char const* const text : {"auto", "all"}) {
        EXPECT_EQ(levels(text).up, GpuLevels::all);
        EXPECT_EQ(levels(text).down, GpuLevels::all);
    }
    EXPECT_EQ(levels("3").up, 3);
    EXPECT_EQ(levels("3").down, 3);
    EXPECT_EQ(levels("4,all").up, 4);
    EXPECT_EQ(levels("4,all").down, GpuLevels::all);
    EXPECT_EQ(levels("4,0").down, 0);
}

/// What crosses between 8 bodies' lowest two levels and the third: two segments up, the forces at
/// the segments' ends down.
TEST_F(Levels, OnlyTheCutCrosses) {
    dca::Partition const partition({8}, true, 1);
    dca::Schedule const s = dca::make_schedule(partition, 0);
    dca::LevelCut const even = dca::cut_levels(s, {2, 2});
    EXPECT_EQ(even.segments.size(), 2U);
    EXPECT_EQ(even.forces, (std::vector<std::int64_t>{0, 4}));
    EXPECT_TRUE(even.joints_up.empty() && even.joints_down.empty());
    EXPECT_EQ(dca::cut_levels(s, {2, 1}).joints_up.size(), 2U);
    EXPECT_EQ(dca::cut_levels(s, {1, 3}).joints_down, (std::vector<std::int64_t>{2, 6, 4}));
    EXPECT_EQ(dca::cut_levels(s, {GpuLevels::all, GpuLevels::all}).segments.size(), 1U);
    EXPECT_TRUE(dca::cut_levels(s, {0, 0}).segments.empty() &&
                dca::cut_levels(s, {0, 0}).forces.empty());
}

}  // namespace
}  // namespace catena::test
