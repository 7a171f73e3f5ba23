#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tree/tree.hpp"

namespace catena::dca {
namespace {

std::vector<std::vector<std::int64_t>> const scenes{{1},
                                                    {2},
                                                    {3},
                                                    {5},
                                                    {140},
                                                    {255},
                                                    {256},
                                                    {257},
                                                    {10000},
                                                    {1, 1, 1},
                                                    {7, 300, 2, 1000},
                                                    {140, 140, 140, 140, 140},
                                                    {100001}};

TEST(Partition, EveryBodyHasOneRankAndUnitsStayWhole) {
    for (auto const& lengths : scenes)
        for (int const ranks : {1, 2, 3, 5, 6, 16})
            for (bool const pairwise : {false, true}) {
                Partition const p(lengths, pairwise, ranks);
                ASSERT_EQ(p.first_of_rank.front(), 0);
                ASSERT_EQ(p.first_of_rank.back(), p.bodies());
                for (int rank = 0; rank < ranks; ++rank) {
                    ASSERT_LE(p.first_of_rank[rank], p.first_of_rank[rank + 1]);
                    std::int64_t covered = 0;
                    for (Piece const& piece : pieces_of(p, rank)) {
                        ChainTree const& tree = p.trees[piece.chain];
                        ASSERT_EQ(piece.body, tree.first_body_of_unit(piece.first_unit));
                        ASSERT_EQ(piece.body + piece.count,
                                  tree.first_body_of_unit(piece.first_unit + piece.units));
                        covered += piece.count;
                    }
                    ASSERT_EQ(covered, p.first_of_rank[rank + 1] - p.first_of_rank[rank]);
                }
            }
}

TEST(Partition, SharesAreEqualWithinAUnit) {
    Partition const p({1000000}, false, 6);
    std::int64_t const unit = p.trees[0].first_body_of_unit(1);
    for (int rank = 0; rank < 6; ++rank)
        EXPECT_NEAR(static_cast<double>(p.first_of_rank[rank + 1] - p.first_of_rank[rank]), 1e6 / 6,
                    static_cast<double>(unit));
}

/// Every joint between two bodies of a chain is eliminated exactly once, in a run or by a merge, on
/// the ranks that hold it.
TEST(Schedule, EveryJointIsEliminatedOnce) {
    for (auto const& lengths : scenes)
        for (int const ranks : {1, 2, 3, 6}) {
            Partition const p(lengths, false, ranks);
            std::multiset<std::int64_t> eliminated;  // scene-wide body index of the joint
            std::set<std::int64_t> at_top;
            for (int rank = 0; rank < ranks; ++rank) {
                Schedule const s = make_schedule(p, rank);
                std::int64_t const first = p.first_of_rank[rank];
                for (dca::Run const& run : s.runs)
                    for (std::int64_t k = run.body + 1; k < run.body + run.count; ++k)
                        eliminated.insert(first + k);
                for (auto const& level : s.levels)
                    for (Merge const& m : level) eliminated.insert(first + m.joint);
                for (auto const& level : s.top_levels)
                    for (Merge const& m : level) {
                        if (m.joint <= s.halo) {
                            at_top.insert(first + m.joint);
                            continue;
                        }
                        auto const i = static_cast<std::size_t>(m.joint - s.first_top_joint());
                        at_top.insert(p.first_of_chain[s.top_chain_of_joint[i]] +
                                      s.top_body_of_joint[i]);
                    }
            }
            eliminated.insert(at_top.begin(),
                              at_top.end());  // several ranks do the top, redundantly
            std::vector<std::int64_t> expected;
            for (int chain = 0; chain < p.chains(); ++chain)
                for (std::int64_t k = p.first_of_chain[chain] + 1; k < p.first_of_chain[chain + 1];
                     ++k)
                    expected.push_back(k);
            ASSERT_TRUE(
                std::equal(eliminated.begin(), eliminated.end(), expected.begin(), expected.end()))
                << lengths.size() << " chains on " << ranks << " ranks";
        }
}

TEST(Tree, DepthGrowsWithTheLogarithm) {
    EXPECT_EQ(ChainTree(1, 1).depth(), 0);
    EXPECT_EQ(ChainTree(2, 1).depth(), 1);
    EXPECT_EQ(ChainTree(1024, 1).depth(), 10);
    EXPECT_EQ(ChainTree(1025, 1).depth(), 11);
    EXPECT_EQ(ChainTree(1024, 16).depth(), 15 + 6);
    EXPECT_LE(ChainTree(100000000, 32).units, max_units);
}

}  // namespace
}  // namespace catena::dca
