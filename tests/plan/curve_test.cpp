#include <gtest/gtest.h>

#include "plan/curve.hpp"

namespace catena::test {
namespace {

TEST(Curve, MeetsItsPointsAndIsStraightInLogarithms) {
    plan::Curve<2> curve;
    curve.add(16, {1, 8});
    curve.add(64, {2, 128});  // as the root; as the square
    EXPECT_DOUBLE_EQ(curve.at(16)[0], 1);
    EXPECT_DOUBLE_EQ(curve.at(64)[1], 128);
    EXPECT_NEAR(curve.at(32)[0], std::sqrt(2.0), 1e-12);
    EXPECT_NEAR(curve.at(32)[1], 32, 1e-10);
}

TEST(Curve, BeyondItsPointsEachBodyTakesWhatItTookThere) {
    plan::Curve<1> curve;
    curve.add(100, {10});
    curve.add(200, {15});
    EXPECT_DOUBLE_EQ(curve.at(1000)[0], 55);
    EXPECT_DOUBLE_EQ(curve.at(40)[0], 7);
    plan::Curve<1> steep;
    steep.add(100, {10});
    steep.add(200, {40});
    EXPECT_DOUBLE_EQ(steep.at(10)[0], 1);  // not less than nothing
    plan::Curve<1> falling;
    falling.add(100, {10});
    falling.add(200, {9});
    EXPECT_DOUBLE_EQ(falling.at(400)[0], 9);
}

TEST(Curve, OnePointIsInProportion) {
    plan::Curve<1> curve;
    curve.add(10, {5});
    EXPECT_DOUBLE_EQ(curve.at(20)[0], 10);
    EXPECT_DOUBLE_EQ(curve.at(2)[0], 1);
}

}  // namespace
}  // namespace catena::test
