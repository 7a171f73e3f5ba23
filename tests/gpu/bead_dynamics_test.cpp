// Chains of beads whose state stays on the GPU: each operation of a step leaves the bits of the host's.
#include <gtest/gtest.h>

#include "cuda/bead_dynamics.hpp"
#include "integrate/absolute_dynamics.hpp"
#include "tests/support/gpu.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

struct BeadScene {
    char const* yaml;
    Handles handles = Handles::projected;
};

class GpuBeads : public ::testing::TestWithParam<BeadScene> {
  protected:
    void SetUp() override {
        need_gpu();
        if (IsSkipped() || HasFatalFailure()) return;
        ASSERT_EQ(cuda::choose_device(*communicator_), "");
        scene_ = parse_scene(GetParam().yaml, "scene.yaml");
        groups_ = make_groups(scene_, Axes::world, GetParam().handles, false, *communicator_);
        host_ =
            make_bead_dynamics(*groups_[0], scene_, *executor_, *communicator_, make_tree_solver(*groups_[0], *executor_, *communicator_));
        device_ = cuda::make_bead_dynamics(*groups_[0], scene_, *communicator_);
    }
    template <class Operation>
    void both(char const* name, Operation const& operation) {
        operation(*host_);
        operation(*device_);
        for (auto const& [host, device] :
             {std::pair{host_->state(), device_->state()}, {host_->observed_state(), device_->observed_state()}})
            for (std::size_t i = 0; i < host.size(); ++i) EXPECT_EQ(host[i].values, device[i].values) << name << ": " << host[i].name;
        EXPECT_EQ(host_->constraint_error(), device_->constraint_error()) << name;
    }
    std::unique_ptr<Communicator> communicator_ = serial_communicator();
    std::unique_ptr<Executor> executor_ = serial_executor();
    Scene scene_;
    std::vector<std::unique_ptr<ChainGroup>> groups_;
    std::unique_ptr<AbsoluteDynamics> host_, device_;
};

TEST_P(GpuBeads, EachOperationLeavesTheBitsOfTheHost) {
    both("start", [](AbsoluteDynamics&) {});
    for (std::uint64_t step = 0; step < 3; ++step) {
        both("configuration", [](AbsoluteDynamics& d) { d.update_configuration(); });
        both("matrices and forces", [](AbsoluteDynamics& d) {
            d.assemble_matrices();
            d.set_simple_forces();
        });
        if (step == 0) both("drawn velocities", [](AbsoluteDynamics& d) { d.draw_velocities(2.5, 7, {true, true, true}); });
        both("forces from outside", [](AbsoluteDynamics& d) {
            View<3> const force = d.bead_forces();
            ConstView<3> const position = d.bead_positions();
            for (std::int64_t k = 0; k < force.size; ++k) force.store(k, plus_scaled(force.load(k), -0.5, position.load(k)));
            d.take_bead_forces();
        });
        both("kick", [](AbsoluteDynamics& d) { d.kick(0.005); });
        both("thermostat", [&](AbsoluteDynamics& d) { d.thermostat(thermostat_of(0.9, 2.5, 3), step); });
        both("observation", [](AbsoluteDynamics& d) { d.observe(0.002); });
        both("drift", [](AbsoluteDynamics& d) { d.drift(0.01, 0); });
        both("drift and closing", [](AbsoluteDynamics& d) { d.drift(0.01, 1); });
        both("drift, closed", [](AbsoluteDynamics& d) { d.drift(0.01, 4); });
    }
    ConstrainedStep step;
    step.kick = step.drift = 0.01;
    step.sweeps = 4;
    step.thermostat = thermostat_of(0.9, 2.5, 3);
    for (; step.number < 4; ++step.number) {
        step.langevin = step.number % 2 == 0;
        both("matrices", [](AbsoluteDynamics& d) {
            d.update_configuration();
            d.assemble_matrices();
        });
        both("whole step", [&](AbsoluteDynamics& d) { d.step(step); });
    }
    both("evaluation", [](AbsoluteDynamics& d) { d.evaluate(); });
    EXPECT_EQ(host_->residual(), device_->residual());
    EXPECT_EQ(host_->potential().gravity, device_->potential().gravity);
}

char const* const random_links =
    "chains: [{name: a, base: fixed, generator: {random: {bodies: 300, joint: link, seed: 1}}}]\nforces: {gravity: [0, 0, -9.81]}";
INSTANTIATE_TEST_SUITE_P(
    Scenes, GpuBeads,
    ::testing::Values(BeadScene{random_links}, BeadScene{random_links, Handles::full},
                      BeadScene{"chains: [{name: a, count: 3, base: free, generator: {freely_jointed: {beads: 100, length: 0.38}}}]"},
                      BeadScene{
                          "chains: [{name: a, base: fixed, tip: {joint: {type: link, anchor: [1, 2, 3]}}, generator: {random: {bodies: "
                          "60, joint: link, seed: 4}}}]"}),
    [](auto const& scene) { return "scene_" + std::to_string(scene.index); });

}  // namespace
}  // namespace catena::test
