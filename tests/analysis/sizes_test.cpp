// Sizes of single conformations, and fits to chains whose statistics are known.
#include <gtest/gtest.h>

#include <cmath>

#include "analysis/chain_size.hpp"
#include "analysis/displacement.hpp"
#include "analysis/even_frames.hpp"
#include "analysis/fits.hpp"
#include "tests/analysis/sample_trajectory.hpp"

namespace catena::analysis {
namespace {

Kind kind_of(std::int64_t sites, std::size_t copies, bool ring = false) {
    Kind kind{"chain", sites, ring, {}};
    for (std::size_t c = 0; c < copies; ++c) kind.chains.push_back(c);
    return kind;
}

/// Internal means of chains that are drawn anew in every frame.
InternalMeans means_of(std::int64_t sites, std::size_t copies, std::int64_t frames, double cosine) {
    test::RandomChains draw(5);
    InternalMeans means(kind_of(sites, copies), frames);
    for (std::int64_t f = 0; f < frames; ++f) {
        for (std::size_t c = 0; c < copies; ++c)
            means.add(c, draw.chain(static_cast<std::size_t>(sites), 0.38, cosine));
        means.end_frame();
    }
    return means;
}

TEST(Sizes, ARodHasItsRadiusAndAsphericityOne) {
    std::vector<Vec3> x;
    for (int k = 0; k < 11; ++k) x.push_back({{3 + 0.4 * k, -2 + 0.3 * k, 7.0}});
    Gyration const found = gyration_of(x, std::vector<double>(11, 2.5));
    EXPECT_NEAR(found.radius(), 0.5 * std::sqrt((11.0 * 11 - 1) / 12), 1e-14);
    EXPECT_NEAR(found.asphericity(), 1, 1e-13);
    EXPECT_NEAR(norm(found.centre - x[5]), 0, 1e-13);
}

TEST(Sizes, ACrossIsAPlaneAndAnOctahedronASphere) {
    std::vector<Vec3> const flat{{{1, 0, 0}}, {{-1, 0, 0}}, {{0, 1, 0}}, {{0, -1, 0}}};
    EXPECT_NEAR(gyration_of(flat, std::vector<double>(4, 1)).asphericity(), 0.25, 1e-15);
    std::vector<Vec3> round = flat;
    round.push_back({{0, 0, 1}});
    round.push_back({{0, 0, -1}});
    EXPECT_NEAR(gyration_of(round, std::vector<double>(6, 1)).asphericity(), 0, 1e-15);
}

TEST(Sizes, MassesWeigh) {
    std::vector<Vec3> const x{{{0, 0, 0}}, {{1, 0, 0}}};
    Gyration const found = gyration_of(x, std::vector<double>{3, 1});
    EXPECT_NEAR(found.centre[0], 0.25, 1e-15);
    EXPECT_NEAR(found.radius(), std::sqrt(3.0) / 4, 1e-15);
}

TEST(Fits, ARodScalesWithExponentOneAndIsStraight) {
    InternalMeans means(kind_of(40, 1), 1);
    std::vector<Vec3> x;
    for (int k = 0; k < 40; ++k) x.push_back({{0.38 * k, 0, 0}});
    means.add(0, x);
    means.end_frame();
    Scaling const nu = fit_scaling(means.separations(), means.squared_distances(), {6, 20});
    EXPECT_NEAR(nu.exponent.value.mean, 1, 1e-13);
    EXPECT_NEAR(nu.prefactor, 0.38, 1e-13);
    EXPECT_EQ(nu.exponent.range.least, 6);
    EXPECT_EQ(nu.exponent.range.most, 20);
    EXPECT_EQ(fit_persistence(means.bond_separations(), means.cosines(), 0.38).why,
              "the chain is straight");
}

TEST(Fits, AnIdealChainHasExponentOneHalfAndNoPersistence) {
    InternalMeans const means = means_of(100, 8, 300, 0);
    Estimate const square = means.squared_distances().at(49);
    EXPECT_LT(std::abs(square.mean - 50 * 0.38 * 0.38), 4 * square.error);
    EXPECT_LT(square.error, 0.03 * square.mean);
    Fitted const nu = fit_scaling(means.separations(), means.squared_distances(), {6, 50}).exponent;
    EXPECT_LT(std::abs(nu.value.mean - 0.5), 4 * nu.value.error);
    EXPECT_LT(nu.value.error, 0.01);
    EXPECT_NEAR(nu.value.between / nu.value.error, 1, 0.8);  // scatter of 8 copies
    EXPECT_NE(fit_persistence(means.bond_separations(), means.cosines(), 0.38).why, "");
}

TEST(Fits, AFreelyRotatingChainHasThePersistenceLengthOfItsAngle) {
    InternalMeans const means = means_of(60, 4, 400, 0.9);
    double const right = -0.38 / std::log(0.9);
    EXPECT_NEAR(means.bond_length().at(0).mean, 0.38, 1e-12);
    EXPECT_NEAR(means.cosines().at(0).mean, 0.9, 1e-12);
    Fitted const found = fit_persistence(means.bond_separations(), means.cosines(), 0.38);
    EXPECT_LT(std::abs(found.value.mean - right), 4 * found.value.error);
    EXPECT_LT(found.value.error, 0.02 * right);
    EXPECT_GE(found.range.most, 9);
}

TEST(Fits, ErrorsOfTheExponentCoverItsScatter) {
    std::vector<double> values;
    double error = 0;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        test::RandomChains draw(seed);
        InternalMeans means(kind_of(50, 1), 64);
        for (int f = 0; f < 64; ++f) {
            means.add(0, draw.chain(50, 1, 0));
            means.end_frame();
        }
        Estimate const nu =
            fit_scaling(means.separations(), means.squared_distances(), {3, 25}).exponent.value;
        values.push_back(nu.mean);
        error += nu.error / 24;
    }
    double const scatter = error_between(values) * std::sqrt(24.0);
    EXPECT_NEAR(error / scatter, 1, 0.45);
}

TEST(Sizes, ARingCountsTheShorterWay) {
    std::vector<Vec3> x;
    for (int k = 0; k < 12; ++k) x.push_back({{std::cos(k * M_PI / 6), std::sin(k * M_PI / 6), 0}});
    InternalMeans means(kind_of(12, 1, true), 1);
    means.add(0, x);
    means.end_frame();
    ASSERT_EQ(means.separations().size(), 6U);
    EXPECT_NEAR(means.squared_distances().at(5).mean, 4, 1e-12);  // across
    EXPECT_NEAR(means.cosines().at(2).mean, 0, 1e-12);            // a quarter turn
    EXPECT_NEAR(means.cosines().at(5).mean, -1, 1e-12);
}

TEST(Displacement, ARandomWalkHasItsDiffusionConstant) {
    std::size_t const copies = 6, frames = 4000;
    double const step = 0.2, interval = 5;
    test::RandomChains draw(3);
    std::vector<Vec3> x(copies, Vec3::zero());
    for (std::size_t k = copies; k < copies * frames; ++k)
        x.push_back(plus_scaled(x[k - copies], step, draw.gaussian()));
    Displacements const found = displacements_of(x, copies, interval);
    EXPECT_NEAR(found.square[0].mean / (3 * step * step), 1, 0.02);
    EXPECT_DOUBLE_EQ(found.lag[9], 10 * interval);
    Fitted const& d = found.diffusion;
    double const right = step * step / (2 * interval);
    EXPECT_LT(std::abs(d.value.mean - right), 4 * std::max(d.value.error, d.value.between));
    EXPECT_LT(d.value.between, 0.25 * right);
    EXPECT_NEAR(d.range.least, 0.05 * 3999 * interval, 0.05 * d.range.least);
}

TEST(Displacement, SteadyMotionIsBallistic) {
    std::vector<Vec3> x;
    for (int f = 0; f < 100; ++f) x.push_back({{1e3 + 2.0 * f, 0, 0}});
    Displacements const found = displacements_of(x, 1, 0.5);
    for (std::size_t k = 0; k < found.lag.size(); ++k)
        EXPECT_NEAR(found.square[k].mean, 16 * found.lag[k] * found.lag[k], 1e-9);
}

TEST(EvenFrames, TheLastStateOfARunIsLeftOut) {
    std::vector<std::int64_t> const steps{0, 100, 200, 250};
    EvenFrames const found = even_frames(steps);
    EXPECT_EQ(found.frames, (std::vector<std::size_t>{0, 1, 2}));
    EXPECT_EQ(found.between, 1U);
    EXPECT_EQ(found.after, 0U);
}

TEST(EvenFrames, FinerFramesKeepTheirMultiplesAndAGapEndsThem) {
    std::vector<std::int64_t> const steps{100, 200, 250, 300, 350, 400, 600, 700};
    EvenFrames const found = even_frames(steps);
    EXPECT_EQ(found.frames, (std::vector<std::size_t>{0, 1, 3, 5}));
    EXPECT_EQ(found.between, 2U);
    EXPECT_EQ(found.after, 2U);
    EXPECT_EQ(even_frames(std::vector<std::int64_t>{7}).frames.size(), 1U);
}

TEST(Estimates, LongTrajectoriesKeepAtMost256BlocksAndAllFrames) {
    std::int64_t const frames = 1000;
    CurveMeans means(2, 2, frames);
    for (std::int64_t f = 0; f < frames; ++f) {
        double const value = static_cast<double>(f);
        means.add(0, std::vector<double>{value, 1});
        means.add(1, std::vector<double>{value, 3});
        means.end_frame();
    }
    EXPECT_NEAR(means.at(0).mean, 499.5, 1e-9);
    EXPECT_NEAR(means.blocks().means()[0], 499.5, 1e-9);
    EXPECT_EQ(means.blocks().series(0).size(), 250U);
    EXPECT_NEAR(means.at(1).mean, 2, 1e-12);
    EXPECT_NEAR(means.at(1).between, 1, 1e-12);
    EXPECT_NEAR(means.at(1).error, 0, 1e-12);
}

TEST(Estimates, SpacedNumbersAreAllAtFirst) {
    std::vector<std::int64_t> const numbers = spaced_numbers(100000);
    EXPECT_EQ(numbers[127], 128);
    EXPECT_EQ(numbers[143], 256);
    EXPECT_LT(numbers.size(), 300U);
    EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
    EXPECT_LE(numbers.back(), 100000);
    EXPECT_TRUE(spaced_numbers(0).empty());
}

}  // namespace
}  // namespace catena::analysis
