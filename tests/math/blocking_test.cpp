#include "math/blocking.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace catena {
namespace {

/// x_i+1 = keep x_i + noise, stationary, of variance 1 around 5.
CopySeries autoregressive(int copies, int samples, double keep, std::uint64_t seed) {
    std::mt19937_64 draw(seed);
    std::normal_distribution<double> normal;
    CopySeries series(static_cast<std::size_t>(copies));
    for (auto& copy : series) {
        double x = normal(draw);
        for (int i = 0; i < samples; ++i) {
            copy.push_back(5 + x);
            x = keep * x + std::sqrt(1 - keep * keep) * normal(draw);
        }
    }
    return series;
}

TEST(Blocking, TheErrorOfACorrelatedSeriesIsThatOfItsCorrelationTime) {
    for (int const copies : {1, 4, 32}) {
        int const samples = 65536 / copies;
        for (double const keep : {0.0, 0.9, 0.98}) {
            double const right = std::sqrt((1 + keep) / (1 - keep) / 65536);
            Blocked const found = blocked_mean(autoregressive(copies, samples, keep, 7));
            EXPECT_TRUE(found.plateau) << copies << " " << keep;
            EXPECT_NEAR(found.error / right, 1, 0.2) << copies << " " << keep;
            EXPECT_LT(std::abs(found.mean - 5), 4 * right);
        }
    }
}

TEST(Blocking, ShortSeriesHaveErrorsThatCoverTheirMeans) {
    int constexpr series = 400;
    int beyond = 0;
    double squares = 0;
    for (int s = 0; s < series; ++s) {
        Blocked const found =
            blocked_mean(autoregressive(1, 300, 0.8, static_cast<std::uint64_t>(s)));
        double const deviation = (found.mean - 5) / found.error;
        squares += deviation * deviation;
        beyond += std::abs(deviation) > 3;
    }
    EXPECT_NEAR(std::sqrt(squares / series), 1, 0.1);  // known to 1 / sqrt(800)
    EXPECT_LE(beyond, 8);  // 1 of normal errors; some have 16 blocks only
}

TEST(Blocking, SamplesThatFillNoBlockCount) {
    for (auto const& [copies, samples] : {std::pair{64, 255}, {284, 421}, {284, 901}, {142, 445}}) {
        double const keep = 0.9, right = std::sqrt((1 + keep) / (1 - keep) / (copies * samples));
        Blocked const found = blocked_mean(autoregressive(copies, samples, keep, 11));
        EXPECT_TRUE(found.plateau) << copies << " " << samples;
        EXPECT_NEAR(found.error / right, 1, 0.12) << copies << " " << samples;
    }
}

TEST(Blocking, ManyCopiesAreBlocksEnough) {
    Blocked const found = blocked_mean(autoregressive(200, 300, 0.999, 3));
    EXPECT_TRUE(found.plateau);
    double const keep = 0.999, n = 300;  // of one copy's mean
    double const variance = ((1 + keep) / (1 - keep) -
                             2 * keep * (1 - std::pow(keep, n)) / (n * std::pow(1 - keep, 2))) /
                            n;
    EXPECT_NEAR(found.error / std::sqrt(variance / 200), 1, 0.15);
}

TEST(Blocking, WithoutBlocksItWouldBeTooSmall) {
    Blocked const found = blocked_mean(autoregressive(4, 16384, 0.98, 3));
    EXPECT_GT(found.error, 5 / std::sqrt(65536.0));
    EXPECT_GT(found.block, 50);
}

TEST(Blocking, ASeriesThatEndsBeforeItsPlateauSaysSo) {
    EXPECT_FALSE(blocked_mean(autoregressive(2, 300, 0.999, 3)).plateau);
    EXPECT_FALSE(blocked_mean(autoregressive(15, 300, 0.999, 3)).plateau);
    EXPECT_TRUE(std::isnan(blocked_mean({{1.0}}).error));
    EXPECT_TRUE(std::isnan(blocked_mean({}).mean));
    EXPECT_EQ(blocked_mean({{2, 2, 2}}).error, 0);
}

TEST(Blocking, ARatiosErrorCountsWhatItsPartsShare) {
    CopySeries below = autoregressive(8, 4096, 0.9, 1), above = below;
    for (auto& copy : above)
        for (double& value : copy) value *= 3;
    Blocked const same = blocked_ratio(above, below);
    EXPECT_NEAR(same.mean, 3, 1e-12);
    EXPECT_LT(same.error, 1e-12);
    CopySeries const noise = autoregressive(8, 4096, 0.5, 2);
    for (std::size_t c = 0; c < above.size(); ++c)
        for (std::size_t i = 0; i < above[c].size(); ++i) above[c][i] += noise[c][i] - 5;
    Blocked const found = blocked_ratio(above, below);
    EXPECT_NEAR(found.error / (std::sqrt(3.0 / 32768) / 5), 1, 0.2);
    EXPECT_LT(std::abs(found.mean - 3), 4 * found.error);
}

}  // namespace
}  // namespace catena
