// Growth of roundings where it is known by hand, verdicts, and the cases themselves.
#include "measure/stability.hpp"

#include <gtest/gtest.h>

#include "measure/growth.hpp"
#include "measure/solver_errors.hpp"
#include "reader/load_scene.hpp"

namespace catena::test {
namespace {

Scene scene_of(std::string const& text) {
    return parse_scene("units: si\n" + text, "scene.yaml", {});
}

/// Beads on an arc between two fixed points give way by its square: a thousandth of the angle loses
/// a million times as much.
TEST(Growth, OfABridgeGoesWithTheInverseSquareOfItsAngle) {
    Solution of_beads;  // without a solution: there is none where the arc is flat
    for (std::int64_t i = 0; i <= 1000; ++i) of_beads.acceleration_offset.push_back(3 * i);
    auto const growth = [&](std::string const& name) {
        for (StabilityCase const& each : stability_cases(16, false))
            if (each.family == "bridge of beads" && each.name == name)
                return exact_solution(each.scene(1), of_beads, 100, 3).growth;
        return 0.0;
    };
    double const wide = growth("1e-2"), narrow = growth("1e-5");
    EXPECT_GT(wide, 1);
    EXPECT_NEAR(std::log10(narrow / wide), 6, 1);
}

/// One body on a revolute joint, no gravity: q'' = torque / inertia, in which a relative change of
/// either is that of q''.
TEST(Growth, OfOneBodyIsThatOfItsData) {
    Scene const scene = scene_of(
        "chains: [{name: a, base: fixed, bodies: [{mass: 1, inertia: [1, 1, 2], joint: {type: "
        "revolute, axis: [0, 0, 1], torque: 3}}]}]\n");
    ExactSolution const exact = exact_solution(scene, layout_of(scene), 100, 8);
    EXPECT_DOUBLE_EQ(exact.acceleration.at(0), 1.5);
    EXPECT_EQ(exact.by, "articulated bodies, 113 bits");
    EXPECT_GE(exact.growth, 1);
    EXPECT_LT(exact.growth, 4);  // torque, inertia, and the body's balance: once each, and the
                                 // rounding of the nudged numbers
}

StabilityStudy study_of(double growth, double of_residual_bound, double of_bound,
                        std::string const& refused = "") {
    StabilityStudy study;
    study.growth = growth;
    StabilityPoint point;
    point.residual_bound = 1e-14;
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
    EXPECT_EQ(study_of(1e14, 0.5, 1.5).verdict(), Verdict::lost);
    EXPECT_EQ(study_of(1e14, 0, 0, "not positive definite").verdict(), Verdict::lost);
    EXPECT_EQ(study_of(1e14, 1.5, 0.5).verdict(),
              Verdict::invalid);  // no answer of any chain nearby
}

TEST(Stability, WhatHoldsAfterRefinementAloneIsSaidSo) {
    StabilityStudy study = study_of(1e3, 1.5, 0.5);
    study.oracle_error = 1e-12;
    study.points[0].settled = StabilityPoint::Refined{1e-12, 0.5, 0.5, 1};
    EXPECT_EQ(study.verdict(), Verdict::refined);
    study.points[0].settled->of_bound = 1.5;
    EXPECT_EQ(study.verdict(), Verdict::invalid);
}

StabilityCase case_of(std::string const& family, std::string const& name) {
    for (StabilityCase const& each : stability_cases(256, false))
        if (each.family == family && each.name == name) return each;
    throw std::runtime_error("no such case: " + family + ", " + name);
}

/// Thin, tilted bodies lose more digits than the bounds allow; what holds them VALID is refinement
/// alone.
TEST(Stability, MeasuredErrorsAboveTheirBoundAreInvalid) {
    StabilityStudy study = study_stability(case_of("thin bodies, revolute joints", "1e8"),
                                           {Backend::segments}, {Handles::projected}, 1);
    ASSERT_GT(std::max(study.points.at(0).of_residual_bound, study.points[0].of_bound), 1);
    EXPECT_EQ(study.verdict(), Verdict::refined);
    study.points[0].settled.reset();
    EXPECT_EQ(study.verdict(), Verdict::invalid);
}

StabilityStudy study_beside(std::vector<StabilityPeer> peers, double error, double bound) {
    StabilityStudy study = study_of(1e3, 0.5, 0.5);
    study.points[0].error = error;
    study.points[0].residual_bound = bound / study.growth;
    study.oracle_error = 1e-12;
    study.peers = std::move(peers);
    return study;
}

/// Links are not refined: the growth counts.
TEST(Stability, WhatIsNotRefinedMayBeOffByTheGrowth) {
    StabilityStudy study = study_beside({{"a", 1e-13}, {"b", 1e-11}}, 3e-13, 1e-14);
    EXPECT_DOUBLE_EQ(study.best_of_others(), 1e-13);
    EXPECT_NEAR(study.against_peers(), 0.75, 1e-12);
    study.peers[0].why_not = "takes more than 20 s";  // then articulated bodies are the best
    EXPECT_NEAR(study.against_peers(), 3e-13 / 4e-12, 1e-12);
    study.points[0].error = std::nan("");
    EXPECT_EQ(study.verdict(), Verdict::invalid);
    EXPECT_EQ(study_beside({{"a", 1e-16}}, 3e-13, 1e-12).verdict(),
              Verdict::valid);  // below the bound
}

/// Both bounds hold, and yet others are closer by more than 4 times.
TEST(Stability, RefinedAnswersAreHeldToFourTimesTheBestOfOthers) {
    StabilityStudy study = study_beside({{"a", 1e-15}}, 1e-8, 1e-7);
    study.points[0].residual_bound = 1e-15;
    study.points[0].settled = StabilityPoint::Refined{2e-15, 0.5, 0.5, 1};
    EXPECT_NEAR(study.against_peers(), 0.5, 1e-12);
    EXPECT_EQ(study.verdict(), Verdict::valid);
    study.points[0].settled->error = 5e-15;
    EXPECT_EQ(study.verdict(), Verdict::invalid);
    study.peers[0].error = 2e-15;
    EXPECT_EQ(study.verdict(), Verdict::valid);
    study.peers.clear();  // articulated bodies: 1e-12
    EXPECT_NEAR(study.against_peers(), 5e-15 / 4e-12, 1e-12);
}

TEST(Stability, DigitsThatOthersKeepAreLost) {
    StabilityStudy study = study_beside({{"a", 1e-2}}, 1, 1e-12);
    study.growth = 1e14;
    EXPECT_EQ(study.verdict(), Verdict::lost);  // articulated bodies: 1e-12
    study.oracle_error = 1e-2;
    EXPECT_EQ(study.verdict(), Verdict::beyond);
    study.peers[0].error = 1e-4;
    EXPECT_EQ(study.verdict(), Verdict::lost);
    study.condition = 1e14;  // no equations in double determine three digits
    EXPECT_EQ(study.verdict(), Verdict::beyond);
}

/// A peer that knows the answer, one that has none, one that answers nonsense: of every seed.
TEST(Stability, PeersAreAskedAboutEverySeed) {
    StabilityCase const which = case_of("thin bodies, revolute joints", "1e8");
    int asked = 0;
    AskPeers const peers = [&](StabilityCase const& each, Scene const& scene) {
        EXPECT_EQ(each.name, which.name);
        ++asked;
        std::vector<double> const exact =
            exact_solution(scene, layout_of(scene), 100, 1).acceleration;
        std::vector<double> broken = exact;
        if (asked == 2) broken[5] = std::nan("");
        return std::vector<PeerAnswer>{{"exact", exact, ""},
                                       {"absent", {}, asked == 1 ? "no room" : ""},
                                       {"broken", broken, ""},
                                       {"short", {1, 2}, ""}};
    };
    StabilityStudy study =
        study_stability(which, {Backend::segments}, {Handles::projected}, 3, peers);
    EXPECT_EQ(asked, 3);
    ASSERT_EQ(study.peers.size(), 4U);
    EXPECT_EQ(study.peers[0].error, 0);
    EXPECT_EQ(study.peers[1].why_not, "no room");
    EXPECT_EQ(study.peers[2].why_not, "its answer is not finite");
    EXPECT_EQ(study.peers[3].why_not, "its answer has another length");
    EXPECT_EQ(study.best_of_others(), 0);
    EXPECT_LE(study.against_peers(), 1);
    EXPECT_EQ(study.verdict(), Verdict::refined);
}

/// Refinement that brings back all but a few digits is not what others have.
TEST(Stability, SpoiltAnswersAreInvalidBesideExactOnes) {
    StabilityStudy study =
        study_stability(case_of("masses, bodies on revolute joints", "alternating, 1e4"),
                        {Backend::segments}, {Handles::projected}, 1);
    EXPECT_EQ(study.verdict(), Verdict::valid);
    study.points[0].settled->error = study.points[0].error;  // as if refinement did nothing
    EXPECT_LE(study.points[0].of_bound, 1);
    EXPECT_EQ(study.verdict(), Verdict::invalid);
}

/// A case of no digits is ARTICULATED where these handles, refined, keep to what is allowed, and to
/// that alone.
TEST(Stability, WhatArticulatedHandlesKeepIsSaidSo) {
    StabilityStudy study = study_of(1e20, 0, 0, "not positive definite");
    study.oracle_error = 1e-14;
    StabilityPoint held;
    held.handles = "articulated";
    held.residual_bound = 1e-15;
    held.of_residual_bound = 2;
    held.error = 1e-12;
    held.settled = StabilityPoint::Refined{2e-14, 0.5, 0.5, 1};
    study.points.push_back(held);
    EXPECT_EQ(study.verdict(), Verdict::articulated);
    study.points[1].settled->error = 5e-14;
    EXPECT_EQ(study.verdict(), Verdict::lost);
    study.points[1].settled.reset();
    EXPECT_EQ(study.verdict(), Verdict::invalid);  // its residual is not within the bound
}

TEST(Stability, ArticulatedHandlesKeepADillsDigits) {
    std::vector<StabilityCase> const cases = coils_and_dills({1024});
    ASSERT_EQ(cases.size(), 2U);
    StabilityStudy const study = study_stability(cases[1], {Backend::segments},
                                                 {Handles::projected, Handles::articulated}, 1);
    EXPECT_EQ(study.verdict(), Verdict::articulated);
    EXPECT_GT(study.worst(&StabilityPoint::plain_error), 1e-3);
    EXPECT_LE(study.points.at(1).error,
              8 * study.oracle_error + 64 * 1024 * 0x1p-53);  // not refined
}

/// Nearly parallel revolute joints, light bodies between heavy ones, thin bodies: the equations of
/// joint forces lose digits there that articulated bodies keep.
TEST(Refinement, BringsBackWhatTheEquationsOfForcesLose) {
    for (auto const& [family, name] : {std::pair{"coil", "256 bodies"},
                                       {"dill", "64 bodies"},
                                       {"masses, bodies on revolute joints", "alternating, 1e8"},
                                       {"thin bodies, spherical joints", "1e8"},
                                       {"thin bodies, revolute joints", "1e6"}}) {
        StabilityStudy const study =
            study_stability(case_of(family, name), {Backend::segments}, {Handles::projected}, 1);
        StabilityPoint const& point = study.points.at(0);
        ASSERT_EQ(point.refined.size(), 2U);
        EXPECT_GT(point.error, 1e-10) << family;  // else there is nothing to bring back
        EXPECT_LT(point.refined[1].error, std::max(4 * study.oracle_error, 1e-13)) << family;
        EXPECT_LE(point.refined[1].of_residual_bound, 1) << family;
        EXPECT_EQ(study.verdict(), point.of_residual_bound > 1 ? Verdict::refined : Verdict::valid)
            << family;
    }
}

/// Tips, sliding joints, driven joints and planar chains have biases and directions of their own.
TEST(Refinement, KeepsToTheEquationsOfEveryJoint) {
    for (char const* const chain :
         {"{name: a, base: fixed, tip: {joint: {type: spherical}}, generator: {random: {bodies: "
          "40, joint: mixed, seed: 2}}}",
          "{name: a, base: free, generator: {random: {bodies: 40, joint: helical, seed: 3}}}",
          "{name: a, base: fixed, generator: {random: {bodies: 40, joint: planar, seed: 4}}}",
          "{name: a, base: fixed, bodies: [{mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], joint: "
          "{type: revolute, axis: [0, 1, 0], "
          "motion: "
          "{amplitude: 0.5, frequency: 2}}}, {mass: 1, com: [0.1, 0, 0], inertia: [1, 1, 1], "
          "joint: {type: spherical, translation: [0.2, "
          "0, 0]}}]}"}) {
        Scene scene =
            scene_of("chains: [" + std::string(chain) + "]\nforces: {gravity: [0, -3, -5]}\n");
        auto const communicator = serial_communicator();
        ExactSolution const exact = exact_solution(scene, layout_of(scene), 100, 3);
        ChainSystem system(scene, Axes::joint, *communicator);
        system.evaluate();
        for (int steps = 0; steps < 3; ++steps) {
            double const bound = system.residual_bound();
            EXPECT_LE(system.residual(), bound) << chain << " " << steps;
            EXPECT_LE(largest_difference(scene, solution_of(system), exact.acceleration),
                      bound * exact.growth)
                << chain << " " << steps;
            system.refine();
        }
    }
}

TEST(Stability, EveryFamilyHasItsHardestCase) {
    std::vector<StabilityCase> const quick = stability_cases(16, true),
                                     all = stability_cases(64, false);
    EXPECT_GT(all.size(), quick.size());
    for (char const* const family :
         {"coil", "dill", "masses, bodies on revolute joints", "masses, beads on links",
          "masses, parallel revolute joints", "masses, torques in joints",
          "thin bodies, spherical joints", "straight", "folded", "bridge of beads", "spinning",
          "springs", "dampers", "units"})
        EXPECT_TRUE(std::any_of(quick.begin(), quick.end(), [&](StabilityCase const& c) {
            return c.family == family;
        })) << family;
    for (StabilityCase const& each : quick)
        EXPECT_EQ(each.scene(2).bodies(), each.bodies) << each.family;
}

}  // namespace
}  // namespace catena::test
