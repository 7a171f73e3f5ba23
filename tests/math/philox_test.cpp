#include <gtest/gtest.h>

#include "math/philox.hpp"

namespace catena {
namespace {

// Known answers of Random123's kat_vectors (Salmon et al., SC'11): philox 4x32, 10 rounds.
TEST(Philox, KnownAnswers) {
    auto const expect = [](Philox4 const& counter, std::uint32_t k0, std::uint32_t k1,
                           Philox4 const& answer) {
        Philox4 const r = philox(counter, k0, k1);
        for (int i = 0; i < 4; ++i) EXPECT_EQ(r.word[i], answer.word[i]);
    };
    expect({{0, 0, 0, 0}}, 0, 0, {{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}});
    expect({{0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}}, 0xffffffff, 0xffffffff,
           {{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}});
    expect({{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}}, 0xa4093822, 0x299f31d0,
           {{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}});
}

// Each of the series' operations rounds to half an eps of a term no larger than a few of the
// result.
TEST(Philox, OwnFunctionsAreThoseOfTheLibrary) {
    double constexpr eps = 0x1p-52, two_pi = 6.283185307179586476925;
    auto const look = [&](double u) {
        EXPECT_NEAR(log_of_uniform(u), std::log(u), 2 * eps * std::abs(std::log(u))) << u;
        CosSin const r = cos_sin_of_turns(u);
        // 2 pi u is itself rounded in the library's argument
        EXPECT_NEAR(r.cos, std::cos(two_pi * u), 2 * eps * (1 + two_pi * u)) << u;
        EXPECT_NEAR(r.sin, std::sin(two_pi * u), 2 * eps * (1 + two_pi * u)) << u;
    };
    for (int i = 1; i < 100000; ++i) look(i / 100000.0);
    for (double u = 0x1p-54; u < 0.5; u *= 1.75) look(u), look(1 - u);
    EXPECT_EQ(cos_sin_of_turns(0.25).sin, 1);
    EXPECT_EQ(cos_sin_of_turns(0.5).cos, -1);
}

// Means of n numbers scatter by 1 / sqrt(n), of squares by sqrt(2 / n), of products by 1 / sqrt(n):
// five of these are allowed.
TEST(Philox, NormalNumbersAreStandardAndIndependent) {
    int const n = 200000;
    double mean = 0, square = 0, fourth = 0, product = 0, neighbours = 0;
    Vec3 last = Vec3::zero();
    for (int i = 0; i < n; ++i) {
        Vec3 const v = normal3(7, static_cast<std::uint64_t>(i / 100),
                               static_cast<std::uint64_t>(i % 100), NoiseStage::thermostat);
        for (int c = 0; c < 3; ++c) {
            mean += v[c];
            square += v[c] * v[c];
            fourth += v[c] * v[c] * v[c] * v[c];
        }
        product += v[0] * v[1] + v[1] * v[2] + v[2] * v[0];
        neighbours += dot(v, last);
        last = v;
    }
    double const samples = 3.0 * n;
    EXPECT_LT(std::abs(mean / samples), 5 / std::sqrt(samples));
    EXPECT_LT(std::abs(square / samples - 1), 5 * std::sqrt(2 / samples));
    EXPECT_LT(std::abs(fourth / samples - 3), 5 * std::sqrt(96 / samples));
    EXPECT_LT(std::abs(product / samples), 5 / std::sqrt(samples));
    EXPECT_LT(std::abs(neighbours / samples), 5 / std::sqrt(samples));
}

TEST(Philox, EveryKeyPartMatters) {
    Vec3 const v = normal3(1, 2, 3, NoiseStage::thermostat);
    for (Vec3 const& other :
         {normal3(2, 2, 3, NoiseStage::thermostat), normal3(1, 3, 3, NoiseStage::thermostat),
          normal3(1, 2, 4, NoiseStage::thermostat), normal3(1, 2, 3, NoiseStage::start),
          normal3(1, 2, 3 + (std::uint64_t{1} << 32), NoiseStage::thermostat),
          normal3(1 + (std::uint64_t{1} << 32), 2, 3, NoiseStage::thermostat)})
        EXPECT_NE(v[0], other[0]);
}

}  // namespace
}  // namespace catena
