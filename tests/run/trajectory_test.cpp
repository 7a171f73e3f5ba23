// The same run on all ranks together and on rank 0 alone ends in the same bits, and can be
// restarted on either, by another backend too.
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include "error.hpp"
#include "math/executor.hpp"
#include "reader/load_scene.hpp"
#include "tests/io/dataset_bits.hpp"
#include "tests/run/no_more_threads.hpp"
#include "tests/run/whole_run.hpp"

namespace catena::test {
namespace {

std::string text_of(std::string const& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

using Trajectory = WholeRun;

TEST_P(Trajectory, IsTheSameOnOneRankAndOnAll) {
    Communicator const& world = catena::testing::world();
    nlohmann::json const summary = run(world, "all", 40);
    run(world, "half", 20);
    if (world.rank() == 0) {
        std::string const collective = "collective";
        if (char const* const wish = std::getenv("CATENA_HDF5");
            wish != nullptr && wish == collective && world.size() > 1) {
            for (char const* const what : {"frames_written", "checkpoints_written"})
                EXPECT_TRUE(
                    summary.at("parallel").at(what).get<std::string>().starts_with(collective))
                    << summary.at("parallel");
        }
        auto const one = serial_communicator();
        run(*one, "one", 40);
        run(*one, "half-then-one", 40, "half/checkpoint.h5");
        run(*one, "half-of-one", 20, "", Backend::segments);
        auto const expected = arrays("one");
        ASSERT_FALSE(expected.empty());
        EXPECT_EQ(arrays("all"), expected);
        EXPECT_EQ(arrays("half-then-one"), expected);
    }
    world.barrier();
    run(world, "one-then-all", 40, "half-of-one/checkpoint.h5",
        openmp_is_built() ? Backend::openmp : Backend::automatic);
    run(world, "half", 40, "half/checkpoint.h5");  // goes on in its own folder
    if (world.rank() != 0) return;
    for (char const* const name : {"one-then-all", "half"})
        EXPECT_EQ(arrays(name), arrays("one")) << name;
}

/// Thin, tilted bodies between thick ones, whose solutions lose digits: refined or not, bits
/// differ, and positions only by those digits.
RunScene const refined{"refined",
                       "units: si\nforces: {gravity: [0, -3, -5]}\n"
                       "chains: [{base: fixed, generator: {random: {bodies: 70, joint: revolute, "
                       "seed: 3, inertia: {log_uniform: [1e-6, 1e-1]}}}}]\n"
                       "dynamics: {integrator: velocity-verlet, step: 0.0001, steps: 20}\noutput: "
                       "{every: 5, checkpoint_every: 10}\n"
                       "solver: {refine: 2}\n"};

using FramesOfRanks = WholeRun;

TEST_P(FramesOfRanks, AreTheSameBesideTheStepsAndBetweenThem) {
    if (std::getenv("CATENA_HDF5") != nullptr) GTEST_SKIP() << "all ranks write";
    Communicator const& world = catena::testing::world();
    Scene const scene = parse_scene(GetParam().text, "scene.yaml");
    nlohmann::json beside;
    for (bool const is_beside : {false, true}) {
        RunOptions options = options_of(is_beside ? "beside" : "between", 40, "");
        if (is_beside) options.bodies_beside = 1;
        nlohmann::json const summary = run_simulation(scene, world, options);
        if (is_beside) beside = summary;
    }
    if (world.rank() != 0) return;
    EXPECT_GT(beside.at("parallel").at("frames_beside_steps"), 0);
    EXPECT_EQ(beside.at("seconds_per_phase").contains("gathering frames"), world.size() > 1);
    EXPECT_EQ(bits_of(folder_ + "/beside/trajectory.h5md"),
              bits_of(folder_ + "/between/trajectory.h5md"));
    for (char const* const name : {"observables.csv", "topology.pdb"})
        EXPECT_EQ(text_of(folder_ + "/beside/" + name), text_of(folder_ + "/between/" + name))
            << name;
}

TEST_P(FramesOfRanks, ThatCannotBeWrittenEndAllRanks) {
    if (std::getenv("CATENA_HDF5") != nullptr) GTEST_SKIP() << "all ranks write";
    Communicator const& world = catena::testing::world();
    Scene const scene = parse_scene(GetParam().text, "scene.yaml");
    RunOptions options = options_of("limited", 40000, "");
    options.bodies_beside = 1;
    // Without threads rank 0 writes the frames itself, which the other ranks do not know.
    std::optional<NoMoreThreads> none;
    if (world.rank() == 0 && GetParam().name == run_scenes[0].name) none.emplace();
    rlimit before{};
    if (world.rank() == 0) {
        ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
        rlimit small = before;
        small.rlim_cur = 2'000'000;
        signal(SIGXFSZ, SIG_IGN);
        ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    }
    try {
        run_simulation(scene, world, options);
        ADD_FAILURE() << "rank " << world.rank();
    } catch (ComputationError const& error) {
        EXPECT_NE(std::string(error.what()).find("File too large"), std::string::npos)
            << error.what();
    }
    if (world.rank() == 0) {
        EXPECT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
        // What was flushed stays whole, and a restart goes on with it.
        EXPECT_FALSE(bits_of(folder_ + "/limited/trajectory.h5md").empty());
    }
    std::int64_t const at =
        world.rank() == 0 ? read_checkpoint(folder_ + "/limited/checkpoint.h5").step : 0;
    std::int64_t const further = world.sum(at) + 10;
    EXPECT_NO_THROW(run(world, "limited", further, "limited/checkpoint.h5"));
}

using Refined = WholeRun;

TEST_P(Refined, HasAnEffectOnARun) {
    Communicator const& world = catena::testing::world();
    run(world, "refined", 20);
    RunOptions options;
    options.output = folder_ + "/plain";
    options.quiet = true;
    run_simulation(parse_scene(GetParam().text, "scene.yaml", {"solver.refine=0"}), world, options);
    if (world.rank() != 0) return;
    auto const with = arrays("refined").at("qd"), without = arrays("plain").at("qd");
    EXPECT_NE(with, without);
    for (std::size_t i = 0; i < with.size(); ++i)
        EXPECT_NEAR(with[i], without[i], 1e-6 * (1 + std::abs(without[i])));
}

INSTANTIATE_TEST_SUITE_P(Frames, FramesOfRanks,
                         ::testing::Values(run_scenes[0], run_scenes[1], refined),
                         [](auto const& scene) { return scene.param.name; });
INSTANTIATE_TEST_SUITE_P(Solver, Refined, ::testing::Values(refined),
                         [](auto const& scene) { return scene.param.name; });
INSTANTIATE_TEST_SUITE_P(Solver, Trajectory, ::testing::Values(refined),
                         [](auto const& scene) { return scene.param.name; });
INSTANTIATE_TEST_SUITE_P(Integrators, Trajectory, ::testing::ValuesIn(run_scenes),
                         [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
