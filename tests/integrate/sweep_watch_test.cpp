// When a run takes one sweep more: above what is allowed, but not again and again where no sweep
// helps.
#include "integrate/sweep_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace catena::test {
namespace {

constexpr double tolerance = 1e-10, allowed = 1e-12;

TEST(SweepWatch, AsksForOneAboveWhatIsAllowed) {
    SweepWatch watch;
    EXPECT_FALSE(watch.is_due(0.9e-12, allowed, tolerance));
    ASSERT_TRUE(watch.is_due(1.1e-12, allowed, tolerance));
    watch.added(1.1e-12);
    EXPECT_FALSE(watch.is_due(2e-14, allowed, tolerance));  // it helped
    EXPECT_TRUE(watch.is_due(1.2e-12, allowed, tolerance));
}

TEST(SweepWatch, RoundingIsNoReason) {
    SweepWatch watch;
    EXPECT_FALSE(watch.is_due(0.9e-13, 1e-14, 1e-12));
    EXPECT_TRUE(watch.is_due(0.9e-13, 1e-15, 1e-13));  // but where the tolerance asks for it
}

TEST(SweepWatch, FewAreAddedInVain) {
    SweepWatch watch;
    int added = 0;
    for (int look = 0; look < 1000; ++look) {
        double const error =
            3e-12 * (1 + 0.3 * std::sin(look));  // as far from the origin as rounding takes it
        if (!watch.is_due(error, allowed, tolerance)) continue;
        watch.added(error);
        ++added;
    }
    EXPECT_GE(added, 1);
    EXPECT_LE(added, 2);
}

/// What grows by motion is closed however often a sweep seemed in vain.
TEST(SweepWatch, GrowingErrorsGetTheirs) {
    SweepWatch watch;
    int sweeps = 1;
    double speed = 1e-6, error = 0;
    for (int look = 0; look < 20; ++look, speed *= 1.7) {
        error = std::pow(speed, 2.0 * sweeps);
        if (!watch.is_due(error, allowed, tolerance)) continue;
        watch.added(error);
        ++sweeps;
    }
    EXPECT_LE(error, tolerance);
    EXPECT_GT(sweeps, 2);
    EXPECT_LT(sweeps, 8);
}

TEST(SweepWatch, GoesOnFromItsState) {
    SweepWatch watch, other;
    EXPECT_TRUE(watch.is_due(3e-12, allowed, tolerance));
    watch.added(3e-12);
    other.set_state(watch.state());
    for (double const error : {2.9e-12, 4e-12, 7e-12})  // in vain, within what that left, beyond it
        EXPECT_EQ(watch.is_due(error, allowed, tolerance), other.is_due(error, allowed, tolerance))
            << error;
    EXPECT_EQ(watch.state(), other.state());
    EXPECT_THROW(other.set_state({1}), std::invalid_argument);
}

}  // namespace
}  // namespace catena::test
