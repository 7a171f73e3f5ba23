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
    void SetUp() override { need_gpu(world_); }
    void TearDown() override { ::unsetenv("CATENA_GPU_EXCHANGE"); }

    static Scene scene_of(std::string const& joint) {
        Scene scene = parse_scene("units: si\nchains: [{name: a, generator: {random: {bodies: 1003, seed: 5, joint: " + joint +
                                      "}}}]\nforces: {gravity: [0, 1, -2]}\n",
                                  "scene.yaml");
        scene.solver.backend = Backend::cuda;
        return scene;
    }
    static void ask(char const* way) { ::setenv("CATENA_GPU_EXCHANGE", way, 1); }
    static bool is_direct(ChainSystem const& system) { return system.solver_reports().front().direct_exchange; }
    Communicator const& world_ = catena::testing::world();
    Scene const scene_ = scene_of(GetParam());
};

/// Places to be filled come round every second time: what is there from before must not be taken for what is to come.
TEST_P(GpuExchange, HasTheBitsOfTheHosts) {
    ask("direct");
    ChainSystem direct(scene_, Axes::joint, world_);
    ask("host");
    ChainSystem host(scene_, Axes::joint, world_);
    EXPECT_FALSE(is_direct(host));
    if (!is_direct(direct)) GTEST_SKIP() << "NOT RUN: ranks do not have a GPU each that reaches the others'";
    std::vector<double> last;
    for (int i = 0; i < 5; ++i) {
        for (ChainSystem* const system : {&direct, &host}) {
            for (auto const& chains : system->joint()) chains->verlet_move(0.01);
            system->evaluate();
        }
        std::vector<double> const found = solution_of(direct).acceleration;
        EXPECT_EQ(found, solution_of(host).acceleration);
        EXPECT_TRUE(direct.joint().empty() || world_.rank() != 0 || found != last);  // rank 0 has them
        last = found;
    }
}
/// In absolute coordinates; as one graph, on every rank.
class GpuExchangeInGraphs : public GpuExchange {};
TEST_P(GpuExchangeInGraphs, GoesOnWithoutTheHost) {
    ChainSystem system(scene_, Axes::world, world_);
    if (!is_direct(system)) GTEST_SKIP() << "NOT RUN: ranks do not have a GPU each that reaches the others'";
    system.evaluate();
    system.evaluate(false);
    std::vector<double> const before = solution_of(system).acceleration;
    EXPECT_EQ(system.absolute().front()->time_at_once(7, 3).size(), 3U);
    EXPECT_EQ(solution_of(system).acceleration, before);
    EXPECT_LE(system.residual(), system.residual_bound());
}
TEST_P(GpuExchange, RefusesAWayThatThereIsNot) {
    ask("pigeon");
    EXPECT_THROW(ChainSystem(scene_, Axes::joint, world_), InputError);
}

auto const name_of_joint = [](auto const& joint) { return std::string(joint.param); };
INSTANTIATE_TEST_SUITE_P(Joints, GpuExchange, ::testing::Values("link", "planar", "spherical", "universal", "revolute", "helical"),
                         name_of_joint);
INSTANTIATE_TEST_SUITE_P(Joints, GpuExchangeInGraphs, ::testing::Values("link", "spherical"), name_of_joint);

}  // namespace
}  // namespace catena::test
