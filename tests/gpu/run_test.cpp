// Whole runs on the GPU, on one rank and on several that share it, end in the bits of the host's.
#include "tests/integrate/whole_run.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {
namespace {

class GpuRun : public WholeRun {
  protected:
    void SetUp() override { need_gpu(catena::testing::world()); }
};

TEST_P(GpuRun, EndsInTheBitsOfTheHost) {
    Communicator const& world = catena::testing::world();
    run(world, "all", 40, "", Backend::cuda);
    run(world, "restarted", 20, "", Backend::cuda);
    run(world, "restarted", 40, "restarted/checkpoint.h5", Backend::cuda);
    if (world.rank() != 0) return;
    run(*serial_communicator(), "host", 40, "", Backend::segments);
    ASSERT_FALSE(arrays("host").empty());
    EXPECT_EQ(arrays("all"), arrays("host"));
    EXPECT_EQ(arrays("restarted"), arrays("host"));
}

auto const name_of_scene = [](auto const& scene) { return scene.param.name; };
INSTANTIATE_TEST_SUITE_P(Integrators, GpuRun, ::testing::ValuesIn(run_scenes), name_of_scene);

/// A long chain that ranks share, and so many short ones that the last rank holds one unit of it: levels of its tree are empty there.
RunScene long_and_short(char const* name, int beads, int beads_of_short) {
    auto const chain = [](std::string const& head, int n) {
        return "{" + head + ", base: free, velocities: thermal, generator: {freely_jointed: {beads: " + std::to_string(n) +
               ", length: 0.38}}}";
    };
    return {name, "chains: [" + chain("name: a", beads) + ", " + chain("name: b, count: 500", beads_of_short) +
                      "]\ndynamics: {integrator: rattle, step: 0.002, steps: 20, temperature: 300, seed: 5}\noutput: {every: 20}\n"};
}
INSTANTIATE_TEST_SUITE_P(CutChains, GpuRun,
                         ::testing::Values(long_and_short("runs_of_32", 4128, 8), long_and_short("more_levels", 8224, 16)), name_of_scene);

}  // namespace
}  // namespace catena::test
