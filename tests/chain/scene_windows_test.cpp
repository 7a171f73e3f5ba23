// Bodies reach rank 0 in the order of the scene, whoever has them and however large the windows
// are.
#include "chain/scene_windows.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "reader/load_scene.hpp"
#include "run/rank_exchange.hpp"
#include "tests/mpi/world.hpp"

namespace catena::test {
namespace {

TEST(SceneWindows, BringBodiesInTheOrderOfTheScene) {
    Communicator const& world = catena::testing::world();
    std::string text = "units: si\nchains:\n";
    for (int const bodies : {70, 3, 300, 1, 1, 130})
        for (char const* const joint : {"link", "spherical"})
            text += "  - {generator: {random: {bodies: " + std::to_string(bodies) +
                    ", joint: " + joint + ", seed: 5}}}\n";
    Scene const scene = parse_scene(text, "test");
    ChainSystem const system(scene, Axes::joint, world);
    for (int const width : {1, 3})
        for (std::int64_t const length :
             {std::int64_t{1}, std::int64_t{7}, scene.bodies(), 3 * scene.bodies()}) {
            std::vector<std::vector<double>> own;
            for (auto const& group : system.groups()) {
                own.emplace_back();
                for (std::int64_t k = 0; k < group->size; ++k)
                    for (int i = 0; i < width; ++i)
                        own.back().push_back(
                            static_cast<double>(group->scene_index(k) * width + i));
            }
            std::int64_t next = 0;
            SceneWindows const windows(world, system.groups(), 8 * width * length);
            windows.pass(width, own, [&](std::int64_t first, std::span<double const> values) {
                EXPECT_EQ(first * width, next);
                EXPECT_LE(std::ssize(values), width * length);
                for (double const value : values) EXPECT_EQ(value, static_cast<double>(next++));
            });
            EXPECT_EQ(next, world.rank() == 0 ? scene.bodies() * width : 0);
            std::vector<double> whole(
                world.rank() == 0 ? static_cast<std::size_t>(scene.bodies() * width) : 0);
            std::iota(whole.begin(), whole.end(), 0.0);
            EXPECT_EQ(windows.hand_out(width, whole), own);
            std::vector<double> gathered(whole.size());
            windows.gather(width, own, gathered);
            EXPECT_EQ(gathered, whole);
            std::int64_t rounds = 0, bodies = 0, before = -1;
            windows.pass_own(width, own, [&](std::vector<SceneWindows::Own> const& round) {
                ++rounds;
                for (SceneWindows::Own const& run : round) {
                    EXPECT_LT(before, run.first);
                    for (std::size_t i = 0; i < run.values.size(); ++i)
                        EXPECT_EQ(run.values[i],
                                  static_cast<double>(run.first * width) + static_cast<double>(i));
                    bodies += std::ssize(run.values) / width;
                    before = run.first + std::ssize(run.values) / width - 1;
                }
            });
            EXPECT_EQ(world.max(static_cast<double>(rounds)), static_cast<double>(rounds))
                << "some rank has fewer";
            EXPECT_EQ(world.sum(bodies), scene.bodies());
        }
}

/// A restart takes memory for what is a rank's own: arrays of bodies stay where they were read, and
/// each rank is given its part.
TEST(SceneWindows, LongPartsAreGatheredOneByOne) {
    Communicator const& world = catena::testing::world();
    Scene const scene = parse_scene(
        "units: si\nchains:\n  - {generator: {random: {bodies: 70000, joint: link, "
        "seed: 5}}}\n  - {generator: {random: {bodies: 70000, joint: spherical, seed: "
        "5}}}\n",
        "test");
    ChainSystem const system(scene, Axes::joint, world);
    std::vector<std::vector<double>> own;
    for (auto const& group : system.groups()) {
        own.emplace_back();
        for (std::int64_t k = 0; k < group->size; ++k)
            for (int i = 0; i < 6; ++i)
                own.back().push_back(static_cast<double>(group->scene_index(k) * 6 + i));
    }
    std::vector<double> whole(world.rank() == 0 ? static_cast<std::size_t>(scene.bodies() * 6) : 0);
    std::iota(whole.begin(), whole.end(), 0.0);
    std::vector<double> gathered(whole.size());
    SceneWindows(world, system.groups(), 1 << 20).gather(6, own, gathered);
    EXPECT_EQ(gathered, whole);
}

TEST(SceneWindows, TheStateIsSetByWhatTheFirstRankHas) {
    Communicator const& world = catena::testing::world();
    Scene const scene = parse_scene(
        "units: md\nchains: [{generator: {freely_jointed: {beads: 25000, length: 0.38}}}, "
        "{generator: {random: {bodies: 40, joint: revolute, seed: 1}}}]",
        "test");
    ChainSystem system(scene, Axes::joint, world);
    Checkpoint checkpoint;
    checkpoint.arrays = system.state();
    checkpoint.arrays["few"] = {1, 2, 3};
    ASSERT_EQ(checkpoint.arrays["position"].size(),
              world.rank() == 0 ? static_cast<std::size_t>(3 * scene.bodies()) : 0);
    std::map<std::string, std::vector<double>> other = checkpoint.arrays;
    for (auto& [name, array] : other)
        for (double& number : array) number = 0.5 * number + 1;
    if (world.rank() > 0) checkpoint.arrays.clear();
    share(world, checkpoint);
    EXPECT_EQ(checkpoint.arrays["few"], (std::vector<double>{1, 2, 3}));
    EXPECT_EQ(checkpoint.arrays.contains("position"), world.rank() == 0);
    auto const at_first = system.state();
    system.set_state(other);
    EXPECT_EQ(system.state() == at_first, world.rank() > 0);  // the others have empty arrays
    system.set_state(checkpoint.arrays);
    EXPECT_EQ(system.state(), at_first);
    std::map<std::string, std::vector<double>> lacking = checkpoint.arrays;
    lacking.erase("velocity");
    EXPECT_THROW(system.set_state(lacking), InputError);
}

}  // namespace
}  // namespace catena::test
