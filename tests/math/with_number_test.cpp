// Numbers known at run time as template arguments.
#include "math/with_number.hpp"

#include <gtest/gtest.h>

#include <array>

namespace catena::test {
namespace {

/// Length of an array type that with_number() selects.
int selected(int n) {
    return with_number<2, 6>(n, [](auto count) {
        return static_cast<int>(std::array<int, decltype(count)::value>{}.size());
    });
}

TEST(WithNumber, selects_each_number_of_the_range) {
    for (int n = 2; n <= 6; ++n) EXPECT_EQ(selected(n), n);
}
TEST(WithNumber, numbers_outside_the_range_count_as_the_largest) {
    EXPECT_EQ(selected(1), 6);
    EXPECT_EQ(selected(7), 6);
}

}  // namespace
}  // namespace catena::test
