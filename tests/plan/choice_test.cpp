#include <gtest/gtest.h>

#include "cuda/space/memory.hpp"
#include "reader/load_scene.hpp"
#include "tests/plan/told_machine.hpp"

namespace catena::test {
namespace {

using plan::Arrangement;

plan::Choice choose(Scene const& scene, plan::Machine machine, int ranks = 1) {
    plan::Planner planner(std::move(machine), {}, 65536);
    return plan::choose(scene, Axes::joint, planner, ranks);
}

TEST(Choice, PredictionsAreTheMachinesTimes) {
    for (std::int64_t const bodies : {1, 5, 16, 37, 1000, 16384, 100000, 5000000}) {
        plan::Machine const machine = told_machine(true);
        plan::Planner planner(machine, {}, 65536);
        for (plan::Prediction const& p :
             planner.predict({{{scene::RandomJoint::revolute}, bodies, {}}})) {
            double const told = machine.measure({}, bodies, p.arrangement)[plan::evaluation];
            // Between points the curve is straight in logarithms, the formula in numbers: 11 % at
            // most over a factor of 4.
            EXPECT_NEAR(p.seconds[plan::evaluation], told, 0.11 * told)
                << bodies << " " << p.arrangement.name();
        }
    }
}

TEST(Choice, TheQuickestThatLeavesTheBits) {
    for (auto const& [bodies, with_gpu, without] :
         {std::tuple<int, Arrangement, Arrangement>{
              10, {Backend::segments, 1}, {Backend::segments, 1}},
          {60, {Backend::openmp, 4}, {Backend::openmp, 4}},
          {10000, {Backend::cuda, 4}, {Backend::openmp, 4}}}) {
        EXPECT_EQ(choose(told_scene(bodies), told_machine(true)).arrangement, with_gpu) << bodies;
        plan::Choice const choice = choose(told_scene(bodies), told_machine(false));
        EXPECT_EQ(choice.arrangement, without) << bodies;
        EXPECT_NE(choice.reason.find("; there is no GPU"), std::string::npos) << choice.reason;
    }
}

TEST(Choice, AnotherTreeIsNeverChosenUnasked) {
    plan::Machine machine = told_machine(false);
    machine.measure = [](plan::Family const&, std::int64_t bodies, Arrangement const& on) {
        double const t =
            (on.backend == Backend::serial ? 1e-9 : 1e-6) * static_cast<double>(bodies);
        return plan::PhaseSeconds{t, t, t, t, t};
    };
    EXPECT_EQ(choose(told_scene(1000), machine).arrangement, (Arrangement{Backend::segments, 1}));
}

TEST(Choice, WhatDoesNotFitOnTheGpuStaysOnTheHost) {
    plan::Machine machine = told_machine(true);
    machine.free_gpu_memory = [] { return 9e6; };
    plan::Choice const choice = choose(told_scene(10000), machine);
    EXPECT_EQ(choice.arrangement, (Arrangement{Backend::openmp, 4}));
    EXPECT_NE(choice.reason.find("GiB of GPU memory are needed"), std::string::npos)
        << choice.reason;
}

TEST(Choice, ChainsGoWhereOpenMmTakesTheGpu) {
    Arrangement const core{Backend::segments, 1}, gpu{Backend::cuda, 4};
    plan::Machine const machine = told_machine(true);
    Scene scene = parse_scene(
        "chains: [{name: a, generator: {freely_jointed: {beads: 10, length: 1}}}]", "told.yaml");
    EXPECT_EQ(choose(scene, machine).arrangement, core);  // quicker
    scene.forces.openmm.emplace();
    EXPECT_EQ(choose(scene, machine).arrangement, gpu);
    EXPECT_EQ(choose(scene, machine, 2).arrangement, core)
        << "OpenMM of several ranks computes on processors";
    plan::Machine without = machine, small = machine;
    without.openmm_on_gpu = [] { return false; };
    EXPECT_EQ(choose(scene, without).arrangement, core);
    small.free_gpu_memory = [] { return 1e6; };
    EXPECT_EQ(choose(scene, small).arrangement, core);
    plan::Machine broken = machine;
    broken.measure = [told = machine.measure](plan::Family const& family, std::int64_t bodies,
                                              Arrangement const& on) {
        if (on.backend == Backend::cuda) throw std::runtime_error("no kernels");
        return told(family, bodies, on);
    };
    EXPECT_EQ(choose(scene, broken).arrangement, core);
    scene.forces.openmm->path = "inline";
    EXPECT_EQ(choose(scene, machine).arrangement, core);
    scene.forces.openmm->path = "auto";
    scene.forces.openmm->platform = "CPU";
    EXPECT_EQ(choose(scene, machine).arrangement, core);
    Scene bodies = told_scene(10);
    bodies.forces.openmm.emplace();
    EXPECT_EQ(choose(bodies, machine).arrangement, core);
}

// Told: 1000 beads take 1 ms on one core, 270 us on four. Forces of a microsecond a bead hide that
// gain where there are many more beads: of 10000 beads in chains of 10 a step takes 10 ms of forces
// and more.
TEST(Choice, ThreadsAreNotTakenForAGainThatIsSmallBesideTheForces) {
    plan::Machine machine = told_machine(false);
    machine.openmm_on_gpu = [] { return false; };
    machine.measure = [](plan::Family const&, std::int64_t bodies, Arrangement const& on) {
        double const t = 2e-8 * static_cast<double>(bodies) / on.threads;
        return plan::PhaseSeconds{0.2 * t, 0.5 * t, 0.3 * t, t, t};
    };
    Scene scene = parse_scene(
        "chains: [{name: a, count: 10, generator: {freely_jointed: {beads: 1000, length: 1}}}]",
        "told.yaml");
    EXPECT_EQ(choose(scene, machine).arrangement, (Arrangement{Backend::openmp, 4}));
    scene.forces.openmm.emplace();
    plan::Choice const choice = choose(scene, machine);
    EXPECT_EQ(choice.arrangement, (Arrangement{Backend::segments, 1}));
    EXPECT_NE(choice.reason.find("forces take at least 10 ms"), std::string::npos) << choice.reason;
    machine.openmm_on_gpu = [] { return true; };
    EXPECT_EQ(choose(scene, machine).arrangement, (Arrangement{Backend::openmp, 4}))
        << "forces on a GPU are not so slow";
}

TEST(Choice, CoresThatOtherProgramsUseGetNoThreads) {
    plan::Machine machine = told_machine(false);
    machine.spare = 4;
    EXPECT_EQ(choose(told_scene(10000), machine).arrangement, (Arrangement{Backend::openmp, 4}));
    machine.spare = 3;
    plan::Choice const some = choose(told_scene(10000), machine);
    EXPECT_EQ(some.arrangement, (Arrangement{Backend::openmp, 2}));
    EXPECT_NE(some.reason.find("other programs leave 3 of 4 cores"), std::string::npos)
        << some.reason;
    machine.spare = 1;
    EXPECT_EQ(choose(told_scene(10000), machine).arrangement, (Arrangement{Backend::segments, 1}));
}

/// As on another rank's GPU, or where OpenMM is there as well: known when everything is about to be
/// made.
TEST(Choice, AGpuThatTurnsOutTooSmallIsLeftOut) {
    std::vector<Backend> tried;
    std::string reason;
    auto const chooser = [](Scene const& scene, std::string const& no_gpu) {
        plan::Machine machine = told_machine(true);
        if (!no_gpu.empty()) plan::without_gpu(machine, no_gpu);
        return choose(scene, machine);
    };
    auto const action = [&](Scene const& scene, plan::Choice const& choice) {
        tried.push_back(scene.solver.backend);
        reason = choice.reason;
        if (scene.solver.backend == Backend::cuda)
            throw cuda::TooLittleMemory("9 GiB are needed, rank 3", "solver.backend", "use others");
    };
    plan::with_choice(told_scene(10000), chooser, action);
    EXPECT_EQ(tried, (std::vector<Backend>{Backend::cuda, Backend::openmp}));
    EXPECT_NE(reason.find("; 9 GiB are needed, rank 3"), std::string::npos) << reason;
    EXPECT_THROW(plan::with_choice(told_scene(10000, "{backend: cuda}"), chooser, action),
                 InputError);  // asked for
}

TEST(Choice, AGpuThatFailsIsLeftOut) {
    plan::Machine machine = told_machine(true);
    machine.measure = [told = machine.measure](plan::Family const& family, std::int64_t bodies,
                                               Arrangement const& on) {
        if (on.backend == Backend::cuda) throw std::runtime_error("no kernels");
        return told(family, bodies, on);
    };
    plan::Choice const choice = choose(told_scene(10000), machine);
    EXPECT_EQ(choice.arrangement, (Arrangement{Backend::openmp, 4}));
    EXPECT_NE(choice.reason.find("no kernels"), std::string::npos) << choice.reason;
}

TEST(Choice, NothingIsMeasuredWhereNothingIsOpen) {
    plan::Machine machine = told_machine(false);
    machine.measure = [](auto const&, auto, auto const&) -> plan::PhaseSeconds {
        throw std::logic_error("measured");
    };
    EXPECT_EQ(choose(told_scene(1000, "{backend: serial}"), machine).reason, "requested");
    machine.alike.resize(1);
    EXPECT_EQ(choose(told_scene(1000), machine).arrangement, (Arrangement{Backend::segments, 1}));
    auto const alone = serial_communicator();
    EXPECT_EQ(plan::choose(told_scene(10, "{backend: openmp, threads: 3}"), Axes::joint, *alone)
                  .arrangement,
              (Arrangement{Backend::openmp, 3}));
}

TEST(Choice, TheSceneGetsWhatWasOpenAndNothingElse) {
    Scene const given = told_scene(10000);
    Scene const chosen = plan::with_choice(given, choose(given, told_machine(true)));
    EXPECT_EQ(chosen.solver.backend, Backend::cuda);
    EXPECT_EQ(chosen.solver.gpu_levels, "auto");
    Scene const levels = told_scene(4096, "{backend: cuda-levels}");
    Scene const cut = plan::with_choice(levels, choose(levels, told_machine(true)));
    EXPECT_EQ(cut.solver.backend, Backend::cuda_levels);
    EXPECT_GT(cut.solver.levels_on_gpu().up, 2);
    EXPECT_LT(cut.solver.levels_on_gpu().up, 12);
    Scene const asked = told_scene(4096, "{backend: cuda-levels, gpu_levels: \"3,2\"}");
    EXPECT_EQ(plan::with_choice(asked, choose(asked, told_machine(true))).solver.gpu_levels, "3,2");
}

TEST(Choice, SharesAreTheGroupsOfTheScene) {
    Scene const scene = parse_scene(
        "chains: [{name: a, count: 3, generator: {random: {joint: link, bodies: 50, seed: 1}}}, "
        "{name: b, base: fixed, generator: {random: {joint: planar, bodies: 33, seed: 1}}}, "
        "{name: c, generator: {random: {joint: link, bodies: 10, rigid: 0.5, seed: 1}}}, "
        "{name: d, base: fixed, generator: {random: {joint: helical, bodies: 7, seed: 1}}}]",
        "told.yaml");
    std::map<std::string, std::int64_t> found;
    for (plan::Share const& share : plan::shares_of(scene, Axes::joint, 1))
        found[share.family.name()] = share.bodies;
    EXPECT_EQ(found,
              (std::map<std::string, std::int64_t>{
                  {"link", 150}, {"planar", 33}, {"link with bodies", 10}, {"prismatic", 7}}));
    auto const alone = serial_communicator();
    for (plan::Family const& family : plan::all_families()) {  // a sample is what it stands for
        Scene const sample = plan::sample(family, 20);
        auto const shares = plan::shares_of(sample, family.axes, 1);
        ASSERT_EQ(shares.size(), 1U);
        EXPECT_EQ(shares[0].family.name(), family.name());
        EXPECT_EQ(shares[0].merges, (std::vector<std::int64_t>{10, 5, 2, 1, 1}));
        EXPECT_EQ(make_groups(sample, family.axes, family.handles, false, *alone).size(), 1U);
    }
}

}  // namespace
}  // namespace catena::test
