// Where pairs are shared out and GPUs write to each other's memory, single precision's positions
// and forces go from array to array. Once a process: memory of another GPU that one CUDA context of
// a process has opened need not open for the next.
#include "cuda/device/gpu.hpp"
#include "neighbours/device_path.hpp"
#include "tests/cuda/openmm_ranks.hpp"

namespace catena::test {
namespace {

class DirectPairs : public OpenMmOnGpus {};

/// A new order after 100 steps; lists of pairs are kept for some steps each.
TEST_P(DirectPairs, AfterManySteps) {
    ASSERT_EQ(cuda::choose_device(world_), "");
    if (!cuda::gpus_may_write_to_each_other(world_))
        GTEST_SKIP() << "NOT RUN: ranks share a GPU, or these do not reach each other's memory";
    Found const direct = found(scene_with("mixed", true, "pairs"), 400);
    EXPECT_TRUE(direct.traffic.direct);
    EXPECT_EQ(direct.traffic.rebuilds, 2);
    EXPECT_EQ(direct.traffic.updates, 401);
    EXPECT_EQ(direct.contexts, GetParam().layers ? 2 : 1);
    EXPECT_GT(direct.lists.kept, (GetParam().layers ? 1 : 2) * direct.lists.made);
    EXPECT_GT(direct.lists.made, 6);
    expect_close(direct, found(scene_with("mixed", false), 400, &direct), tolerance("mixed"));
    ::setenv("CATENA_GPU_EXCHANGE", "host", 1);
    Found const by_host = found(scene_with("mixed", true, "pairs"), 400, &direct);
    EXPECT_FALSE(by_host.traffic.direct);
    expect_close(direct, by_host, tolerance("mixed"));
}

INSTANTIATE_TEST_SUITE_P(
    Scene, DirectPairs,
    ::testing::Values(
        Case{"long_box",
             "{name: a, count: 120, sequence: MKDEGFYRSAKDWLNQHITVCP, model: calvados2, "
             "conformation: self_avoiding, velocities: thermal}",
             "box: {periodic: [90, 13, 12]}", 90},
        Case{"in_layers",
             "{name: a, count: 120, sequence: GKEKSDESKEKSDEKRSKEDKG, model: calvados2, "
             "conformation: self_avoiding, velocities: thermal}",
             "box: {periodic: [90, 13, 12]}", 90, false, 1, true}),
    [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
