// Orders that are known, a drift that is there, and forces that are the reference's own.
#include "report/integrator_errors.hpp"

#include <gtest/gtest.h>

namespace catena::test {
namespace {

std::unique_ptr<Communicator> const alone = serial_communicator();

Scene swinging(std::string const& joint, std::string const& more = "") {
    return parse_scene("units: si\nchains: [{name: a, base: fixed, generator: {random: {bodies: 4, joint: " + joint + ", seed: 4" +
                           (joint == "link" ? "" : ", loads: false") + "}}}]\nforces: {gravity: [0, -3, -5]}\n" + more,
                       "scene.yaml", {});
}

TEST(IntegratorErrors, EveryIntegratorHasItsOrder) {
    for (auto const& [joint, curves] : {std::pair{"revolute", 2U}, {"spherical", 4U}, {"link", 2U}}) {
        IntegratorStudy const study = study_integrator_errors(swinging(joint), *alone, 0.25, 8, 1);
        ASSERT_EQ(study.curves.size(), curves) << joint;
        EXPECT_TRUE(study.valid()) << joint;
        for (IntegratorCurve const& curve : study.curves) {
            ASSERT_TRUE(curve.slope) << joint << " " << curve.name;
            EXPECT_NEAR(*curve.slope, curve.order, 0.1) << joint << " " << curve.name;
            for (std::size_t i = 1; i < curve.points.size(); ++i)
                EXPECT_LT(*curve.points[i].energy_error, *curve.points[i - 1].energy_error) << joint << " " << curve.name;
        }
    }
}

TEST(IntegratorErrors, AnotherOrderThanPromisedIsInvalid) {
    IntegratorCurve curve{"rattle", 2, {}, 1.85};
    EXPECT_FALSE(curve.as_promised());
    curve.slope = 1.95;
    EXPECT_TRUE(curve.as_promised());
    curve.slope = std::nullopt;
    EXPECT_FALSE(curve.as_promised());
    curve.exact = true;
    EXPECT_TRUE(curve.as_promised());
}

/// Steps that are too wide for a reference to converge, or even to come to an end.
TEST(IntegratorErrors, AReferenceThatDoesNotConvergeIsInvalid) {
    for (double const time : {5.0, 40.0}) {
        IntegratorStudy const study = study_integrator_errors(swinging("revolute"), *alone, time, 6, 1);
        EXPECT_GT(study.reference_error, 1e-3) << time;
        EXPECT_FALSE(study.valid()) << time;
        for (IntegratorCurve const& curve : study.curves) EXPECT_FALSE(curve.as_promised()) << curve.name;
    }
}

/// Beads that fly apart freely on no link: every scheme is exact.
TEST(IntegratorErrors, WhatHasNoErrorNeedsNoOrder) {
    Scene const scene = parse_scene("units: si\nchains: [{name: a, base: free, generator: {random: {bodies: 1, joint: link, seed: 2}}}]\n",
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
        for (IntegratorPoint const& point : curve.points) EXPECT_FALSE(point.energy_error) << curve.name;
    EXPECT_TRUE(study.valid());  // the order is that of the positions
}

TEST(IntegratorErrors, ScenesThatLoseEnergyAreNotCompared) {
    Scene scene = swinging("spherical");
    EXPECT_EQ(why_integrators_cannot_be_compared(scene), "");
    scene.forces.linear_drag = 1;
    EXPECT_EQ(why_integrators_cannot_be_compared(scene), "its drag changes with velocities");
}

/// RATTLE's energy stays about a constant; the classical Runge-Kutta scheme at a wide step loses some all the time.
TEST(Drift, IsFoundWhereThereIsOneAndNotElsewhere) {
    DriftStudy const kept = study_drift(swinging("link"), *alone, Integrator::rattle, 0.002, 20000);
    EXPECT_TRUE(kept.valid()) << kept.slope << " +- " << kept.slope_error;
    EXPECT_LT(std::abs(kept.slope) * 40, 0.01 * kept.kinetic_energy);
    DriftStudy const lost = study_drift(swinging("spherical"), *alone, Integrator::rk4, 0.05, 20000);
    EXPECT_LT(lost.slope, 0);  // the classical scheme dissipates
    EXPECT_FALSE(lost.valid()) << lost.slope << " +- " << lost.slope_error;
}

}  // namespace
}  // namespace catena::test
