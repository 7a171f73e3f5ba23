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

INSTANTIATE_TEST_SUITE_P(Integrators, GpuRun, ::testing::ValuesIn(run_scenes), [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
