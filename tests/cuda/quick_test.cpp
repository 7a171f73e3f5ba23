// Quick quotients and roots have the bits of the host's, or say that they do not know.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "tests/cuda/quick_on_gpu.hpp"
#include "tests/support/gpu.hpp"

namespace catena::test {
namespace {

/// Of any bits, of ordinary size, and those at which a range ends.
std::vector<double> numbers() {
    using Limits = std::numeric_limits<double>;
    std::vector<double> all{
        0.0,          Limits::denorm_min(), 0x1p-1030, Limits::infinity(), Limits::quiet_NaN(),
        Limits::max()};
    for (int e = -1022; e <= 1023; ++e) {
        double const power = std::ldexp(1.0, e);
        for (double const x :
             {power, std::nextafter(power, 0.0), std::nextafter(power, 2 * power), 1.5 * power})
            all.push_back(x);
    }
    std::mt19937_64 random(1);
    for (int i = 0; i < 1 << 20; ++i) {
        all.push_back(std::bit_cast<double>(random()));
        all.push_back(std::ldexp(1 + std::ldexp(static_cast<double>(random() >> 12), -52),
                                 static_cast<int>(random() % 64) - 32));
    }
    std::size_t const positive = all.size();
    for (std::size_t i = 0; i < positive; ++i) all.push_back(-all[i]);
    return all;
}

/// `least`, `most`: sizes between which it must know.
template <class Exact>
void expect_known_or_same(std::vector<double> const& x, std::vector<double> const& found,
                          double least, double most, Exact const& exact) {
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::isnan(found[i])) {
            bool const must_know = std::abs(x[i]) >= least && std::abs(x[i]) <= most;
            ASSERT_FALSE(must_know) << x[i];
        } else {
            ASSERT_EQ(std::bit_cast<std::uint64_t>(found[i]),
                      std::bit_cast<std::uint64_t>(exact(x[i])))
                << x[i];
        }
    }
}

class GpuQuick : public ::testing::Test {
  protected:
    void SetUp() override { need_gpu(); }
};

TEST_F(GpuQuick, InverseIsKnownOrSaysSo) {
    std::vector<double> const x = numbers();
    expect_known_or_same(x, quick_inverses(x), 0x1p-1022, 0x1p1021, [](double v) { return 1 / v; });
}
TEST_F(GpuQuick, WhatIsNotKnownIsFoundAgain) {
    std::vector<double> const x = numbers(), found = inverses_in_any_case(x);
    for (std::size_t i = 0; i < x.size(); ++i) {
        if (std::isnan(x[i]))
            ASSERT_TRUE(std::isnan(found[i]));
        else
            ASSERT_EQ(std::bit_cast<std::uint64_t>(found[i]),
                      std::bit_cast<std::uint64_t>(1 / x[i]))
                << x[i];
    }
}
TEST_F(GpuQuick, InverseLengthIsKnownOrSaysSo) {
    std::vector<double> const x = numbers();
    expect_known_or_same(x, quick_inverse_lengths(x), 0x1p-480, 0x1p511,
                         [](double v) { return 1 / std::sqrt(v * v); });
}

}  // namespace
}  // namespace catena::test
