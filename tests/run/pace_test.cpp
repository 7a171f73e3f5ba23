#include "run/pace.hpp"

#include <gtest/gtest.h>

namespace catena::test {
namespace {

TEST(Pace, StepsOfTheStartDoNotCount) {
    Pace pace;
    EXPECT_EQ(pace.steps_per_second(), 0);
    pace.note(101, 103, 7.0);
    pace.note(102, 103, 17.0);
    pace.note(103, 103, 20.0);
    EXPECT_EQ(pace.steps_per_second(), 0);
    pace.note(104, 103, 20.5);
    EXPECT_EQ(pace.steps_per_second(), 2);
    pace.note(105, 103, 20.75);
    EXPECT_NEAR(pace.steps_per_second(), 2 / 0.75, 1e-12);
}

}  // namespace
}  // namespace catena::test
