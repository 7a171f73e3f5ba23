// The tree cut between GPU and host leaves the bits of `serial`, wherever it is cut.
#include <gtest/gtest.h>

#include <algorithm>

#include "integrate/chain_system.hpp"
#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "tests/support/gpu.hpp"
#include "tests/support/level_solvers.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

class GpuLevels : public ::testing::Test {
  protected:
    void SetUp() override {
        need_gpu();
        if (IsSkipped() || HasFatalFailure()) return;
        ASSERT_EQ(cuda::choose_device(*communicator_), "");
    }
    void expect_same(Scene const& scene, Axes axes = Axes::joint) const {
        std::vector<Handles> kinds{Handles::projected, Handles::full};
        if (axes == Axes::joint &&
            std::all_of(scene.chains.begin(), scene.chains.end(), scene::takes_articulated_handles))
            kinds.push_back(Handles::articulated);
        for (Handles const handles : kinds)
            expect_same_bits_at_every_cut(scene, axes, handles, cuda::make_levels, *communicator_);
    }
    static Scene scene_of(std::string const& chains) {
        return parse_scene("chains: [" + chains + "]\nforces: {gravity: [1, 2, -9.81]}",
                           "scene.yaml");
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
};

TEST_F(GpuLevels, EveryKindAndSize) {
    for (char const* const joint :
         {"link", "planar", "spherical", "universal", "revolute", "prismatic", "helical",
          "cylindrical", "planar3", "weld", "mixed"})
        for (int const bodies : {1, 2, 3, 31, 32, 33, 255, 256, 257, 2047, 2048, 2049}) {
            SCOPED_TRACE(std::string(joint) + " " + std::to_string(bodies));
            expect_same(scene_of(std::string("{base: ") + (bodies % 2 ? "free" : "fixed") +
                                 ", generator: {random: {bodies: " + std::to_string(bodies) +
                                 ", joint: " + joint + ", seed: 1}}}"));
            if (HasFailure()) return;
        }
}

TEST_F(GpuLevels, ManyChainsAndTips) {
    std::string const of = "generator: {random: {joint: ",
                      tip = ", seed: 3}}, tip: {joint: {type: spherical}}}";
    expect_same(
        scene_of("{name: a, count: 5, generator: {random: {joint: link, bodies: 70, rigid: 0.3, "
                 "seed: 2}}}, {name: b, base: fixed, " +
                 of + "spherical, bodies: 40" + tip + ", {name: c, base: fixed, " + of +
                 "mixed, bodies: 130" + tip +
                 ", {name: d, base: fixed, tip: {joint: {type: link, anchor: [1, 2, 3]}}, " + of +
                 "link, bodies: 33, seed: 4}}}"));
}

TEST_F(GpuLevels, AbsoluteCoordinates) {
    for (char const* const base : {"free", "fixed"})
        expect_same(scene_of(std::string("{base: ") + base +
                             ", generator: {random: {bodies: 300, joint: spherical, seed: 1}}}"),
                    Axes::world);
}

/// Springs, drag, drives and tips; where base and tip hold a chain twice, the same refusal.
TEST_F(GpuLevels, LoadsDrivesTipsAndRefusals) {
    using enum JointType;
    std::uint64_t seed = 0;
    for (RandomJoints const joints :
         {RandomJoints::revolute, RandomJoints::prismatic, RandomJoints::planar, RandomJoints::any})
        for (JointType const tip : {spherical, revolute, weld, helical}) {
            SCOPED_TRACE("seed " + std::to_string(++seed));
            Scene scene;
            scene.chains = {random_chain(seed, {.bodies = 40,
                                                .joints = joints,
                                                .base = Base::fixed,
                                                .springs = true,
                                                .drag = true,
                                                .driven = 0.2,
                                                .tip = tip})};
            scene.chains[0].name = "chain";
            scene.forces.gravity = {{1, 2, -9.81}};
            expect_same(scene);
            if (HasFailure()) return;
        }
}

/// Through the scene's own keys, with the clocks of both parts and of what crosses.
TEST_F(GpuLevels, TheBackendSaysWhereItsTimeWent) {
    Scene scene =
        scene_of("{base: fixed, generator: {random: {bodies: 1000, joint: revolute, seed: 1}}}");
    scene.solver.backend = Backend::cuda_levels;
    for (char const* const levels : {"auto", "0", "3", "4,2", "0,all"}) {
        scene.solver.gpu_levels = levels;
        ChainSystem system(scene, Axes::joint, *communicator_);
        system.evaluate();
        EXPECT_LE(system.residual(), system.residual_bound());
        SolverReport const report = system.solver_reports().at(0);
        EXPECT_EQ(report.run_length, 1);
        SplitSeconds const& s = report.split;
        double const parts = s.lower_assembly + s.upper_assembly + s.lower_disassembly +
                             s.upper_disassembly + s.upload + s.download;
        EXPECT_GT(parts, 0);
        EXPECT_LE(parts, report.matrix_seconds + report.bias_seconds);
    }
}

}  // namespace
}  // namespace catena::test
