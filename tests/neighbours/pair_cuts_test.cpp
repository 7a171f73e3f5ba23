// Where a row of blocks is cut so that ranks have as much work.
#include "neighbours/pair_cuts.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace catena::testing {
namespace {

/// Work of each rank where block x of 0 to 1 has 2 (1 - x): of all blocks after it, as in a list of
/// pairs.
std::vector<double> work_of(std::vector<double> const& cuts) {
    std::vector<double> work;
    for (std::size_t r = 0; r + 1 < cuts.size(); ++r)
        work.push_back(cuts[r + 1] * (2 - cuts[r + 1]) - cuts[r] * (2 - cuts[r]));
    return work;
}

TEST(PairCuts, BecomeEvenAfterAFewRounds) {
    for (int ranks : {1, 2, 3, 4, 8, 16}) {
        std::vector<double> cuts = equal_cuts(ranks);
        ASSERT_EQ(std::ssize(cuts), ranks + 1);
        for (int round = 0; round < 6; ++round) cuts = evened_cuts(cuts, work_of(cuts));
        EXPECT_EQ(cuts.front(), 0);
        EXPECT_EQ(cuts.back(), 1);
        for (double const work : work_of(cuts)) EXPECT_NEAR(work * ranks, 1, 0.02) << ranks;
    }
}

TEST(PairCuts, RanksWithoutWork) {
    std::vector<double> const cuts{0, 0.25, 0.5, 0.75, 1};
    EXPECT_EQ(evened_cuts(cuts, std::vector<double>{0, 0, 0, 0}), cuts);
    EXPECT_EQ(evened_cuts(cuts, std::vector<double>{0, 8, 0, 0}),
              (std::vector<double>{0, 0.3125, 0.375, 0.4375, 1}));
}

/// One block in `apart` has all the work: nobody's share may become empty, however often they are
/// evened.
TEST(PairCuts, NoShareBecomesEmpty) {
    for (int ranks : {2, 3, 4, 5, 6, 7, 8, 11, 16})
        for (int apart : {1, 10, 75}) {
            std::vector<double> cuts = equal_cuts(ranks);
            for (int round = 0; round < 100; ++round) {
                std::vector<double> work(static_cast<std::size_t>(ranks), 0);
                for (int block = 0; block < 75; block += apart)
                    for (std::size_t r = 0; r < work.size(); ++r)
                        if (static_cast<int>(cuts[r] * 75) <= block &&
                            block < static_cast<int>(cuts[r + 1] * 75))
                            work[r] += 1;
                cuts = evened_cuts(cuts, work);
                EXPECT_EQ(cuts.front(), 0);
                EXPECT_EQ(cuts.back(), 1);
                for (std::size_t r = 0; r < work.size(); ++r)
                    ASSERT_GT(cuts[r + 1] - cuts[r], 0.1 / ranks) << ranks << ", " << apart;
            }
        }
}

}  // namespace
}  // namespace catena::testing
