// Orders that are known, a drift that is there, and forces that are the reference's own.
#include "measure/integrator_errors.hpp"
#include "reader/load_scene.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace catena::test {
namespace {

std::unique_ptr<Communicator> const alone = serial_communicator();

Scene swinging(std::string const& joint, std::string const& more = "") {
    return parse_scene(
        "units: si\nchains: [{name: a, base: fixed, generator: {random: {bodies: 4, joint: " +
            joint + ", seed: 4" + (joint == "link" ? "" : ", loads: false") +
            "}}}]\nforces: {gravity: [0, -3, -5]}\n" + more,
        "scene.yaml", {});
}

TEST(IntegratorErrors, EveryIntegratorHasItsOrder) {
    for (auto const& [joint, curves] :
         {std::pair{"revolute", 3U}, {"spherical", 5U}, {"link", 2U}}) {
        IntegratorStudy const study = study_integrator_errors(swinging(joint), *alone, 0.25, 8, 1);
        ASSERT_EQ(study.curves.size(), curves) << joint;
        EXPECT_TRUE(study.valid()) << joint;
        EXPECT_FALSE(study.has_implicit());
        for (IntegratorCurve const& curve : study.curves) {
            if (curve.scheme == Scheme::adaptive) continue;
            ASSERT_TRUE(curve.slope) << joint << " " << curve.name;
            EXPECT_NEAR(*curve.slope, curve.order, 0.1) << joint << " " << curve.name;
            for (std::size_t i = 1; i < curve.points.size(); ++i)
                EXPECT_LT(*curve.points[i].energy_error, *curve.points[i - 1].energy_error)
                    << joint << " " << curve.name;
        }
    }
}

TEST(IntegratorErrors, AdaptiveErrorsFollowTheTolerance) {
    IntegratorStudy const study = study_integrator_errors(swinging("spherical"), *alone, 0.5, 8, 1);
    IntegratorCurve curve = study.curves.back();
    ASSERT_EQ(curve.scheme, Scheme::adaptive);
    EXPECT_TRUE(curve.as_promised());
    for (std::size_t i = 1; i < curve.points.size(); ++i) {
        EXPECT_NEAR(curve.points[i].tolerance, 0.1 * curve.points[i - 1].tolerance, 1e-12);
        EXPECT_GE(curve.points[i].taken, curve.points[i - 1].taken);
    }
    IntegratorPoint const &wide = curve.points[3], &narrow = curve.points.back();
    EXPECT_GT(narrow.taken, 2 * wide.taken);
    EXPECT_LT(narrow.error, 1e-2 * wide.error);
    EXPECT_DOUBLE_EQ(wide.allowed, wide.tolerance * static_cast<double>(wide.taken));
    curve.points.back().error = curve.points.front().error;  // as if the tolerance were not heeded
    EXPECT_FALSE(curve.as_promised());
}

/// A clamped rod that starts to bend in its slowest mode; its twist limits explicit steps to some
/// 2e-3 at a stiffness of 2.
Scene stiff(double stiffness) {
    std::string text = "units: si\nchains:\n  - name: a\n    base: fixed\n    bodies:\n";
    std::string const springs = fmt::format("[{0}, {0}, {0}]", stiffness);
    for (double const rate : {0.867, 0.568, 0.292, 0.083})
        text += fmt::format(
            "      - {{mass: 0.1, com: [0.05, 0, 0], inertia: [5e-6, 8.6e-5, 8.6e-5], joint: "
            "{{type: spherical, translation: [{}, 0, 0], "
            "stiffness: {}, qd: [0, {}, {}]}}}}\n",
            rate == 0.867 ? 0 : 0.1, springs, rate, -0.5 * rate);
    return parse_scene(text, "scene.yaml", {});
}

TEST(IntegratorErrors, ImplicitSpringsGoOnWhereExplicitOnesCannot) {
    IntegratorStudy const study = study_integrator_errors(stiff(2), *alone, 0.25, 7, 1, true);
    EXPECT_TRUE(study.has_implicit());
    EXPECT_TRUE(study.valid());
    ASSERT_EQ(study.curves.size(), 7U);
    for (IntegratorCurve const& curve : study.curves) {
        SCOPED_TRACE(curve.name);
        if (curve.scheme == Scheme::explicit_steps) {
            EXPECT_GT(curve.unstable_from(), 0);
        }
        if (curve.scheme != Scheme::implicit_springs) continue;
        EXPECT_EQ(curve.unstable_from(), 0);
        ASSERT_TRUE(curve.slope_beyond);
        EXPECT_NEAR(*curve.slope_beyond, 2, 0.1);
        IntegratorCurve wrong = curve;
        wrong.slope_beyond = 1.5;
        EXPECT_FALSE(wrong.as_promised());
        wrong.slow = false;  // some spring may vibrate too fast for the steps, and be heard
        EXPECT_TRUE(wrong.as_promised());
        wrong = curve;
        wrong.points.front().no_error = "unstable";
        EXPECT_FALSE(wrong.as_promised());
    }
}

/// No step of the study is short enough for explicit integrators, whose orders cannot be seen then.
TEST(IntegratorErrors, SpringsThatAreTooStiffForExplicitStepsAreNoFault) {
    IntegratorStudy const study = study_integrator_errors(stiff(100), *alone, 0.25, 5, 1);
    for (IntegratorCurve const& curve : study.curves)
        EXPECT_EQ(curve.too_stiff, curve.scheme == Scheme::explicit_steps) << curve.name;
}

TEST(IntegratorErrors, SpringsAlongSomeCoordinatesAloneAreNotTakenImplicitly) {
    Scene scene = stiff(2);
    scene.chains[0].bodies.stiffness[1][0] = 0;
    IntegratorStudy const study = study_integrator_errors(scene, *alone, 0.01, 4, 1);
    EXPECT_FALSE(study.has_implicit());
    EXPECT_EQ(study.no_implicit,
              "a joint has springs along only some of its coordinates, or its stiffnesses differ "
              "by ten decades");
}

/// Refinement changes roundings alone, and takes its time.
TEST(IntegratorErrors, RefinementIsHeeded) {
    IntegratorStudy const plain =
        study_integrator_errors(swinging("spherical"), *alone, 0.25, 6, 5);
    IntegratorStudy const refined =
        study_integrator_errors(swinging("spherical", "solver: {refine: 2}\n"), *alone, 0.25, 6, 5);
    EXPECT_EQ(plain.refine, 0);
    EXPECT_EQ(refined.refine, 2);
    for (std::size_t i = 0; i < plain.curves.size(); ++i) {
        EXPECT_NEAR(refined.curves[i].points[0].error, plain.curves[i].points[0].error, 1e-11)
            << plain.curves[i].name;
    }
}

TEST(IntegratorErrors, AnotherOrderThanPromisedIsInvalid) {
    IntegratorCurve curve;
    curve.order = 2;
    curve.slope = 1.85;
    EXPECT_FALSE(curve.as_promised());
    curve.slope = 1.95;
    EXPECT_TRUE(curve.as_promised());
    curve.points.resize(2);
    EXPECT_TRUE(curve.as_promised());
    curve.points.back().no_error = "did not finish";  // the finest step of all
    EXPECT_FALSE(curve.as_promised());
    curve.points.clear();
    curve.slope = std::nullopt;
    EXPECT_FALSE(curve.as_promised());
    curve.exact = true;
    EXPECT_TRUE(curve.as_promised());
}

/// Steps that are too wide for a reference to converge, or even to come to an end.
TEST(IntegratorErrors, AReferenceThatDoesNotConvergeIsInvalid) {
    for (double const time : {5.0, 40.0}) {
        IntegratorStudy const study =
            study_integrator_errors(swinging("revolute"), *alone, time, 6, 1);
        EXPECT_GT(study.reference_error, 1e-3) << time;
        EXPECT_FALSE(study.valid()) << time;
        for (IntegratorCurve const& curve : study.curves) {
            EXPECT_TRUE(curve.scheme == Scheme::adaptive || !curve.as_promised()) << curve.name;
        }
    }
}

/// Beads that fly apart freely on no link: every scheme is exact.
TEST(IntegratorErrors, WhatHasNoErrorNeedsNoOrder) {
    Scene const scene = parse_scene(
        "units: si\nchains: [{name: a, base: free, generator: {random: {bodies: 1, joint: link, "
        "seed: 2}}}]\n",
        "scene.yaml", {});
    IntegratorStudy const study = study_integrator_errors(scene, *alone, 1, 5, 1);
    ASSERT_FALSE(study.curves.empty());
    for (IntegratorCurve const& curve : study.curves) EXPECT_TRUE(curve.exact) << curve.name;
    EXPECT_TRUE(study.valid());
}

TEST(IntegratorErrors, WorkIsNoErrorOfTheEnergy) {
    Scene scene = swinging("revolute");
    EXPECT_TRUE(study_integrator_errors(scene, *alone, 0.25, 6, 1).no_energy_error.empty());
    scene.chains[0].bodies.torque.assign(4, Vec3{{0.1, 0, 0}});
    IntegratorStudy const study = study_integrator_errors(scene, *alone, 0.25, 8, 1);
    EXPECT_FALSE(study.no_energy_error.empty());
    for (IntegratorCurve const& curve : study.curves)
        for (IntegratorPoint const& point : curve.points)
            EXPECT_FALSE(point.energy_error) << curve.name;
    EXPECT_TRUE(study.valid());  // the order is that of the positions
}

TEST(IntegratorErrors, ScenesThatLoseEnergyAreNotCompared) {
    Scene scene = swinging("spherical");
    EXPECT_EQ(why_integrators_cannot_be_compared(scene), "");
    scene.forces.linear_drag = 1;
    EXPECT_EQ(why_integrators_cannot_be_compared(scene), "its drag changes with velocities");
}

/// RATTLE's energy stays about a constant; the classical Runge-Kutta scheme at a wide step loses
/// some all the time.
TEST(Drift, IsFoundWhereThereIsOneAndNotElsewhere) {
    DriftStudy const kept = study_drift(swinging("link"), *alone, Integrator::rattle, 0.002, 20000);
    EXPECT_TRUE(kept.valid()) << kept.slope << " +- " << kept.slope_error;
    EXPECT_LT(std::abs(kept.slope) * 40, 0.01 * kept.kinetic_energy);
    DriftStudy const lost =
        study_drift(swinging("spherical"), *alone, Integrator::rk4, 0.05, 20000);
    EXPECT_LT(lost.slope, 0);  // the classical scheme dissipates
    EXPECT_FALSE(lost.valid()) << lost.slope << " +- " << lost.slope_error;
}

}  // namespace
}  // namespace catena::test
