// Ranks' shares of the bodies: what speeds make of them, and the cuts they make.
#include "tree/load_balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace catena::dca {
namespace {

std::vector<std::vector<std::int64_t>> const scenes{{1},
                                                    {2},
                                                    {3},
                                                    {5},
                                                    {140},
                                                    {257},
                                                    {10000},
                                                    {1, 1, 1},
                                                    {7, 300, 2, 1000},
                                                    std::vector<std::int64_t>(200, 140),
                                                    {100001},
                                                    {5000, 3, 3, 3, 20}};

/// Bodies of each rank.
std::vector<std::int64_t> counts(Partition const& p) {
    std::vector<std::int64_t> of_rank;
    for (std::size_t r = 0; r + 1 < p.first_of_rank.size(); ++r)
        of_rank.push_back(p.first_of_rank[r + 1] - p.first_of_rank[r]);
    return of_rank;
}

Partition cut(std::vector<std::int64_t> const& lengths, int ranks, Shares const& shares,
              bool pairwise = false) {
    Partition p(lengths, pairwise, ranks);
    cut_by_shares(p, ranks, shares);
    return p;
}

/// The first rank eight times the last, those between on the way.
Shares falling(int ranks) {
    Shares shares;
    for (int r = 0; r < ranks; ++r)
        shares.push_back(ranks == 1 ? 1000 : 8000 - 7000 * r / (ranks - 1));
    return shares;
}

TEST(Shares, EqualOnesMakeThePartitionsCuts) {
    for (auto const& lengths : scenes)
        for (int const ranks : {1, 2, 3, 5, 6, 16, 100})
            for (bool const pairwise : {false, true}) {
                auto const expected = Partition(lengths, pairwise, ranks).first_of_rank;
                auto const all = static_cast<std::size_t>(ranks);
                for (Shares const& shares : {Shares{}, Shares(all, 1), Shares(all, 1000),
                                             shares_of_speeds(std::vector<double>(all, 0.3))})
                    EXPECT_EQ(cut(lengths, ranks, shares, pairwise).first_of_rank, expected)
                        << lengths[0] << " on " << ranks;
            }
}

TEST(Shares, BodiesFollowThemToAUnit) {
    Partition const one = cut({1000000}, 3, {500, 2000, 500});
    double const unit = static_cast<double>(one.trees[0].first_body_of_unit(1));
    EXPECT_NEAR(static_cast<double>(counts(one)[0]), 1e6 / 6, unit);
    EXPECT_NEAR(static_cast<double>(counts(one)[1]), 1e6 * 2 / 3, unit);
    EXPECT_NEAR(static_cast<double>(counts(one)[2]), 1e6 / 6, unit);
    Partition const many = cut(std::vector<std::int64_t>(7000, 140), 2, {3, 1});
    EXPECT_EQ(counts(many), (std::vector<std::int64_t>{5250 * 140, 1750 * 140}));
}

TEST(Shares, UnitsStayWholeAndTheTreesAreThoseOfOneRank) {
    for (auto const& lengths : scenes)
        for (int const ranks : {2, 3, 5, 6, 16}) {
            Partition const p = cut(lengths, ranks, falling(ranks));
            ASSERT_EQ(p.first_of_rank.front(), 0);
            ASSERT_EQ(p.first_of_rank.back(), p.bodies());
            for (int rank = 0; rank < ranks; ++rank) {
                ASSERT_LE(p.first_of_rank[static_cast<std::size_t>(rank)],
                          p.first_of_rank[static_cast<std::size_t>(rank) + 1]);
                for (Piece const& piece : pieces_of(p, rank)) {
                    ChainTree const& tree = p.trees[static_cast<std::size_t>(piece.chain)];
                    EXPECT_EQ(piece.body, tree.first_body_of_unit(piece.first_unit));
                    EXPECT_EQ(piece.body + piece.count,
                              tree.first_body_of_unit(piece.first_unit + piece.units));
                }
            }
        }
}

/// A share may be less than a unit.
TEST(Shares, NobodyIsLeftWithoutBodiesWhoHasSomeWithEqualOnes) {
    for (auto const& lengths : scenes)
        for (int const ranks : {2, 3, 5, 6, 16, 60}) {
            std::vector<std::int64_t> const equal = counts(cut(lengths, ranks, {}));
            Shares rising = falling(ranks);
            std::reverse(rising.begin(), rising.end());
            for (Shares const& shares : {falling(ranks), rising}) {
                std::vector<std::int64_t> const found = counts(cut(lengths, ranks, shares));
                for (std::size_t r = 0; r < equal.size(); ++r)
                    if (equal[r] > 0) {
                        EXPECT_GT(found[r], 0) << lengths[0] << ", rank " << r << " of " << ranks;
                    }
            }
        }
}

TEST(Shares, AreInProportionToSpeeds) {
    EXPECT_EQ(shares_of_speeds(std::vector{1e6, 3e6}), (Shares{500, 1500}));
    EXPECT_EQ(shares_of_speeds(std::vector{2.0, 1.0, 1.0, 4.0}), (Shares{1000, 500, 500, 2000}));
}

TEST(Shares, ReachNoFartherThanEightToOne) {
    EXPECT_EQ(shares_of_speeds(std::vector{1e-9, 1.0}), (Shares{222, 1778}));
    Shares const one_is_fast = shares_of_speeds(std::vector{1.0, 1e9, 1.0});
    EXPECT_NEAR(static_cast<double>(one_is_fast[1]) / static_cast<double>(one_is_fast[0]), 8, 0.02);
}

TEST(Shares, WhoseSpeedIsNotKnownCountsAsTheMean) {
    double constexpr nan = std::numeric_limits<double>::quiet_NaN(),
                     infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(shares_of_speeds(std::vector{1.0, 3.0, 0.0, nan, infinity, -1.0}),
              (Shares{500, 1500, 1000, 1000, 1000, 1000}));
    EXPECT_EQ(shares_of_speeds(std::vector{0.0, nan}), (Shares{1000, 1000}));
}

}  // namespace
}  // namespace catena::dca
