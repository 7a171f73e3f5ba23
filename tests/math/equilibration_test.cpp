#include "math/equilibration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace catena {
namespace {

/// White noise of variance 1 around 5, after a start that decays from `start` within `time`
/// samples.
std::vector<double> decaying(std::size_t samples, double start, double time) {
    std::mt19937_64 draw(7);
    std::normal_distribution<double> normal(5, 1);
    std::vector<double> series;
    for (std::size_t i = 0; i < samples; ++i)
        series.push_back(normal(draw) + start * std::exp(-static_cast<double>(i) / time));
    return series;
}

TEST(Equilibration, ADecayIsCutOffAndItsRestKept) {
    for (double const start : {30.0, -30.0}) {
        std::size_t const cut = equilibrated_from(decaying(2000, start, 50));
        EXPECT_GT(cut, 100U) << start;  // 30 exp(-2) is still four standard deviations
        EXPECT_LT(cut, 400U) << start;
    }
}

TEST(Equilibration, AStationarySeriesLosesLittle) {
    EXPECT_LT(equilibrated_from(decaying(2000, 0, 1)), 200U);
    EXPECT_EQ(equilibrated_from(std::vector<double>(100, 3.0)), 0U);
}

TEST(Equilibration, ASeriesThatDriftsToItsEndIsCutInTheMiddle) {
    std::vector<double> series;
    for (int i = 0; i < 1000; ++i) series.push_back(0.01 * i);
    EXPECT_EQ(equilibrated_from(series), 500U);
}

TEST(Equilibration, FewOrInfiniteSamplesAreNotCut) {
    EXPECT_EQ(equilibrated_from({}), 0U);
    EXPECT_EQ(equilibrated_from(decaying(fewest_for_equilibration - 1, 1000, 2)), 0U);
    EXPECT_GT(equilibrated_from(decaying(fewest_for_equilibration, 1000, 2)), 0U);
    std::vector<double> broken = decaying(100, 1000, 2);
    broken[50] = NAN;
    EXPECT_EQ(equilibrated_from(broken), 0U);
}

}  // namespace
}  // namespace catena
