// The Dormand-Prince pair and the choice of its steps: orders, errors in proportion to the
// tolerance, fewer evaluations than steps of one length, rejected steps without a trace.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "error.hpp"
#include "integrate/joint_integrators.hpp"
#include "integrate/step_control.hpp"
#include "integrate/stepper.hpp"
#include "reader/load_scene.hpp"
#include "scene/pose.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

struct Ended {
    std::vector<Vec3> position;
    std::int64_t evaluations = 0;
    nlohmann::json inner;
    double open = 0;  // jointed tips
};
Ended end_of(Scene scene, Integrator integrator, double tolerance, double time, int steps) {
    scene.dynamics.given = true;
    scene.dynamics.integrator = integrator;
    scene.dynamics.tolerance = tolerance;
    scene.dynamics.step = time / steps;
    auto const communicator = serial_communicator();
    ChainSystem system(scene, Axes::joint, *communicator);
    auto const stepper = make_stepper(system, scene.dynamics);
    for (int n = 0; n < steps; ++n) {
        stepper->prepare(nullptr);
        stepper->step(n, nullptr);
    }
    Ended end{system.snapshot().position, 4 * steps, stepper->inner_steps(),
              stepper->constraint_error()};
    if (!end.inner.is_null()) end.evaluations = end.inner.at("evaluations").get<std::int64_t>();
    return end;
}
double distance(Ended const& a, Ended const& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.position.size(); ++i)
        worst = std::max(worst, norm(a.position[i] - b.position[i]));
    return worst;
}

/// Springs on every kind of joint, loads, a start in motion; several chains.
Scene swinging(RandomJoints joints, Base base) {
    RandomChainOptions options;
    options.bodies = 6;
    options.joints = joints;
    options.base = base;
    options.springs = true;
    options.driven = 0.2;
    Scene scene;
    scene.chains = {random_chain(5, options), random_chain(6, options)};
    for (ChainSpec& chain : scene.chains) chain.bodies.damping.clear();
    scene.chains[0].name = "a", scene.chains[1].name = "b";
    scene.forces.gravity = {{0, 1, -2}};
    return scene;
}
RandomJoints const every_kind[] = {RandomJoints::revolute,    RandomJoints::spherical,
                                   RandomJoints::universal,   RandomJoints::prismatic,
                                   RandomJoints::helical,     RandomJoints::mixed,
                                   RandomJoints::cylindrical, RandomJoints::planar3};

/// Links of a plane, folded back upon themselves at their middle: what falls speeds up as it gets
/// short.
Scene whip(int links) {
    std::string text = "units: si\nchains:\n  - base: fixed\n    bodies:\n";
    for (int k = 0; k < links; ++k)
        text +=
            "      - {mass: 0.1, com: [0.05, 0, 0], inertia: [1e-5, 1e-4, 1e-4], joint: {type: "
            "revolute, axis: [0, 1, 0], translation: [" +
            std::string(k == 0 ? "0" : "0.1") + ", 0, 0], q: " +
            std::string(k == 0           ? "0"
                        : k == links / 2 ? "3"
                                         : "0.02") +
            "}}\n";
    return parse_scene(text + "forces: {gravity: [0, 0, -9.81]}\n", "whip.yaml");
}

TEST(DormandPrince, IsOfFifthOrder) {
    for (std::string const joint : {"revolute", "spherical", "universal", "prismatic", "helical",
                                    "mixed", "cylindrical", "planar3"})
        for (std::string const base : {"fixed", "free"}) {
            if (joint == "prismatic" && base == "fixed")
                continue;  // slides in a constant field: without error
            Scene const scene =
                parse_scene("units: si\nforces: {gravity: [0, 1, -2]}\nchains: [{base: " + base +
                                ", generator: {random: {bodies: 3, joint: " + joint +
                                ", seed: 1, loads: false}}}]\n",
                            "moving.yaml");
            auto const end = [&](int steps) {
                return end_of(scene, Integrator::dormand_prince, 0, 0.8, steps);
            };
            Ended const exact = end(1280);
            // Bodies that glide go fast, so that the order shows at shorter steps.
            int const steps = joint == "cylindrical" || joint == "planar3" ? 40 : 20;
            EXPECT_NEAR(std::log2(distance(end(steps), exact) / distance(end(2 * steps), exact)),
                        5.0, 0.2)
                << joint << ' ' << base;
        }
}

/// The difference of the orders, C h^5, is kept to the tolerance, and the fifth goes on, whose
/// errors add up to h^5. C is another one on every path of steps: the slope over five decades is
/// that of many scenes.
TEST(Adaptive, ErrorsAreInProportionToTheTolerance) {
    double sum = 0;
    int scenes = 0;
    for (RandomJoints const joints : every_kind)
        for (Base const base : {Base::fixed, Base::free}) {
            double constexpr time = 0.4;
            Scene const scene = swinging(joints, base);
            Ended const exact = end_of(scene, Integrator::dormand_prince, 1e-13, time, 1);
            auto const error = [&](double tolerance) {
                return distance(end_of(scene, Integrator::dormand_prince, tolerance, time, 1),
                                exact);
            };
            double const wide = error(1e-6), narrow = error(1e-11),
                         slope = std::log10(wide / narrow) / 5;
            // Errors of bodies that glide add up over their ways.
            EXPECT_LE(wide, joints == RandomJoints::planar3 ? 4e-6 : 1e-6)
                << static_cast<int>(joints) << ' ' << static_cast<int>(base);
            EXPECT_NEAR(slope, 1.0, 0.25)
                << static_cast<int>(joints) << ' ' << static_cast<int>(base);
            sum += slope, ++scenes;
        }
    RecordProperty("slope", std::to_string(sum / scenes));
    EXPECT_NEAR(sum / scenes, 1.0, 0.1);
}

TEST(Adaptive, TakesFarFewerEvaluationsThanStepsOfOneLengthWhereAWhipCracks) {
    Scene const scene = whip(8);
    double constexpr time = 1;
    Ended const exact = end_of(scene, Integrator::dormand_prince, 1e-12, time, 1);
    Ended const adaptive = end_of(scene, Integrator::dormand_prince, 1e-6, time, 1);
    double const error = distance(adaptive, exact);
    int steps = 64;
    auto const error_of_rk4 = [&] {
        try {
            return distance(end_of(scene, Integrator::rk4, 0, time, steps), exact);
        } catch (ComputationError const&) {  // steps so wide that the state is lost
            return HUGE_VAL;
        }
    };
    while (steps < (1 << 16) && !(error_of_rk4() <= error)) steps *= 2;
    RecordProperty("error", std::to_string(error));
    RecordProperty("evaluations", std::to_string(adaptive.evaluations));
    RecordProperty("evaluations_of_rk4", std::to_string(4 * steps));
    EXPECT_GT(4 * steps / 2, 3 * adaptive.evaluations) << error;  // half of the steps were too few
    EXPECT_GT(adaptive.inner.at("longest").get<double>(),
              10 * adaptive.inner.at("shortest").get<double>());
}

TEST(Adaptive, RejectedStepsLeaveNoTrace) {
    for (RandomJoints const joints : every_kind)
        for (Base const base : {Base::fixed, Base::free}) {
            auto const after = [&](bool rejected) {
                auto const communicator = serial_communicator();
                Scene const scene = swinging(joints, base);
                ChainSystem system(scene, Axes::joint, *communicator);
                system.solve_joint_groups();
                for (JointDynamics* const group : system.joint())
                    group->apply({JointOperator::save}, 0);
                auto const step = [&](InnerStep const& s) {
                    for (int stage = 0; stage < EmbeddedStage::stages; ++stage) {
                        for (JointDynamics* const group : system.joint())
                            group->apply(embedded_stage(stage, s));
                        system.solve_joint_groups();
                    }
                };
                if (rejected) {
                    step({0, 0.3, 0.3, false});
                    step({0, 0.1, 0.1, true});
                }
                step({0, 0.01, 0.01, rejected});
                auto arrays = system.state();
                for (JointDynamics* const group : system.joint())
                    arrays["error"].push_back(group->embedded_error(embedded_difference(0.01),
                                                                    {1e-6, 1e-6, {1e-6, 1e-6}}));
                return arrays;
            };
            EXPECT_EQ(after(true), after(false))
                << static_cast<int>(joints) << ' ' << static_cast<int>(base);
        }
}

/// The same times are hit whatever the steps in between: what is driven is where its course says,
/// and all else as far as the tolerance goes.
TEST(Adaptive, EndsAtTheTimesOfTheSteps) {
    Scene scene = swinging(RandomJoints::revolute, Base::fixed);
    scene.chains[0].bodies.driven = {
        DrivenJoint{2, {PrescribedMotion{0.3, 2.5, 0.4, 3, 0.2}, PrescribedMotion{}}}};
    scene.dynamics = {
        .given = true, .integrator = Integrator::dormand_prince, .step = 0.1, .tolerance = 1e-9};
    auto const communicator = serial_communicator();
    ChainSystem system(scene, Axes::joint, *communicator);
    auto const stepper = make_stepper(system, scene.dynamics);
    for (int n = 0; n < 20; ++n) {
        stepper->prepare(nullptr);
        stepper->step(n, nullptr);
        double const expected =
            scene::value_at(scene.chains[0].bodies.driven[0].course[0], n * 0.1 + 0.1);
        EXPECT_EQ(system.state().at("q")[4 * 2], expected) << n;
    }
    EXPECT_GT(stepper->inner_steps().at("taken").get<int>(), 20);
    Ended const many = end_of(scene, Integrator::dormand_prince, 1e-9, 2, 20),
                few = end_of(scene, Integrator::dormand_prince, 1e-9, 2, 1);
    EXPECT_LE(distance(many, few), 1e-6);
    EXPECT_GT(distance(many, few), 0);
}

/// Rounding is no error that shorter steps could make smaller.
TEST(Adaptive, WhatHangsAtRestTakesOneStepAStep) {
    Scene const scene = parse_scene(
        "units: si\nchains: [{generator: {pendulum: {links: 30}}}]\nforces: {gravity: [9.81, 0, "
        "0]}\n",
        "rest.yaml");
    Ended const end = end_of(scene, Integrator::dormand_prince, 1e-12, 0.1, 100);
    EXPECT_EQ(end.inner.at("taken"), 100);
    EXPECT_EQ(end.inner.at("rejected"), 0);
}

/// Corrections follow every inner step.
TEST(Adaptive, ClosesJointedTips) {
    Scene const scene = parse_scene(R"(units: si
chains:
  - {name: a, base: fixed, tip: {joint: {type: spherical}}, generator: {random: {bodies: 8, joint: spherical, seed: 4}}}
  - {name: b, base: free, generator: {polygon: {bodies: 7, joint: revolute, spin: [1, 2, 3]}}, tip: {ring: {type: revolute, axis: [0, 0, 1], translation: [1, 0, 0]}}}
forces: {gravity: [0, 0, -5]}
)",
                                    "tips.yaml");
    Ended const exact = end_of(scene, Integrator::dormand_prince, 0, 1, 4000);
    double before = HUGE_VAL;
    for (double const tolerance : {1e-6, 1e-8, 1e-10}) {
        Ended const end = end_of(scene, Integrator::dormand_prince, tolerance, 1, 1);
        EXPECT_LE(end.open, 1e-10) << tolerance;
        double const error = distance(end, exact);
        EXPECT_LE(error, 1000 * tolerance);
        EXPECT_LT(error, before / 20) << tolerance;
        before = error;
    }
}

TEST(Adaptive, EndsInOneLineWhereNoStepIsShortEnough) {
    auto const line = [](char const* stiffness, double tolerance) {
        Scene const scene =
            parse_scene(std::string("units: si\nchains: [{base: fixed, bodies: [{mass: 1, com: "
                                    "[0.1, 0, 0], inertia: [1, 1, 1], joint: {type: "
                                    "revolute, axis: [0, 1, 0], q: 1, stiffness: ") +
                            stiffness + "}}]}]\n",
                        "stiff.yaml");
        return message_of([&] { end_of(scene, Integrator::dormand_prince, tolerance, 1, 1); });
    };
    EXPECT_TRUE(line("1e40", 1e-8)
                    .starts_with("the inner step cannot be shortened further for "
                                 "dynamics.tolerance 1e-08 at time 0 ("))
        << line("1e40", 1e-8);
    EXPECT_TRUE(line("1e16", 1e-8)
                    .starts_with(
                        "100,000 inner steps are not enough for dynamics.tolerance 1e-08 at time "))
        << line("1e16", 1e-8);
    EXPECT_EQ(line("1e4", 1e-8), "nothing was thrown");
}

TEST(StepControl, GoesTheRestInEqualStepsAndRemembersWhatItProposed) {
    StepControl control(1.0);
    EXPECT_EQ(control.length(1.0), 1.0);
    EXPECT_FALSE(control.accepts(1.0, 1e30));  // a fifth is the least
    EXPECT_DOUBLE_EQ(control.length(1.0), 0.2);
    EXPECT_DOUBLE_EQ(control.length(0.5), 0.5 / 3);
    EXPECT_EQ(control.length(0.201), 0.201);
    EXPECT_TRUE(control.accepts(0.2, 1e-9));  // none longer right after a rejection
    EXPECT_DOUBLE_EQ(control.state().length, 0.2);
    EXPECT_TRUE(control.accepts(0.01, 1e-9));  // the end of the way
    EXPECT_DOUBLE_EQ(control.state().length, 0.2);
    EXPECT_TRUE(control.accepts(0.2, 0.0));
    EXPECT_DOUBLE_EQ(control.state().length, 1.0);
    EXPECT_TRUE(control.accepts(1.0, 0.0));  // no longer than the whole
    EXPECT_DOUBLE_EQ(control.state().length, 1.0);
    EXPECT_FALSE(control.accepts(1.0, std::nan("")));
    EXPECT_DOUBLE_EQ(control.state().length, 0.2);
    EXPECT_EQ(control.counts().taken, 4);
    EXPECT_EQ(control.counts().rejected, 2);
    EXPECT_EQ(control.counts().shortest, 0.01);
    EXPECT_EQ(control.counts().longest, 1.0);
}

}  // namespace
}  // namespace catena::test
