// The same run on all ranks together and on rank 0 alone ends in the same bits, and can be restarted on either.
#include "tests/integrate/whole_run.hpp"

namespace catena::test {
namespace {

using Trajectory = WholeRun;

TEST_P(Trajectory, IsTheSameOnOneRankAndOnAll) {
    Communicator const& world = catena::testing::world();
    run(world, "all", 40);
    run(world, "half", 20);
    if (world.rank() == 0) {
        auto const one = serial_communicator();
        run(*one, "one", 40);
        run(*one, "half-then-one", 40, "half/checkpoint.h5");
        auto const expected = arrays("one");
        ASSERT_FALSE(expected.empty());
        EXPECT_EQ(arrays("all"), expected);
        EXPECT_EQ(arrays("half-then-one"), expected);
    }
    world.barrier();
    run(world, "one-then-all", 40, "half/checkpoint.h5");
    run(world, "half", 40, "half/checkpoint.h5");  // goes on in its own folder
    if (world.rank() != 0) return;
    for (char const* const name : {"one-then-all", "half"}) EXPECT_EQ(arrays(name), arrays("one")) << name;
}

INSTANTIATE_TEST_SUITE_P(Integrators, Trajectory, ::testing::ValuesIn(run_scenes), [](auto const& scene) { return scene.param.name; });

}  // namespace
}  // namespace catena::test
