#include "io/topology/decimals.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace catena::test {
namespace {

void expect_as_fmt(double value) {
    for (int places = 0; places <= 3; ++places)
        EXPECT_EQ(Decimals(value, places).text(), fmt::format("{:.{}f}", value, places))
            << value << ", " << places << " places";
}

TEST(Decimals, AreThoseOfFmt) {
    std::mt19937_64 random(1);
    for (int power = -6; power <= 15; ++power) {
        std::uniform_real_distribution<double> number(-std::pow(10.0, power),
                                                      std::pow(10.0, power));
        for (int i = 0; i < 2000; ++i) expect_as_fmt(number(random));
    }
}

/// Halves, in decimal and in binary, and their neighbours.
TEST(Decimals, AreThoseOfFmtAtTies) {
    for (int i = -4000; i <= 4000; ++i)
        for (double const tie : {i / 2000.0, i / 200.0, i / 20.0, i / 2.0, i / 1024.0})
            for (double const end : {-1e300, 1e300}) {
                expect_as_fmt(tie);
                expect_as_fmt(std::nextafter(tie, end));
            }
}

TEST(Decimals, TakeAnyNumber) {
    using Limits = std::numeric_limits<double>;
    for (double const value : {0.0, Limits::denorm_min(), Limits::max(), Limits::infinity(),
                               Limits::quiet_NaN(), 1e12, 999999999.9996})
        for (double const sign : {1.0, -1.0}) expect_as_fmt(sign * value);
}

}  // namespace
}  // namespace catena::test
