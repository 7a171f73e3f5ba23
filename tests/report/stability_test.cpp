// Growth of roundings where it is known by hand, verdicts, and the cases themselves.
#include "report/stability.hpp"

#include <gtest/gtest.h>

#include "report/growth.hpp"
#include "report/solver_errors.hpp"

namespace catena::test {
namespace {

Scene scene_of(std::string const& text) { return parse_scene("units: si\n" + text, "scene.yaml", {}); }

Solution layout_of(Scene const& scene) {
    auto const communicator = serial_communicator();
    ChainSystem system(scene, Axes::joint, *communicator);
    system.evaluate();
    return solution_of(system);
}

/// Beads on an arc between two fixed points give way by its square: halving the angle four times loses 2^8.
TEST(Growth, OfABridgeGoesWithTheInverseSquareOfItsAngle) {
    auto const growth = [](std::string const& name) {
        for (StabilityCase const& each : stability_cases(16, false))
            if (each.family == "bridge of beads" && each.name == name)
                return exact_solution(each.scene(1), layout_of(each.scene(1)), 100, 3).growth;
        return 0.0;
    };
    EXPECT_GT(growth("1e-2"), 1e6);
    EXPECT_LT(growth("1e-2"), 1e9);
}

/// One body on a hinge, no gravity: q'' = torque / inertia, in which a relative change of either is that of q''.
TEST(Growth, OfOneBodyIsThatOfItsData) {
    Scene const scene = scene_of(
        "chains: [{name: a, base: fixed, bodies: [{mass: 1, inertia: [1, 1, 2], joint: {type: revolute, axis: [0, 0, 1], torque: 3}}]}]\n");
    ExactSolution const exact = exact_solution(scene, layout_of(scene), 100, 8);
    EXPECT_DOUBLE_EQ(exact.acceleration.at(0), 1.5);
    EXPECT_EQ(exact.by, "articulated bodies, 113 bits");
    EXPECT_GE(exact.growth, 1);
    EXPECT_LT(exact.growth, 4);  // torque, inertia, and the body's balance: once each, and the rounding of the nudged numbers
}

StabilityStudy study_of(double growth, double of_residual_bound, double of_bound, std::string const& refused = "") {
    StabilityStudy study;
    study.growth = growth;
    StabilityPoint point;
    point.of_residual_bound = of_residual_bound;
    point.of_bound = of_bound;
    point.refused = refused;
    study.points = {point};
    return study;
}

TEST(Stability, VerdictsSayWhichBoundHolds) {
    EXPECT_EQ(study_of(1e3, 0.5, 0.5).verdict(), Verdict::valid);
    EXPECT_EQ(study_of(1e3, 0.5, 1.5).verdict(), Verdict::invalid);
    EXPECT_EQ(study_of(1e3, 1.5, 0.5).verdict(), Verdict::invalid);
    EXPECT_EQ(study_of(1e3, 0.5, std::nan("")).verdict(), Verdict::invalid);
    EXPECT_EQ(study_of(1e3, 0, 0, "not positive definite").verdict(), Verdict::invalid);
    EXPECT_EQ(study_of(1e14, 0.5, 1.5).verdict(), Verdict::beyond);
    EXPECT_EQ(study_of(1e14, 0, 0, "not positive definite").verdict(), Verdict::beyond);
    EXPECT_EQ(study_of(1e14, 1.5, 0.5).verdict(), Verdict::invalid);  // no answer of any chain nearby
}

/// The same case, its answers spoilt by more than its bound, must not pass.
TEST(Stability, AnErrorAboveTheBoundIsInvalid) {
    StabilityCase const good = stability_cases(16, true).front();
    StabilityStudy const study = study_stability(good, {Backend::segments}, {Handles::projected}, 1);
    EXPECT_EQ(study.verdict(), Verdict::valid);
    double const spoilt = study.points[0].error + study.points[0].residual_bound * study.growth;
    EXPECT_EQ(study_of(study.growth, 0.5, spoilt / (study.points[0].residual_bound * study.growth)).verdict(), Verdict::invalid);
}

TEST(Stability, EveryFamilyHasItsHardestCase) {
    std::vector<StabilityCase> const quick = stability_cases(16, true), all = stability_cases(64, false);
    EXPECT_GT(all.size(), quick.size());
    for (char const* const family : {"coil", "dill", "masses, bodies on hinges", "masses, beads on links", "thin bodies, spherical joints",
                                     "straight", "folded", "bridge of beads", "spinning", "springs", "dampers", "units"})
        EXPECT_TRUE(std::any_of(quick.begin(), quick.end(), [&](StabilityCase const& c) { return c.family == family; })) << family;
    for (StabilityCase const& each : quick) EXPECT_EQ(each.scene(2).bodies(), each.bodies) << each.family;
}

}  // namespace
}  // namespace catena::test
