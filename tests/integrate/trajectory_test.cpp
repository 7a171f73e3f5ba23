// The same run on all ranks together and on rank 0 alone ends in the same bits, and can be restarted on either.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "integrate/simulation.hpp"
#include "io/output.hpp"
#include "tests/integrate/scenes.hpp"
#include "tests/mpi/world.hpp"

namespace catena::test {
namespace {

class Trajectory : public ::testing::TestWithParam<RunScene> {
  protected:
    Trajectory() {
        // Every rank must name the same folder: rank 0's.
        std::string name = (std::filesystem::temp_directory_path() / ("catena-trajectory-" + std::to_string(::getpid()))).string();
        name.resize(200, ' ');
        catena::testing::world().broadcast(std::as_writable_bytes(std::span(name)));
        folder_ = name.substr(0, name.find(' '));
    }
    ~Trajectory() override {
        catena::testing::world().barrier();
        std::error_code ignored;
        if (catena::testing::world().rank() == 0) std::filesystem::remove_all(folder_, ignored);
        catena::testing::world().barrier();
    }
    void run(Communicator const& communicator, std::string const& name, std::int64_t steps, std::string const& restart = "") {
        RunOptions options;
        options.output = folder_ + "/" + name;
        options.steps = steps;
        options.restart = restart.empty() ? "" : folder_ + "/" + restart;
        options.quiet = true;
        nlohmann::json const summary = run_simulation(parse_scene(GetParam().text, "scene.yaml"), communicator, options);
        EXPECT_TRUE(summary["valid"].get<bool>());
    }
    std::string folder_;
};

TEST_P(Trajectory, IsTheSameOnOneRankAndOnAll) {
    Communicator const& world = catena::testing::world();
    run(world, "all", 40);
    run(world, "half", 20);
    if (world.rank() == 0) {
        auto const one = serial_communicator();
        run(*one, "one", 40);
        run(*one, "half-then-one", 40, "half/checkpoint.h5");
        auto const expected = read_checkpoint(folder_ + "/one/checkpoint.h5").arrays;
        ASSERT_FALSE(expected.empty());
        EXPECT_EQ(read_checkpoint(folder_ + "/all/checkpoint.h5").arrays, expected);
        EXPECT_EQ(read_checkpoint(folder_ + "/half-then-one/checkpoint.h5").arrays, expected);
    }
    world.barrier();
    run(world, "one-then-all", 40, "half/checkpoint.h5");
    run(world, "half", 40, "half/checkpoint.h5");  // goes on in its own folder
    if (world.rank() != 0) return;
    for (char const* const name : {"one-then-all", "half"})
        EXPECT_EQ(read_checkpoint(folder_ + "/" + name + "/checkpoint.h5").arrays, read_checkpoint(folder_ + "/one/checkpoint.h5").arrays)
            << name;
}

INSTANTIATE_TEST_SUITE_P(Integrators, Trajectory, ::testing::ValuesIn(run_scenes), [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
