// How far particles act on each other, found from forces' energies and parameters.
#include "systems/force_ranges.hpp"

#include <gtest/gtest.h>

#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace catena::testing {
namespace {

std::unique_ptr<OpenMM::CustomNonbondedForce> custom(std::string const& energy, double cutoff,
                                                     std::initializer_list<double> q) {
    auto force = std::make_unique<OpenMM::CustomNonbondedForce>(energy);
    force->addPerParticleParameter("q");
    force->setNonbondedMethod(OpenMM::CustomNonbondedForce::CutoffNonPeriodic);
    force->setCutoffDistance(cutoff);
    for (double const each : q) force->addParticle({each});
    return force;
}

std::vector<PairRange> ranges_of(std::vector<std::unique_ptr<OpenMM::Force>> forces,
                                 std::vector<std::int64_t> const& bead) {
    OpenMM::System system;
    for (std::size_t p = 0; p < bead.size(); ++p) system.addParticle(1);
    for (auto& force : forces) system.addForce(force.release());
    return pair_ranges(system, bead);
}

template <class... Force>
std::vector<PairRange> ranges(std::unique_ptr<Force>... force) {
    std::vector<std::unique_ptr<OpenMM::Force>> forces;
    (forces.push_back(std::move(force)), ...);
    return ranges_of(std::move(forces), {0, 1, 2});
}

std::vector<char> const all{};

TEST(PairRanges, ChargesInAProductReachFartherThanTheRest) {
    auto const found = ranges(custom("4*eps*q1; eps=0.8", 2, {1, 1, 1}),
                              custom("q1*q2*(exp(-r/l)/r-edge); l=0.9; edge=0.01", 4, {1, 0, -1}));
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].reach, 4);
    EXPECT_EQ(found[0].acts, (std::vector<char>{1, 0, 1}));
    EXPECT_EQ(found[1].reach, 2);
    EXPECT_EQ(found[1].acts, all);
    EXPECT_EQ(longest_reach(found), 4);
}

TEST(PairRanges, OfBeadsNotOfParticles) {
    std::vector<std::unique_ptr<OpenMM::Force>> forces;
    forces.push_back(custom("q1*q2/r", 3, {0, 5, 5}));
    auto const found = ranges_of(std::move(forces), {2, 0, 1});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].acts, (std::vector<char>{1, 1, 0}));
}

TEST(PairRanges, AParticleActsUnlessItsEnergyIsZeroWithEveryOther) {
    EXPECT_EQ(ranges(custom("(q1+q2)/r", 3, {0, 1, 1})).front().acts, all);
    EXPECT_EQ(ranges(custom("q1/r", 3, {0, 1, 1})).front().acts, all);  // as the second of a pair
    EXPECT_EQ(ranges(custom("select(step(r-1), q1*q2/r, 0)", 3, {0, 1, 1})).front().acts.size(),
              3u);
}

/// Lepton does not come to an end with such a number.
TEST(PairRanges, AParameterThatIsNoNumberActs) {
    double const none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(ranges(custom("q1*q2/r", 3, {0, none, 1})).front().acts,
              (std::vector<char>{0, 1, 1}));
}

TEST(PairRanges, OfAForceThatIsNotUnderstoodAllAct) {
    auto table = custom("q1*q2*f(r)", 3, {0, 1, 1});
    table->addTabulatedFunction("f", new OpenMM::Continuous1DFunction({0, 1, 0}, 0, 3));
    EXPECT_EQ(ranges(std::move(table)).front().acts, all);
}

TEST(PairRanges, ChargesAndWellsOfNonbondedForce) {
    auto force = std::make_unique<OpenMM::NonbondedForce>();
    force->setNonbondedMethod(OpenMM::NonbondedForce::CutoffNonPeriodic);
    force->setCutoffDistance(1);
    force->addParticle(1, 0.3, 0), force->addParticle(0, 0.3, 1), force->addParticle(0, 0.3, 0);
    auto const found = ranges(std::move(force));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].acts, (std::vector<char>{1, 1, 0}));
}

TEST(PairRanges, OffsetsMayChargeAnyParticle) {
    auto force = std::make_unique<OpenMM::NonbondedForce>();
    force->setNonbondedMethod(OpenMM::NonbondedForce::CutoffNonPeriodic);
    force->addGlobalParameter("scale", 1);
    for (int p = 0; p < 3; ++p) force->addParticle(0, 0.3, 0);
    force->addParticleParameterOffset("scale", 1, 0.5, 0, 0);
    EXPECT_EQ(ranges(std::move(force)).front().acts, all);
}

TEST(PairRanges, AForceWithoutAllParticlesIsRefused) {
    EXPECT_THROW(ranges(custom("q1*q2/r", 2, {1, 1}), custom("q1*q2/r", 2, {1, 1, 1})),
                 OpenMM::OpenMMException);
    EXPECT_THROW(ranges(custom("q1*q2/r", 2, {1, 1, 1, 1})), OpenMM::OpenMMException);
}

TEST(PairRanges, WhatALongerRangeHoldsIsLeftOut) {
    EXPECT_EQ(ranges(custom("1/r", 2, {1, 1, 1}), custom("1/r^2", 4, {1, 1, 1})).size(), 1u);
    EXPECT_EQ(ranges(custom("q1*q2/r", 4, {1, 0, 1}), custom("q1*q2/r", 2, {1, 0, 0})).size(), 1u);
    EXPECT_EQ(ranges(custom("q1*q2/r", 2, {1, 0, 1}), custom("q1*q2/r", 2, {0, 1, 0})).front().acts,
              all);  // both together
    EXPECT_TRUE(ranges(custom("q1*q2/r", 2, {0, 0, 0})).empty());
    EXPECT_TRUE(ranges(std::make_unique<OpenMM::HarmonicBondForce>()).empty());
}

}  // namespace
}  // namespace catena::testing
