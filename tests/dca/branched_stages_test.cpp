// The GPU's sweeps over the phases of branched chains, run on the host, leave the bits of the
// host's loops, whatever the blocks' sizes.
#include <gtest/gtest.h>

#include "dca/solvers/branched_solver.hpp"
#include "mpi/communicator.hpp"
#include "reader/load_scene.hpp"
#include "tests/support/stage_space.hpp"

namespace catena::test {
namespace {

using Vectors = std::vector<double>;

/// Accelerations and joint forces of one evaluation with directions, forces and biases that depend
/// on the bead alone.
template <class Solver>
std::pair<Vectors, Vectors> solved(Solver& solver, ChainGroup const& group) {
    Field<3> direction(group.link_entries()), force(group.size), acceleration(group.size);
    for (std::int64_t k = 0; k < group.size; ++k) {
        double const x = 0.7 * static_cast<double>(k);
        if (is_rod(group.joints.type[k]))
            direction.set(k, Vec3{{std::cos(x), std::sin(x) * std::cos(2 * x),
                                   std::sin(x) * std::sin(2 * x)}});
        force.set(k, Vec3{{std::sin(3 * x), 1 - x, std::cos(5 * x)}});
    }
    DirectionsField bias(group.link_entries() + 1, 1), joint_force(group.link_entries() + 1, 1);
    ConfigurationView configuration;
    configuration.direction = direction.view();
    solver.assemble_matrices(configuration);
    solver.solve({{}, force.view(), {}, bias.view(), {}},
                 {{}, acceleration.view(), joint_force.view(), {}});
    solver.check();
    std::pair<Vectors, Vectors> found;
    for (std::int64_t k = 0; k < group.size; ++k) {
        for (int c = 0; c < 3; ++c) found.first.push_back(acceleration[k][c]);
        found.second.push_back(joint_force.view().template load<1>(k)[0]);
    }
    return found;
}

class BranchedStages : public ::testing::TestWithParam<char const*> {};
INSTANTIATE_TEST_SUITE_P(
    Chains, BranchedStages,
    ::testing::Values(
        "{generator: {dendrimer: {generations: 7, length: 0.4}}}",
        "{base: fixed, generator: {dendrimer: {generations: 5, spacer: 3, length: 0.4}}}",
        "{generator: {random_tree: {beads: 700, seed: 3, length: 0.4}}}",
        "{count: 2, generator: {random_tree: {beads: 60, seed: 5, length: 0.4}}}, {generator: "
        "{brush: {backbone: 80, side_length: 3, length: 0.4}}}, {generator: {star: {arms: 5, "
        "arm_length: 40, length: 0.4}}}"));

TEST_P(BranchedStages, LeaveTheBitsOfTheHost) {
    auto const alone = serial_communicator();
    auto const executor = serial_executor(SimdLevel::off);
    Scene const scene = parse_scene(std::string("chains: [") + GetParam() + "]", "scene.yaml");
    auto const groups = make_groups(scene, Axes::world, Handles::projected, false, *alone);
    ASSERT_EQ(groups.size(), 1u);
    ASSERT_GT(groups[0]->branching.paths.phases(), 1);
    dca::BranchedSolver<HostSpace> host(*groups[0], HostSpace(*executor), *alone);
    auto const expected = solved(host, *groups[0]);
    for (StagedGpu const& gpu :
         {StagedGpu{{64, 4, 3}, true}, StagedGpu{{32, 2, 0}, false}, StagedGpu{{128, 8, 8}, false},
          StagedGpu{{256, 16, 8}, true},
          StagedGpu{dca::stage_sizes(dca::stage_records(1, true), cuda_on_host::most_shared_bytes,
                                     132)}}) {
        StageSpace::gpu = gpu;
        StageSpace::ranks = nullptr;
        dca::BranchedSolver<StageSpace> staged(*groups[0], StageSpace(*executor), *alone);
        auto const found = solved(staged, *groups[0]);
        SCOPED_TRACE(gpu.sizes.most);
        EXPECT_EQ(found.first, expected.first);
        EXPECT_EQ(found.second, expected.second);
    }
}

}  // namespace
}  // namespace catena::test
