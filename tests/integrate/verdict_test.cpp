// What makes a run valid, from its frames alone.
#include "integrate/verdict.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "error.hpp"
#include "integrate/closing.hpp"

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
TEST(Verdict, ASmallDriftIsSaid) {
    Scene const scene = chain_under("rattle");
    EnergyWatch watch(scene);
    for (int i = 0; i < 100; ++i) watch.add(100 * i, 500, 0.2 * i);  // 15 of 500 over three quarters
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

/// Frames that fluctuate as the canonical ensemble has it, `times` as warm as the thermostat from step `from` on.
EnergyWatch warm(Scene const& scene, double times, int frames, int every) {
    EnergyWatch watch(scene);
    double const kinetic = 0.5 * 201 * scene.boltzmann() * 300;
    std::mt19937 random(2);
    std::normal_distribution<double> noise(0, std::sqrt(2.0 / 201));
    for (int i = 0; i < frames; ++i) watch.add(every * i, times * kinetic * (1 + noise(random)), std::nullopt);
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
    EXPECT_EQ(warm(scene, 1.05, 1000, 1).temperature().value().advice.find("jumped"), std::string::npos);
}
TEST(Verdict, AShortRunFromAColdStartIsValid) {
    Scene const scene = chain_under("g-baoab");
    RunCheck const v = warm(scene, 0.01, 20, 1).temperature().value();
    EXPECT_TRUE(v.passed);
    EXPECT_EQ(v.advice, "");
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
        return closing.close(done, [&] { return std::max(error, rounding); }, [&] { ++sweeps, error *= factor; });
    }
};
TEST(Closing, SweepsGoOnUntilJointsClose) {
    Falling joints{1e-4, 0.1, 0};
    EXPECT_EQ(joints.close({1e-10, 1e-12, 30}), joints.sweeps);
    EXPECT_LE(joints.error, 1e-12);
}
TEST(Closing, ClosedJointsNeedNoSweep) { EXPECT_EQ((Falling{0.9e-10, 0.1, 0}.close({1e-10, 1e-12, 30})), 0); }
TEST(Closing, RoundingEndsSweeps) { EXPECT_LT((Falling{1e-9, 0.01, 2e-12}.close({1e-10, 1e-12, 30})), 5); }
TEST(Closing, RoundingAboveTheToleranceEndsSweepsHoweverManyThereWere) {
    EXPECT_EQ((Falling{1e-9, 1, 1e-9}.close({1e-10, 1e-12, 30}, 30)), 5);
}
TEST(Closing, SlowConvergenceIsNoRounding) { EXPECT_THROW((Falling{9e-8, 0.9, 0}.close({1e-10, 1e-12, 30, 1e-13})), ComputationError); }
TEST(Closing, JointsThatStayOpenAreAnError) {
    EXPECT_THROW((Falling{1e-2, 1, 0}.close({1e-10, 1e-12, 30})), ComputationError);
    EXPECT_THROW((Falling{std::nan(""), 1, 0}.close({1e-10, 1e-12, 30})), ComputationError);
}

}  // namespace
}  // namespace catena::test
