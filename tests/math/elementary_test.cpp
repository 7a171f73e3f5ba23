#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "math/elementary.hpp"
#include "math/rotation.hpp"

namespace catena {
namespace {

/// Of a value against the exact one, in units of the last place of the latter.
double units(double value, long double exact) {
    int exponent = 0;
    std::frexp(static_cast<double>(exact), &exponent);
    return static_cast<double>(std::fabs(static_cast<long double>(value) - exact)) /
           std::ldexp(1.0, exponent - 53);
}

struct Worst {
    double cos = 0, sin = 0;
    void look(double x) {
        CosSin const r = cos_sin(x);
        cos = std::max(cos, units(r.cos, std::cos(static_cast<long double>(x))));
        sin = std::max(sin, units(r.sin, std::sin(static_cast<long double>(x))));
    }
};

TEST(Elementary, CosAndSinAreThoseOfTheLibrary) {
    Worst small, middle, large;
    for (int i = -400000; i <= 400000; ++i) small.look(i * 1.0e-5);
    for (double x = 1e-300; x < 1; x *= 1.37) small.look(x), small.look(-x);
    for (int i = 0; i < 400000; ++i) middle.look(i * 0.2499999), middle.look(-i * 0.24777);
    for (int i = 1; i < 63000; ++i) {  // next to the quarter turns
        double const quarter = i * 1.5707963267948966;
        middle.look(quarter);
        middle.look(std::nextafter(quarter, 0));
        middle.look(quarter * (1 + 1e-9));
    }
    EXPECT_LT(small.cos, 0.8);
    EXPECT_LT(small.sin, 0.8);
    EXPECT_LT(middle.cos, 0.8);
    EXPECT_LT(middle.sin, 0.8);
    for (double x = 1.01e5; x < 1e15; x *= 1.0003) {
        EXPECT_NEAR(cos_sin(x).cos, std::cos(static_cast<long double>(x)), 1e-15) << x;
        EXPECT_NEAR(cos_sin(-x).sin, -std::sin(static_cast<long double>(x)), 1e-15) << x;
    }
}

TEST(Elementary, WhatIsKnownIsExact) {
    EXPECT_EQ(cos_sin(0.0).cos, 1);
    EXPECT_EQ(cos_sin(0.0).sin, 0);
    EXPECT_EQ(cos_sin(1.5707963267948966).sin, 1);
    EXPECT_EQ(cos_sin(-3.141592653589793).cos, -1);
    EXPECT_TRUE(std::isnan(cos_sin(std::numeric_limits<double>::infinity()).cos));
    EXPECT_TRUE(std::isnan(cos_sin(std::numeric_limits<double>::quiet_NaN()).sin));
}

TEST(Elementary, TheAngleIsThatOfTheLibrary) {
    double worst = 0;
    auto const look = [&](double s, double w) {
        worst = std::max(worst, units(angle_of(s, w), std::atan2(static_cast<long double>(s),
                                                                 static_cast<long double>(w))));
    };
    for (int i = 1; i <= 300000; ++i) {
        CosSin const a = cos_sin(i * 1.5707963 / 300000);
        look(a.sin, a.cos);
    }
    for (double t = 1e-12; t < 1e12; t *= 1.003) look(t, 1), look(1, t), look(0.3, t);
    look(1, 0);
    EXPECT_LT(worst, 2);
    EXPECT_EQ(angle_of(0.0, 1.0), 0);
}

}  // namespace
}  // namespace catena
