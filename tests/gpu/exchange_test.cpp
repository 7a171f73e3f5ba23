// Ranks that have a GPU each write to each other's memory, and what comes out has the bits of exchanges by the host.
#include <cstdlib>

#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "report/solution.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {
namespace {

class GpuExchange : public ::testing::TestWithParam<char const*> {
  protected:
    void SetUp() override {
        need_gpu(world_);
        if (!IsSkipped() && world_.size() == 1) GTEST_SKIP() << "NOT RUN: one rank has nobody to exchange with";
        if (!IsSkipped() && cuda::devices() < world_.size()) GTEST_SKIP() << "NOT RUN: ranks share a GPU";
    }
    void TearDown() override { ::unsetenv("CATENA_GPU_EXCHANGE"); }

    struct Found {
        bool direct;
        std::vector<double> acceleration;
    };
    /// Of a chain on every joint kind that needs another handle, by CATENA_GPU_EXCHANGE.
    Found solve(char const* way, Axes axes) const {
        ::setenv("CATENA_GPU_EXCHANGE", way, 1);
        Scene scene = parse_scene(std::string("units: si\nchains: [{name: a, generator: {random: {bodies: 1003, seed: 5, joint: ") +
                                      GetParam() + "}}}]\nforces: {gravity: [0, 1, -2]}\n",
                                  "scene.yaml");
        scene.solver.backend = Backend::cuda;
        ChainSystem system(scene, axes, world_);
        for (int i = 0; i < 3; ++i) system.evaluate();  // boxes are filled in turns
        return {system.solver_reports().front().direct_exchange, solution_of(system).acceleration};
    }
    Communicator const& world_ = catena::testing::world();
};

TEST_P(GpuExchange, HasTheBitsOfTheHosts) {
    for (Axes const axes : {Axes::joint, Axes::world}) {
        if (axes == Axes::world && std::string(GetParam()) != "link" && std::string(GetParam()) != "spherical") continue;
        Found const direct = solve("direct", axes), host = solve("host", axes);
        EXPECT_TRUE(direct.direct);
        EXPECT_FALSE(host.direct);
        ASSERT_EQ(direct.acceleration.size(), host.acceleration.size());
        EXPECT_EQ(direct.acceleration, host.acceleration);
    }
}
TEST_P(GpuExchange, RefusesAWayThatThereIsNot) { EXPECT_THROW(solve("pigeon", Axes::joint), InputError); }

INSTANTIATE_TEST_SUITE_P(Joints, GpuExchange, ::testing::Values("link", "planar", "spherical", "universal", "revolute", "helical"),
                         [](auto const& joint) { return std::string(joint.param); });

}  // namespace
}  // namespace catena::test
