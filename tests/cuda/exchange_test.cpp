// Ranks that have a GPU each write to each other's memory, and what comes out has the bits of
// exchanges by the host.
#include <cstdlib>

#include "cuda/device/clusters.hpp"
#include "error.hpp"
#include "integrate/chain_system.hpp"
#include "measure/solution.hpp"
#include "reader/load_scene.hpp"
#include "tests/mpi/world.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {
namespace {

/// Chains of one kind each, which all ranks share.
Scene scene_of(std::vector<std::string> const& joints, int bodies) {
    std::string chains;
    for (std::string const& joint : joints)
        chains += (chains.empty() ? "{name: a" : ", {name: b") + std::to_string(chains.size()) +
                  ", generator: {random: {bodies: " + std::to_string(bodies) +
                  ", seed: 5, joint: " + joint + "}}}";
    Scene scene = parse_scene(
        "units: si\nchains: [" + chains + "]\nforces: {gravity: [0, 1, -2]}\n", "scene.yaml");
    scene.solver.backend = Backend::cuda;
    return scene;
}
void ask(char const* way) { ::setenv("CATENA_GPU_EXCHANGE", way, 1); }
bool is_direct(ChainSystem const& system) {
    return system.solver_reports().front().direct_exchange;
}

/// Places to be filled come round every second time: what is there from before must not be taken
/// for what is to come. `sweeps`, `scans`: whether each chain's go up and down in one launch with
/// what ranks show each other. Matrices and biases go one after the other, then as often all at
/// once.
void expect_the_bits_of_the_hosts(Scene const& scene, bool sweeps, bool scans) {
    constexpr int times = 4;
    Communicator const& world = catena::testing::world();
    ask("direct");
    ChainSystem direct(scene, Axes::joint, world);
    ask("host");
    ChainSystem host(scene, Axes::joint, world);
    EXPECT_FALSE(is_direct(host));
    if (!is_direct(direct))
        GTEST_SKIP() << "NOT RUN: ranks do not have a GPU each that reaches the others'";
    std::int64_t const turns = cuda::turns_shared, turns_of_scans = cuda::scans_shared;
    int const chains_alike = static_cast<int>(scene.chains.size());
    std::vector<double> last;
    for (int i = 0; i < 2 * times; ++i) {
        for (ChainSystem* const system : {&direct, &host}) {
            for (auto const& chains : system->joint())
                chains->apply({JointOperator::drift_saved}, 0.01);
            system->evaluate(i < times);
        }
        std::vector<double> const found = solution_of(direct).acceleration;
        EXPECT_EQ(found, solution_of(host).acceleration);
        EXPECT_TRUE(direct.joint().empty() || world.rank() != 0 ||
                    found != last);  // rank 0 has them
        last = found;
    }
    if (sweeps) {
        EXPECT_GE(cuda::turns_shared, turns + 2 * times * chains_alike);
    }
    if (scans) {
        EXPECT_GE(cuda::scans_shared, turns_of_scans + 2 * times);
    }
}

class GpuExchange : public ::testing::TestWithParam<char const*> {
  protected:
    void SetUp() override { need_gpu(world_); }
    void TearDown() override { ::unsetenv("CATENA_GPU_EXCHANGE"); }

    Communicator const& world_ = catena::testing::world();
    Scene const scene_ = scene_of({GetParam()}, 1003);
};

TEST_P(GpuExchange, HasTheBitsOfTheHosts) {
    expect_the_bits_of_the_hosts(scene_, false, GetParam() != std::string("link"));
}
/// Several blocks below the one that speaks to other ranks.
TEST_P(GpuExchange, OfLongChains) {
    expect_the_bits_of_the_hosts(scene_of({GetParam()}, 50021), true, false);
}
/// Two groups' launches do not stand in each other's way, which other GPUs wait for.
TEST_P(GpuExchange, OfTwoKinds) {
    std::string const other = GetParam() == std::string("link") ? "spherical" : GetParam();
    expect_the_bits_of_the_hosts(scene_of({"link", other}, 50021), true, false);
}
/// A sweep of matrices, and one of biases.
TEST_P(GpuExchange, InSweepsApart) {
    for (Handles const handles : {Handles::projected, Handles::full, Handles::articulated}) {
        if (handles == Handles::articulated && GetParam() == std::string("link")) continue;
        Scene scene = scene_of({GetParam()}, 50021);
        scene.solver.handles = handles;
        ask("direct");
        ChainSystem direct(scene, Axes::joint, world_);
        ask("host");
        ChainSystem host(scene, Axes::joint, world_);
        if (!is_direct(direct))
            GTEST_SKIP() << "NOT RUN: ranks do not have a GPU each that reaches the others'";
        for (int i = 0; i < 3; ++i) {
            for (ChainSystem* const system : {&direct, &host})
                for (auto const& chains : system->joint()) {
                    chains->update_configuration();
                    chains->assemble_matrices();
                    chains->solve();
                    chains->set_rates();
                }
            EXPECT_EQ(solution_of(direct).acceleration, solution_of(host).acceleration);
        }
        EXPECT_LE(direct.residual(), direct.residual_bound());
    }
}
/// In absolute coordinates; as one graph, on every rank.
class GpuExchangeInGraphs : public GpuExchange {};
TEST_P(GpuExchangeInGraphs, GoesOnWithoutTheHost) {
    ChainSystem system(scene_, Axes::world, world_);
    if (!is_direct(system))
        GTEST_SKIP() << "NOT RUN: ranks do not have a GPU each that reaches the others'";
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
INSTANTIATE_TEST_SUITE_P(Joints, GpuExchange,
                         ::testing::Values("link", "planar", "spherical", "universal", "revolute",
                                           "helical", "planar3"),
                         name_of_joint);
INSTANTIATE_TEST_SUITE_P(Joints, GpuExchangeInGraphs, ::testing::Values("link", "spherical"),
                         name_of_joint);

}  // namespace
}  // namespace catena::test
