// Long arrays are zero when they are made, whatever was in the memory before.
#include "math/large_pages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>

namespace catena::test {
namespace {

TEST(LongArray, IsZeroWhereverItsMemoryComesFrom) {
    constexpr std::size_t edge = LargePages<double>::from_bytes / sizeof(double);
    for (std::size_t const size :
         {std::size_t{1}, std::size_t{1000}, edge - 1, edge, edge + 1, 3 * edge + 7})
        for (int again = 0; again < 3; ++again) {
            LongArray<double> array(size);
            EXPECT_TRUE(std::all_of(array.begin(), array.end(), [](double v) { return v == 0; }))
                << size;
            std::fill(array.begin(), array.end(), 1.5);
            LongArray<double> const copy = array;
            EXPECT_TRUE(copy == array) << size;
        }
}

TEST(LongArray, TakesAValue) {
    LongArray<std::int64_t> const array(LargePages<std::int64_t>::from_bytes, 7);
    EXPECT_TRUE(std::all_of(array.begin(), array.end(), [](std::int64_t v) { return v == 7; }));
}

}  // namespace
}  // namespace catena::test
