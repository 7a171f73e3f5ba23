// A step that each chain takes alone leaves the bits of one that all chains take loop after loop.
#include <gtest/gtest.h>

#include "dca/solvers/tree_solver.hpp"
#include "dynamics/absolute_dynamics.hpp"
#include "mpi/communicator.hpp"
#include "reader/load_scene.hpp"
#include "tests/dynamics/same_steps.hpp"
#include "tests/support/pulled.hpp"

namespace catena::test {
namespace {

struct Case {
    char const* name;
    char const* chains;
    Handles handles = Handles::projected;
    bool pairwise = false, pulled = false;
};
char const* const mixture =
    "{base: fixed, generator: {random: {bodies: 70, joint: link, seed: 3}}},"
    "{count: 3, base: free, generator: {freely_jointed: {beads: 23, length: 0.38}}},"
    "{generator: {freely_jointed: {beads: 1, length: 0.38}}},"
    "{base: fixed, tip: {joint: {type: link, anchor: [2, 3, 1]}}, generator: {random: {bodies: 33, "
    "joint: link, seed: 5}}},"
    "{base: free, tip: {joint: {type: link, anchor: [1, 0, 0]}}, generator: {random: {bodies: 16, "
    "joint: link, seed: 6}}}";
Case const cases[] = {{"mixture", mixture},
                      {"full_handles", mixture, Handles::full},
                      {"pairs", mixture, Handles::projected, true},
                      {"pulled", mixture, Handles::projected, false, true}};

class StepByBlocks : public ::testing::TestWithParam<std::tuple<Case, bool, int>> {
  protected:
    void SetUp() override {
        if (threads() > 1 && !openmp_is_built()) GTEST_SKIP() << "NOT RUN: built without OpenMP";
        executor_ = threads() == 1 ? serial_executor() : openmp_executor(threads());
        Case const& c = std::get<0>(GetParam());
        scene_ = parse_scene(
            std::string("chains: [") + c.chains + "]\nforces: {gravity: [0.5, 0, -9.81]}",
            "scene.yaml");
        if (c.pulled) scene_ = pulled(std::move(scene_));
        groups_ = make_groups(scene_, Axes::world, c.handles, c.pairwise, *communicator_);
        alone_ = dynamics();
        together_ = dynamics();
    }
    template <class Leaf>
    bool carries() const {
        auto const* const solver =
            dynamic_cast<dca::TreeSolver<Leaf, HostSpace> const*>(&alone_->solver());
        return solver != nullptr && solver->carries();
    }
    static int threads() { return std::get<2>(GetParam()); }
    std::unique_ptr<AbsoluteDynamics> dynamics() const {
        auto d = make_bead_dynamics(*groups_[0], scene_, *executor_, *communicator_,
                                    make_tree_solver(*groups_[0], *executor_, *communicator_));
        d->update_configuration();
        d->assemble_matrices();
        d->draw_velocities(2.5, 7, std::vector<bool>(scene_.chains.size(), true));
        return d;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
    std::unique_ptr<Executor> executor_;
    Scene scene_;
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    std::unique_ptr<AbsoluteDynamics> alone_, together_;
};

TEST_P(StepByBlocks, LeavesTheSameBits) {
    ASSERT_TRUE(carries<dca::BeadLeaf<1>>() || carries<dca::BeadLeaf<3>>());
    expect_same_steps(*alone_, *together_, std::get<1>(GetParam()), 5);
    SolverReport const a = alone_->solver().report(), t = together_->solver().report();
    EXPECT_EQ(a.matrix_sweeps, t.matrix_sweeps);
    EXPECT_EQ(a.bias_sweeps, t.bias_sweeps);
}

INSTANTIATE_TEST_SUITE_P(Chains, StepByBlocks,
                         ::testing::Combine(::testing::ValuesIn(cases), ::testing::Bool(),
                                            ::testing::Values(1, 2)),
                         [](auto const& each) {
                             return std::string(std::get<0>(each.param).name) +
                                    (std::get<1>(each.param) ? "_langevin" : "_rattle") +
                                    (std::get<2>(each.param) == 1 ? "" : "_threads");
                         });

}  // namespace
}  // namespace catena::test
