#include "plan/step_work.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reader/load_scene.hpp"
#include "tests/plan/told_machine.hpp"

namespace catena::test {
namespace {

using plan::Arrangement;
using plan::StepWork;

StepWork work_of(std::string const& dynamics,
                 std::string const& chain = "joint: revolute, bodies: 10",
                 std::string const& more = "", int sweeps = 3) {
    return plan::work_of_step(
        parse_scene("chains: [{name: a, generator: {random: {" + chain + ", seed: 1}}}]\n" +
                        "dynamics: {" + dynamics + ", step: 0.001, steps: 1}\n" + more,
                    "told.yaml"),
        sweeps);
}

TEST(StepWork, IsWhatTheIntegratorDoes) {
    std::string const link = "joint: link, bodies: 10";
    EXPECT_EQ(work_of("integrator: rattle", link), (StepWork{0, 0, 0, 0, 1, 3, 0}));
    EXPECT_EQ(work_of("integrator: g-baoab, temperature: 300, friction: 1", link),
              (StepWork{0, 0, 0, 0, 2, 6, 1}));
    EXPECT_EQ(work_of("integrator: rk4"), (StepWork{4, 0, 0, 0}));
    EXPECT_EQ(work_of("integrator: dormand-prince"), (StepWork{6, 0, 0, 0}));
    EXPECT_EQ(work_of("integrator: velocity-verlet"), (StepWork{1, 0, 0, 0}));
    EXPECT_EQ(work_of("integrator: staggered"), (StepWork{0, 2, 1, 2}));
    EXPECT_EQ(work_of("integrator: baoab, temperature: 300, friction: 1"), (StepWork{0, 3, 2, 3}));
    std::string const refined = "solver: {refine: 2}\n";
    EXPECT_EQ(work_of("integrator: rk4", "joint: revolute, bodies: 10", refined),
              (StepWork{0, 4, 4, 12}));
}

TEST(StepWork, TakesTheTimesOfItsParts) {
    plan::PhaseSeconds const of{1, 10, 100, 1000, 5000};
    EXPECT_EQ((StepWork{4, 0, 0, 0}).seconds(of), 4000);
    EXPECT_EQ((StepWork{0, 1, 1, 5}).seconds(of), 511);
    plan::PhaseSeconds together = of;
    together[plan::matrix_sweep] = together[plan::bias_sweep] = std::nan("");
    EXPECT_EQ((StepWork{4, 1, 0, 0}).seconds(together), 4001);
    EXPECT_TRUE(std::isnan((StepWork{0, 1, 1, 5}).seconds(together)));
    EXPECT_EQ((StepWork{0, 0, 0, 0, 2, 6, 1}).seconds(plan::DriftSeconds{1, 10, 100}), 162);
}

plan::StepPrediction predict(std::string const& solver, bool gpu, int ranks,
                             plan::StepWork const& work = {0, 1, 1, 5}) {
    plan::Planner planner(told_machine(gpu), {}, 65536);
    return plan::predict_step(planner, told_scene(100000, solver), Axes::joint, work, ranks);
}

/// The told machine's phases are 0.2, 0.5 and 0.3 of an evaluation: a step of 0.2 + 0.5 + 5 * 0.3.
TEST(StepPrediction, IsThatOfTheLargestShareOnWhatIsChosenForIt) {
    for (int const ranks : {1, 2, 3, 64, 4096}) {
        plan::StepPrediction const step = predict("{}", true, ranks);
        std::int64_t const bodies =
            plan::shares_of(told_scene(100000), Axes::joint, ranks).front().bodies;
        EXPECT_EQ(step.bodies, bodies);
        EXPECT_EQ(step.arrangement,
                  (bodies > 400 ? Arrangement{Backend::cuda, 4} : Arrangement{Backend::openmp, 4}))
            << ranks;
        double const told = 2.2 * (1e-4 + 1e-8 * static_cast<double>(bodies));
        EXPECT_NEAR(step.seconds, told, 0.11 * told) << ranks;
    }
    EXPECT_EQ(predict("{}", true, 64).bodies, predict("{}", true, 4096).bodies)
        << "a chain has 64 units at most";
}

TEST(StepPrediction, IsThatOfWhatTheSceneAsksFor) {
    EXPECT_EQ(predict("{backend: segments, threads: 3}", true, 2).arrangement,
              (Arrangement{Backend::segments, 1}));
    EXPECT_EQ(predict("{backend: openmp}", true, 2).arrangement, (Arrangement{Backend::openmp, 4}));
    EXPECT_EQ(predict("{backend: openmp, threads: 2}", true, 2).arrangement,
              (Arrangement{Backend::openmp, 2}));
    double const told = 2.2 * 1e-6 * 50000;
    EXPECT_NEAR(predict("{backend: serial}", false, 2).seconds, told, 0.05 * told);
    EXPECT_TRUE(std::isnan(predict("{backend: cuda-levels}", true, 2).seconds))
        << "sweeps are not measured one by one";
    EXPECT_GT(predict("{backend: cuda-levels}", true, 2, {4, 0, 0, 0}).seconds, 0);
    plan::StepPrediction const without = predict("{backend: cuda-levels}", false, 2);
    EXPECT_TRUE(std::isnan(without.seconds));
    EXPECT_EQ(without.unusable, "there is no GPU");
}

/// The told machine's drifts take 1.2 evaluations, their sweeps 0.4, noise 0.1.
TEST(StepPrediction, InAbsoluteCoordinatesIsThatOfDrifts) {
    Scene const scene = parse_scene(
        "chains: [{name: a, generator: {freely_jointed: {beads: 50000, length: 1}}}]", "told.yaml");
    plan::Planner planner(told_machine(false), {}, 65536);
    StepWork const work{0, 0, 0, 0, 2, 8, 1};
    double const told = (2 * 1.2 + 8 * 0.4 + 0.1) * (2e-5 + 1e-6 * 50000 / 4);
    EXPECT_NEAR(plan::predict_step(planner, scene, Axes::world, work, 1).seconds, told,
                0.05 * told);
}

/// On this machine: every cost is there, and more bodies cost more. A sweep of few, a difference of
/// two times, may be lost in what else goes on.
TEST(DriftCosts, AreMeasured) {
    plan::Machine const machine = plan::this_machine(*serial_communicator(), 1);
    for (plan::Family const& family : plan::all_families()) {
        if (family.axes != Axes::world) continue;
        plan::DriftSeconds const few = machine.measure_drifts(family, 64, {Backend::segments, 1});
        plan::DriftSeconds const many =
            machine.measure_drifts(family, 4096, {Backend::segments, 1});
        for (std::size_t c = 0; c < plan::drift_costs; ++c) {
            EXPECT_GE(few[c], 0) << family.name();
            EXPECT_GT(many[c], few[c]) << family.name();
        }
    }
}

}  // namespace
}  // namespace catena::test
