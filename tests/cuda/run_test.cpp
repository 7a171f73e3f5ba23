// Whole runs on the GPU, on one rank and on several that share it, end in the bits of the host's.
#include "cuda/device/gpu.hpp"
#include "error.hpp"
#include "reader/load_scene.hpp"
#include "terms/force_terms.hpp"
#include "tests/run/whole_run.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {
namespace {

class GpuRun : public WholeRun {
  protected:
    void SetUp() override { need_gpu(catena::testing::world()); }
    /// Whether the scene is one for the host, which then refuses the GPU in one line.
    bool is_refused(Backend backend) {
        if (terms::why_host_alone(parse_scene(GetParam().text, "scene.yaml")).empty()) return false;
        try {
            run(catena::testing::world(), "refused", 40, "", backend);
            ADD_FAILURE() << "not refused";
        } catch (InputError const& refusal) {
            EXPECT_NE(std::string(refusal.what()).find("host (solver.backend: "), std::string::npos)
                << refusal.what();
        }
        return true;
    }
};

TEST_P(GpuRun, EndsInTheBitsOfTheHost) {
    if (is_refused(Backend::cuda)) return;
    Communicator const& world = catena::testing::world();
    run(world, "all", 40, "", Backend::cuda);
    run(world, "restarted", 20, "", Backend::cuda);
    run(world, "restarted", 40, "restarted/checkpoint.h5", Backend::cuda);
    if (world.rank() != 0) return;
    run(*serial_communicator(), "host", 40, "", Backend::segments, true);
    ASSERT_FALSE(arrays("host").empty());
    EXPECT_EQ(arrays("all"), arrays("host"));
    EXPECT_EQ(arrays("restarted"), arrays("host"));
}

TEST_P(GpuRun, LevelsEndInTheBitsOfThePairwiseTree) {
    if (is_refused(Backend::cuda_levels)) return;
    run(catena::testing::world(), "levels", 40, "", Backend::cuda_levels);
    if (catena::testing::world().rank() != 0) return;
    run(*serial_communicator(), "pairs", 40, "", Backend::serial);
    EXPECT_EQ(arrays("levels"), arrays("pairs"));
}

auto const name_of_scene = [](auto const& scene) { return scene.param.name; };
INSTANTIATE_TEST_SUITE_P(Integrators, GpuRun, ::testing::ValuesIn(run_scenes), name_of_scene);

/// Chains in joint coordinates that ranks share, with all that acts on them.
RunScene joint_chains(char const* name, char const* joint, char const* more,
                      char const* integrator) {
    auto const chain = [&](std::string const& head, int bodies) {
        return "{" + head + ", generator: {random: {bodies: " + std::to_string(bodies) +
               ", joint: " + joint + ", seed: 3}}}";
    };
    return {name, "chains: [" + chain("name: a, base: free", 130) + ", " +
                      chain(std::string("name: b, base: fixed") + more, 40) +
                      "]\nforces: {gravity: [0, 1, -2], drag: {linear: 0.1, angular: "
                      "0.1}}\ndynamics: {integrator: " +
                      integrator +
                      ", step: 0.0005, steps: 40}\noutput: {every: 20, checkpoint_every: 20, "
                      "joint_forces: true}\n"};
}
char const* const held = ", tip: {joint: {type: spherical}}";
/// What the solutions lack is looked for on the host and solved for on the GPU.
RunScene refined(RunScene scene) {
    scene.text += "solver: {refine: 2}\n";
    return scene;
}
/// From one rank on the host to all, and from all to one.
class GpuRestart : public GpuRun {};
TEST_P(GpuRestart, OnOtherRanksEndsInTheSameBits) {
    Communicator const& world = catena::testing::world();
    run(world, "half", 20, "", Backend::cuda);
    if (world.rank() == 0) {
        auto const one = serial_communicator();
        run(*one, "host", 40, "", Backend::segments, true);
        run(*one, "half-of-host", 20, "", Backend::segments, true);
        run(*one, "half-then-one", 40, "half/checkpoint.h5", Backend::cuda);
        EXPECT_EQ(arrays("half-then-one"), arrays("host"));
    }
    world.barrier();
    run(world, "host-then-all", 40, "half-of-host/checkpoint.h5", Backend::cuda);
    if (world.rank() != 0) return;
    EXPECT_EQ(arrays("host-then-all"), arrays("host"));
}
INSTANTIATE_TEST_SUITE_P(SomeScenes, GpuRestart,
                         ::testing::Values(run_scenes[0], run_scenes[1], run_scenes[3],
                                           run_scenes[4]),
                         name_of_scene);

/// By the ranks' speeds as they are measured, which change no bit.
class GpuBalance : public GpuRun {};
TEST_P(GpuBalance, EndsInTheBitsOfTheHost) {
    Communicator const& world = catena::testing::world();
    run(world, "all", 40, "", Backend::cuda);
    if (world.rank() != 0) return;
    run(*serial_communicator(), "host", 40, "", Backend::segments, true);
    auto balanced = arrays("all");
    EXPECT_EQ(balanced.erase("rank_shares"), world.size() > 1 ? 1 : 0);
    EXPECT_EQ(balanced, arrays("host"));
}
RunScene balanced(RunScene scene) {
    scene.text += "solver: {balance: true}\n";
    return scene;
}
INSTANTIATE_TEST_SUITE_P(SomeScenes, GpuBalance,
                         ::testing::Values(balanced(run_scenes[0]), balanced(run_scenes[3])),
                         name_of_scene);

class SharedGpu : public GpuRun {};
TEST_P(SharedGpu, IsWarnedOf) {
    Communicator const& world = catena::testing::world();
    auto const summary = run(world, "shared", 2, "", Backend::cuda);
    int const ranks = (world.size() + cuda::devices() - 1) /
                      cuda::devices();  // of one host, to whose GPUs they go in turn
    if (world.rank() != 0) return;
    std::string const notes = summary.value("notes", nlohmann::json::array()).dump();
    EXPECT_EQ(
        notes.find("warning: " + std::to_string(ranks) + " ranks share a GPU") != std::string::npos,
        ranks > 1)
        << notes;
}
INSTANTIATE_TEST_SUITE_P(OneScene, SharedGpu, ::testing::Values(run_scenes[0]), name_of_scene);

INSTANTIATE_TEST_SUITE_P(
    Refined, GpuRun,
    ::testing::Values(refined(joint_chains("rk4_revolute_held", "revolute", held, "rk4")),
                      refined(joint_chains("verlet_spherical_held", "spherical", held,
                                           "velocity-verlet")),
                      refined(joint_chains("rk4_planar", "planar", "", "rk4"))),
    name_of_scene);

RunScene articulated(RunScene scene, std::string const& more = "") {
    scene.text += "solver: {handles: articulated" + more + "}\n";
    return scene;
}
INSTANTIATE_TEST_SUITE_P(
    Articulated, GpuRun,
    ::testing::Values(articulated(joint_chains("rk4_helical", "helical", "", "rk4")),
                      articulated(joint_chains("rk4_planar3", "planar3", "", "rk4")),
                      articulated(joint_chains("verlet_mixed", "mixed", "", "velocity-verlet")),
                      articulated(joint_chains("rk4_planar_refined", "planar", "", "rk4"),
                                  ", refine: 1")),
    name_of_scene);

INSTANTIATE_TEST_SUITE_P(
    SharedChains, GpuRun,
    ::testing::Values(joint_chains("rk4_planar", "planar", "", "rk4"),
                      joint_chains("rk4_spherical_held", "spherical", held, "rk4"),
                      joint_chains("rk4_universal_held", "universal", held, "rk4"),
                      joint_chains("rk4_helical_held", "helical", held, "rk4"),
                      joint_chains("rk4_mixed_held", "mixed", held, "rk4"),
                      joint_chains("rk4_cylindrical_held", "cylindrical", held, "rk4"),
                      joint_chains("rk4_planar3_held", "planar3", held, "rk4"),
                      joint_chains("verlet_planar", "planar", "", "velocity-verlet"),
                      joint_chains("verlet_spherical_held", "spherical", held, "velocity-verlet"),
                      joint_chains("verlet_universal_held", "universal", held, "velocity-verlet"),
                      joint_chains("verlet_helical_held", "helical", held, "velocity-verlet"),
                      joint_chains("verlet_mixed_held", "mixed", held, "velocity-verlet")),
    name_of_scene);

/// Bodies in absolute coordinates with springs between those of different ranks.
RunScene sprung_bodies(char const* name, char const* integrator) {
    std::string bodies;
    for (int k = 0; k < 60; ++k)
        bodies += (k > 0 ? ", " : "") +
                  std::string(
                      "{mass: 1, com: [0.05, 0.02, -0.1], inertia: [0.01, 0.012, 0.015], joint: "
                      "{type: spherical, translation: [0, 0, ") +
                  (k > 0 ? "-0.2" : "0") + "], stiffness: [1, 2, 3]}}";
    return {name, "chains: [{name: a, base: fixed, bodies: [" + bodies +
                      "]}]\nforces: {gravity: [0, 1, -2]}\ndynamics: {integrator: " + integrator +
                      ", step: 0.002, steps: 40}\noutput: {every: 20, checkpoint_every: 20, "
                      "joint_forces: true}\n"};
}
INSTANTIATE_TEST_SUITE_P(SharedBodies, GpuRun,
                         ::testing::Values(sprung_bodies("rattle_springs", "rattle"),
                                           sprung_bodies("langevin_springs", "g-baoab")),
                         name_of_scene);

/// A long chain that ranks share, and so many short ones that the last rank holds one unit of it:
/// levels of its tree are empty there.
RunScene long_and_short(char const* name, int beads, int beads_of_short) {
    auto const chain = [](std::string const& head, int n) {
        return "{" + head +
               ", base: free, velocities: thermal, generator: {freely_jointed: {beads: " +
               std::to_string(n) + ", length: 0.38}}}";
    };
    return {name, "chains: [" + chain("name: a", beads) + ", " +
                      chain("name: b, count: 500", beads_of_short) +
                      "]\ndynamics: {integrator: rattle, step: 0.002, steps: 20, temperature: 300, "
                      "seed: 5}\noutput: {every: 20}\n"};
}
INSTANTIATE_TEST_SUITE_P(CutChains, GpuRun,
                         ::testing::Values(long_and_short("runs_of_32", 4128, 8),
                                           long_and_short("more_levels", 8224, 16)),
                         name_of_scene);

}  // namespace
}  // namespace catena::test
