// Levels of branched chains.
#include "tree/levels.hpp"

#include <gtest/gtest.h>

#include "tests/support/random_tree.hpp"

namespace catena::test {
namespace {

using Numbers = std::vector<std::int64_t>;

TEST(Levels, HoldBodiesByTheirDistance) {
    // Two chains: a body with three on it, one of which carries another; and a pair.
    Numbers const inboard{-1, 0, 0, 1, 0, -1, 5};
    dca::Levels const levels(inboard);
    EXPECT_EQ(levels.levels(), 3);
    EXPECT_EQ(levels.body, (Numbers{0, 5, 1, 2, 4, 6, 3}));
    EXPECT_EQ(levels.first_of_level, (Numbers{0, 2, 6, 7}));
    auto const of_first = levels.children(0);
    EXPECT_EQ(Numbers(of_first.begin(), of_first.end()), (Numbers{1, 2, 4}));
    EXPECT_EQ(levels.children(1).size(), 1U);
    EXPECT_TRUE(levels.children(6).empty());
    // An elimination on each level, sums over three bodies, one and none.
    EXPECT_EQ(levels.depth(), 3 + 3 + 1);
}

TEST(Levels, AreNoneWithoutBodies) {
    dca::Levels const levels(Numbers{});
    EXPECT_EQ(levels.levels(), 0);
    EXPECT_EQ(levels.depth(), 0);
}

TEST(Levels, VisitEachBodyOnceAfterItsInboardBody) {
    for (TreeShape const shape :
         {TreeShape::any, TreeShape::long_paths, TreeShape::bushy, TreeShape::star}) {
        Numbers const inboard = random_parents(3, 500, shape);
        dca::Levels const levels(inboard);
        std::vector<int> seen(inboard.size(), 0);
        std::size_t children = 0;
        for (std::int64_t const k : levels.body) {
            std::int64_t const before = inboard[static_cast<std::size_t>(k)];
            EXPECT_TRUE(before < 0 || seen[static_cast<std::size_t>(before)] == 1);
            ++seen[static_cast<std::size_t>(k)];
            children += levels.children(k).size();
        }
        EXPECT_EQ(seen, std::vector<int>(inboard.size(), 1));
        EXPECT_EQ(children, inboard.size() - 1);
    }
}

}  // namespace
}  // namespace catena::test
