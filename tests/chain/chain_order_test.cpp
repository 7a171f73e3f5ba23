// Chains of a rank lie together, and every rank gets its share of bodies.
#include "chain/chain_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace catena::test {
namespace {

std::vector<PlacedChain> scattered(int count, Vec3 const& box) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(0, 1);
    std::vector<PlacedChain> chains;
    for (int k = 0; k < count; ++k) {
        PlacedChain chain{k, Vec3::zero(), 5 + k % 7};
        for (int i = 0; i < 3; ++i) chain.middle[i] = box[i] * place(random);
        chains.push_back(chain);
    }
    return chains;
}

TEST(CompactOrder, HoldsEveryChainOnce) {
    for (int const ranks : {1, 2, 3, 4, 6, 64})
        for (int const count : {1, 2, 5, 200}) {
            std::vector<int> order = compact_order(scattered(count, {{10, 10, 10}}), ranks);
            std::sort(order.begin(), order.end());
            ASSERT_EQ(std::ssize(order), count);
            for (int k = 0; k < count; ++k) EXPECT_EQ(order[static_cast<std::size_t>(k)], k);
        }
}

TEST(CompactOrder, OnOneRankIsTheScenes) {
    std::vector<int> const order = compact_order(scattered(50, {{10, 10, 10}}), 1);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(CompactOrder, FollowsTheRanksShares) {
    std::vector<PlacedChain> const chains = scattered(300, {{10, 10, 10}});
    EXPECT_EQ(compact_order(chains, 6, dca::Shares(6, 1000)), compact_order(chains, 6));
    std::vector<int> const order = compact_order(chains, 2, {3000, 1000});
    std::int64_t all = 0, first = 0;
    for (PlacedChain const& chain : chains) all += chain.bodies;
    std::size_t cut = 0;  // an ascending row a rank
    while (order[cut] < order[cut + 1])
        first += chains[static_cast<std::size_t>(order[cut++])].bodies;
    first += chains[static_cast<std::size_t>(order[cut])].bodies;
    EXPECT_NEAR(static_cast<double>(first), 0.75 * static_cast<double>(all), 11);
    EXPECT_TRUE(std::is_sorted(order.begin() + static_cast<std::ptrdiff_t>(cut) + 1, order.end()));
}

/// Eight ranks get an eighth of a cube each, six parts of two shapes: sides follow, to a few
/// chains' distance.
TEST(CompactOrder, RanksGetBlocksOfSpace) {
    double constexpr edge = 10, a_few_chains = 0.15 * edge;
    for (auto const& [ranks, longest] : {std::pair{2, edge}, {4, edge}, {6, edge}, {8, edge / 2}}) {
        std::vector<PlacedChain> chains = scattered(4000, {{edge, edge, edge}});
        for (PlacedChain& chain : chains) chain.bodies = 20;
        std::vector<int> const order = compact_order(chains, ranks);
        std::int64_t all = 0, before = 0;
        for (PlacedChain const& chain : chains) all += chain.bodies;
        std::vector<Vec3> least(static_cast<std::size_t>(ranks), Vec3{{edge, edge, edge}}),
            most(least.size(), Vec3::zero());
        std::vector<std::int64_t> share(least.size(), 0);
        for (int const k : order) {
            PlacedChain const& chain = chains[static_cast<std::size_t>(k)];
            auto const rank =
                static_cast<std::size_t>((2 * before + chain.bodies) * ranks / (2 * all));
            before += chain.bodies;
            share[rank] += chain.bodies;
            for (int i = 0; i < 3; ++i) {
                least[rank][i] = std::min(least[rank][i], chain.middle[i]);
                most[rank][i] = std::max(most[rank][i], chain.middle[i]);
            }
        }
        for (std::size_t rank = 0; rank < share.size(); ++rank) {
            EXPECT_NEAR(static_cast<double>(share[rank]), static_cast<double>(all) / ranks, 20);
            Vec3 const side = most[rank] - least[rank];
            double const volume = side[0] * side[1] * side[2];
            EXPECT_LT(volume, 1.3 * edge * edge * edge / ranks) << ranks;
            EXPECT_LT(*std::max_element(side.data, side.data + 3), longest + a_few_chains) << ranks;
        }
    }
}

}  // namespace
}  // namespace catena::test
