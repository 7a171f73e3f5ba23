// What makes a run valid, from its frames alone.
#include "observe/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "dca/pivot_failure.hpp"
#include "dynamics/closing.hpp"
#include "error.hpp"
#include "integrate/step_failure.hpp"
#include "observe/run_verdict.hpp"
#include "reader/load_scene.hpp"

namespace catena::test {
namespace {

/// 100 beads on links under the integrator; 3 * 100 - 99 = 201 degrees of freedom.
Scene chain_under(std::string const& integrator, std::string const& more = "") {
    return parse_scene(
        "chains: [{name: c, generator: {freely_jointed: {beads: 100, length: 0.38, mass: 100}}}]\n"
        "dynamics: {integrator: " +
            integrator + ", step: 0.01, steps: 1000, temperature: 300, friction: 1" + more + "}\n",
        "scene.yaml");
}

TEST(Verdict, EnergyThatGrowsMakesARunInvalid) {
    Scene const scene = chain_under("rattle");
    EnergyWatch watch(scene);
    for (int i = 0; i < 12; ++i) watch.add(100 * i, 500 + 10 * i, 0.0);
    RunCheck const v = watch.energy().value();
    EXPECT_FALSE(v.passed);
    EXPECT_GT(v.value, 0.1);
    EXPECT_EQ(v.step, 1100);
    EXPECT_NE(v.advice.find("dynamics.step"), std::string::npos) << v.advice;
}
TEST(Verdict, EnergyThatFluctuatesIsValidWithoutANote) {
    Scene const scene = chain_under("rattle");
    EnergyWatch watch(scene);
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 10);
    for (int i = 0; i < 100; ++i) watch.add(100 * i, 500 + noise(random), 0.0);
    RunCheck const v = watch.energy().value();
    EXPECT_TRUE(v.passed);
    EXPECT_EQ(v.advice, "");
}
TEST(Verdict, AnEnergyThatIsNoNumberMakesAnyRunInvalid) {
    for (char const* const integrator : {"rattle", "g-baoab"}) {
        Scene const scene = chain_under(integrator);
        EnergyWatch watch(scene);
        for (int i = 0; i < 12; ++i) watch.add(100 * i, 250, i == 7 ? NAN : 0.0);
        RunCheck const v = watch.energy().value();
        EXPECT_FALSE(v.passed);
        EXPECT_EQ(v.step, 700);
        EXPECT_NE(v.advice.find("not a finite number at step 700"), std::string::npos) << v.advice;
    }
}
TEST(Closing, PositionsThatAreNotFiniteAreSaid) {
    try {
        Closing().close(0, [] { return NAN; }, [] {});
        FAIL();
    } catch (ComputationError const& error) {
        EXPECT_NE(std::string(error.what()).find("(positions are no longer finite)"),
                  std::string::npos)
            << error.what();
    }
}
TEST(Verdict, ASmallDriftIsSaid) {
    Scene const scene = chain_under("rattle");
    EnergyWatch watch(scene);
    for (int i = 0; i < 100; ++i)
        watch.add(100 * i, 500, 0.2 * i);  // 15 of 500 over three quarters
    RunCheck const v = watch.energy().value();
    EXPECT_TRUE(v.passed);
    EXPECT_NE(v.advice.find("by 0.0296"), std::string::npos) << v.advice;
}
TEST(Verdict, AJumpAtTheStartIsSaid) {
    Scene const scene = chain_under("rattle");
    EnergyWatch watch(scene);
    watch.add(0, 977.8, 0.0);
    for (int i = 1; i < 20; ++i) watch.add(i, 1306.9, 0.0);
    RunCheck const v = watch.energy().value();
    EXPECT_TRUE(v.passed);
    EXPECT_NE(v.advice.find("jumped from 977.8 to 1306.9"), std::string::npos) << v.advice;
}
TEST(Verdict, AThermostatNeedKeepNoEnergy) {
    Scene const scene = chain_under("g-baoab");
    EnergyWatch watch(scene);
    for (int i = 0; i < 12; ++i) watch.add(100 * i, 500 + 10 * i, 0.0);
    EXPECT_FALSE(watch.energy().has_value());
}

/// Frames that fluctuate as the canonical ensemble has it, `times` as warm as the thermostat from
/// step `from` on.
EnergyWatch warm(Scene const& scene, double times, int frames, int every) {
    EnergyWatch watch(scene);
    double const kinetic = 0.5 * 201 * scene.boltzmann() * 300;
    std::mt19937 random(2);
    std::normal_distribution<double> noise(0, std::sqrt(2.0 / 201));
    for (int i = 0; i < frames; ++i)
        watch.add(every * i, times * kinetic * (1 + noise(random)), std::nullopt);
    return watch;
}
TEST(Verdict, ThirtyThousandKelvinAreInvalid) {
    Scene const scene = chain_under("g-baoab");
    RunCheck const v = warm(scene, 100, 3, 10).temperature().value();
    EXPECT_FALSE(v.passed);
    EXPECT_GT(v.value, 20000);
    EXPECT_NE(v.advice.find("300 K"), std::string::npos) << v.advice;
}
TEST(Verdict, TheThermostatsTemperatureIsValid) {
    Scene const scene = chain_under("g-baoab");
    RunCheck const v = warm(scene, 1, 1000, 100).temperature().value();
    EXPECT_TRUE(v.passed);
    EXPECT_EQ(v.advice, "");
}
TEST(Verdict, ATemperatureFivePercentOffIsSaidOnceTheStartIsForgotten) {
    Scene const scene = chain_under("g-baoab");
    RunCheck const late = warm(scene, 1.05, 1000, 100).temperature().value();
    EXPECT_TRUE(late.passed);
    EXPECT_NE(late.advice.find("standard errors"), std::string::npos) << late.advice;
    EXPECT_EQ(warm(scene, 1.05, 1000, 1).temperature().value().advice.find("jumped"),
              std::string::npos);
}
TEST(Verdict, AShortRunFromAColdStartIsValid) {
    Scene const scene = chain_under("g-baoab");
    RunCheck const v = warm(scene, 0.01, 20, 1).temperature().value();
    EXPECT_TRUE(v.passed);
    EXPECT_EQ(v.advice, "");
}

TEST(Verdict, ALongRunKeepsMeansOfItsFrames) {
    Scene const scene = chain_under("rattle");
    EnergyWatch watch(scene);
    int const frames = 50000;
    for (int i = 0; i < frames; ++i) watch.add(10 * i, 500, 1e-3 * i - 200.0);
    RunCheck const v = watch.energy().value();
    EXPECT_NEAR(v.value, 0.75 * 1e-3 * frames / 500, 2e-3);
    EXPECT_EQ(v.step, 10 * (frames - 1));
    EXPECT_LE(watch.state().size(), 5 * (EnergySeries::most + 1));
    EnergyWatch restarted(scene);
    EXPECT_TRUE(restarted.set_state(watch.state(), v.step));
    EXPECT_EQ(restarted.energy().value().advice, v.advice);
    EXPECT_FALSE(restarted.set_state(watch.state(), v.step - 1))
        << "frames beyond the checkpoint's step";
    // The checkpoint's frame comes again.
    restarted.add(v.step, 1e9, 0.0);
    EXPECT_EQ(restarted.state(), watch.state());
}
TEST(Verdict, NonFiniteEnergiesStayInvalid) {
    Scene const scene = chain_under("rattle");
    EnergyWatch watch(scene);
    for (int i = 0; i < 10; ++i) watch.add(i, 500, i == 5 ? std::nan("") : 0.0);
    EXPECT_FALSE(watch.energy().value().passed);
    EnergyWatch restarted(scene);
    EXPECT_TRUE(restarted.set_state(watch.state(), 9));
    EXPECT_FALSE(restarted.energy().value().passed);
}
TEST(Verdict, TheWorstJointKeepsItsStepOverARestart) {
    Scene const scene = chain_under("rattle");
    RunVerdict first(scene), second(scene), earlier(scene);
    first.note_error(12, 1e-6);
    first.note_error(20, 1e-7);
    Checkpoint c;
    c.step = 20;
    first.save(c);
    EXPECT_EQ(second.restore(c), "");
    second.note_error(25, 1e-8);
    second.note_end(30, 0);
    EXPECT_EQ(second.checks().at(0).step, 12);
    EXPECT_FALSE(second.checks().at(0).passed);
    c.arrays.erase("verdict_frames");
    c.integers.clear();
    EXPECT_NE(earlier.restore(c).find("from 20 on"), std::string::npos);
    EXPECT_EQ(earlier.checks().at(0).step, 20);
    // The next restart says it again.
    Checkpoint later;
    later.step = 30;
    earlier.save(later);
    EXPECT_NE(RunVerdict(scene).restore(later).find("from 20 on"), std::string::npos);
}
TEST(Verdict, ABranchIsStillOneAfterARestart) {
    Scene const scene = chain_under("g-baoab");
    double const thermal = 0.5 * scene.boltzmann() * 300 * 201;
    RunVerdict branch(scene), restarted(scene);
    branch.branch();
    for (int i = 0; i < 4; ++i)
        branch.add_frame(i, 10 * thermal,
                         0.0);  // 0.03 ps: nothing is forgotten at a friction of 1 / ps
    Checkpoint c;
    c.step = 4;
    branch.save(c);
    EXPECT_EQ(restarted.restore(c), "");
    for (RunVerdict const* const verdict : {&branch, &restarted})
        for (RunCheck const& check : verdict->checks())
            EXPECT_TRUE(check.passed) << check.name << ": " << check.advice;
}

/// The mean of frames `above` the thermostat's temperature, of a chain with loads.
RunCheck temperature_of(Scene const& scene, double times) {
    return warm(scene, times, 1000, 100).temperature().value();
}
TEST(Verdict, PrescribedMotionsSayThatTheTemperatureIsNotChecked) {
    Scene const scene = parse_scene(
        "chains: [{name: c, base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: "
        "revolute, axis: [0, 0, 1], motion: {rate: "
        "1}}},"
        "{mass: 1, inertia: [1, 1, 1], joint: {type: spherical, translation: [1, 0, 0]}}]}]\n"
        "dynamics: {integrator: baoab, step: 0.01, steps: 1000, temperature: 300, friction: 1}\n",
        "scene.yaml");
    RunCheck const v = temperature_of(scene, 1e3);
    EXPECT_TRUE(v.passed);
    EXPECT_NE(v.advice.find("not checked: motions are prescribed"), std::string::npos) << v.advice;
}
TEST(Verdict, ATorqueAddsNoMoreThanFrictionLetsIt) {
    // tau^2 / (I friction^2 dof kB) = 1 / (1 * 1 * 1 * 0.00831446) = 120.27 K of a lone rotor.
    Scene const scene = parse_scene(
        "chains: [{name: c, base: fixed, bodies: [{mass: 1, inertia: [2, 3, 1], joint: {type: "
        "revolute, axis: [0, 0, 1], torque: 1}}]}]\n"
        "dynamics: {integrator: baoab, step: 0.01, steps: 1000, temperature: 300, friction: 1}\n",
        "scene.yaml");
    EXPECT_NEAR(heating_of(scene, false).excess, 120.27, 0.01);
    EnergyWatch mild(scene), hot(scene);
    for (int i = 0; i < 1000; ++i) {
        double const thermal = 0.5 * scene.boltzmann() * 300;
        mild.add(100 * i, 1.4 * thermal, 0.0), hot.add(100 * i, 2.2 * thermal, 0.0);
    }
    EXPECT_TRUE(mild.temperature().value().passed);
    EXPECT_NE(mild.temperature().value().advice.find("120 K"), std::string::npos);
    EXPECT_FALSE(hot.temperature().value().passed);
}

TEST(Verdict, ObliqueAxesOfAUniversalJointNeedMoreTorque) {
    auto const excess = [](std::string const& second) {
        return heating_of(parse_scene("chains: [{name: u, base: fixed, bodies: [{mass: 1, inertia: "
                                      "[1, 1, 1], joint: {type: universal, "
                                      "axes: [[1, 0, 0], " +
                                          second +
                                          "], torque: [2, 0]}}]}]\n"
                                          "dynamics: {integrator: baoab, step: 0.01, steps: 10, "
                                          "temperature: 300, friction: 1}\n",
                                      "scene.yaml"),
                          false)
            .excess;
    };
    EXPECT_NEAR(excess("[1, 1, 0]") / excess("[0, 1, 0]"), 2, 1e-9);  // 1 / sin^2 of 45 degrees
}
TEST(Verdict, LongStepsDriftFasterThanFrictionTells) {
    DynamicsSpec d;
    d.friction = 60, d.step = 0.05;
    EXPECT_NEAR(drift_of_step(d), 1.5 / std::tanh(1.5), 1e-15);
    d.step = 1e-9;
    EXPECT_EQ(drift_of_step(d), 1);
}
TEST(Verdict, WeakFrictionLeavesTheHeatOfAFallUncertain) {
    // A free body of 6 degrees falls from rest; friction has taken next to nothing in 3 ps, and
    // kinetic energy is what gravity gave.
    Scene const scene = parse_scene(
        "chains: [{name: b, bodies: [{mass: 10, inertia: [1, 1, 1], joint: {type: free}}]}]\n"
        "forces: {gravity: [0, 0, -3]}\n"
        "dynamics: {integrator: baoab, step: 0.01, steps: 300, temperature: 300, friction: "
        "0.0001}\n",
        "scene.yaml");
    EnergyWatch watch(scene);
    double const start = 3 * scene.boltzmann() * 300;
    for (int i = 0; i <= 30; ++i) {
        double const speed = 3 * 0.1 * i, gained = 0.5 * 10 * speed * speed;
        watch.add(10 * i, start + gained,
                  -gained + 0.01 * i);  // total energy rises by a little: noise
    }
    EXPECT_TRUE(watch.temperature().value().passed) << watch.temperature().value().advice;
}

TEST(Failure, WithinAStepNamesTheStepBeforeTheMasses) {
    Scene const scene = chain_under("rattle");
    std::string const lost = std::string("a matrix is lost (body 2): ") + dca::cause_of_lost_matrix;
    EXPECT_EQ(failure_in_step(0, lost, scene, false), "at step 0: " + lost);
    EXPECT_EQ(failure_in_step(7, lost, scene, true),
              "at step 7: a matrix is lost (body 2): dynamics.step = 0.01 is too long for the "
              "forces and speeds there: choose a smaller one; otherwise " +
                  std::string(dca::cause_of_lost_matrix));
    EXPECT_EQ(failure_in_step(7, "no disk", scene, true), "at step 7: no disk");
}

TEST(Verdict, CoordinatesBeyondWhatResolvesLinksAreInvalid) {
    EXPECT_FALSE(coordinates_verdict(1e7, 0.38, 1e-10, 7)->passed);
    EXPECT_TRUE(coordinates_verdict(1e3, 0.38, 1e-10, 7)->passed);
    EXPECT_FALSE(coordinates_verdict(1e7, 0, 1e-10, 7).has_value());
}
TEST(Verdict, JsonHasEveryCheck) {
    nlohmann::json const json = as_json({joints_verdict(1e-6, 1e-10, 12, "dynamics.step")});
    EXPECT_EQ(json.at("valid"), false);
    nlohmann::json const& check = json.at("checks").at(0);
    EXPECT_EQ(check.at("name"), "joints");
    EXPECT_EQ(check.at("step"), 12);
    EXPECT_EQ(check.at("value"), 1e-6);
    EXPECT_EQ(check.at("limit"), 1e-10);
}

/// Errors that fall by `factor` with every sweep, not below `rounding`.
struct Falling {
    double error, factor, rounding;
    int sweeps = 0;
    int close(Closing const& closing, int done = 2) {
        return closing.close(
            done, [&] { return std::max(error, rounding); }, [&] { ++sweeps, error *= factor; });
    }
};
TEST(Closing, SweepsGoOnUntilJointsClose) {
    Falling joints{1e-4, 0.1, 0};
    EXPECT_EQ(joints.close({1e-10, 1e-12, 30}), joints.sweeps);
    EXPECT_LE(joints.error, 1e-12);
}
TEST(Closing, ClosedJointsNeedNoSweep) {
    EXPECT_EQ((Falling{0.9e-10, 0.1, 0}.close({1e-10, 1e-12, 30})), 0);
}
TEST(Closing, RoundingEndsSweeps) {
    EXPECT_LT((Falling{1e-9, 0.01, 2e-12}.close({1e-10, 1e-12, 30})), 5);
}
TEST(Closing, RoundingAboveTheToleranceEndsSweepsHoweverManyThereWere) {
    EXPECT_EQ((Falling{1e-9, 1, 1e-9}.close({1e-10, 1e-12, 30}, 30)), 5);
}
TEST(Closing, SlowConvergenceIsNoRounding) {
    EXPECT_THROW((Falling{9e-8, 0.9, 0}.close({1e-10, 1e-12, 30, 1e-13})), ComputationError);
}
TEST(Closing, JointsThatStayOpenAreAnError) {
    EXPECT_THROW((Falling{1e-2, 1, 0}.close({1e-10, 1e-12, 30})), ComputationError);
    EXPECT_THROW((Falling{std::nan(""), 1, 0}.close({1e-10, 1e-12, 30})), ComputationError);
}

}  // namespace
}  // namespace catena::test
