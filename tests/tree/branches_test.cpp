// Paths of branched chains.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "tree/branches.hpp"

namespace catena::dca {
namespace {

using Parents = std::vector<std::int64_t>;

Parents random_parents(std::uint64_t seed, std::int64_t bodies) {
    Parents parent{-1};
    std::uint64_t state = seed;
    for (std::int64_t k = 1; k < bodies; ++k) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        parent.push_back(static_cast<std::int64_t>((state >> 33) % static_cast<std::uint64_t>(k)));
    }
    return parent;
}
/// A binary tree, generation after generation.
Parents binary(std::int64_t bodies) {
    Parents parent{-1};
    for (std::int64_t k = 1; k < bodies; ++k) parent.push_back((k - 1) / 2);
    return parent;
}
Parents line(std::int64_t bodies) {
    Parents parent(static_cast<std::size_t>(bodies));
    std::iota(parent.begin(), parent.end(), -1);
    return parent;
}

/// Bodies outboard of each body, itself included.
std::vector<std::int64_t> sizes(Parents const& parent) {
    std::vector<std::int64_t> size(parent.size(), 1);
    for (std::size_t k = parent.size(); k-- > 1;)
        if (parent[k] >= 0) size[static_cast<std::size_t>(parent[k])] += size[k];
    return size;
}

class Paths : public ::testing::TestWithParam<Parents> {};
INSTANTIATE_TEST_SUITE_P(Shapes, Paths,
                         ::testing::Values(Parents{-1}, line(100), binary(255),
                                           Parents{-1, 0, 0, 0, 0}, Parents{-1, 0, 0, -1, 3, 3, 4},
                                           random_parents(1, 300), random_parents(2, 1000)));

TEST_P(Paths, HoldEveryBodyOnceAndFollowTheLargestChild) {
    Branches const b(GetParam(), false);
    auto const size = sizes(GetParam());
    std::vector<std::int64_t> bodies = b.body;
    std::sort(bodies.begin(), bodies.end());
    for (std::size_t k = 0; k < bodies.size(); ++k)
        ASSERT_EQ(bodies[k], static_cast<std::int64_t>(k));
    ASSERT_EQ(bodies.size(), GetParam().size());
    for (std::int64_t path = 0; path < b.paths(); ++path)
        for (std::int64_t place = b.first_of_path[path] + 1; place < b.first_of_path[path + 1];
             ++place) {
            std::int64_t const body = b.body[place], inboard = b.body[place - 1];
            ASSERT_EQ(GetParam()[body], inboard);
            for (std::size_t k = 0; k < size.size(); ++k)
                if (GetParam()[k] == inboard) {
                    EXPECT_TRUE(size[k] < size[body] ||
                                (size[k] == size[body] && static_cast<std::int64_t>(k) >= body));
                }
        }
}

TEST_P(Paths, HangOnBodiesOfThePhaseBefore) {
    Branches const b(GetParam(), false);
    std::int64_t next = b.first_of_phase.size() > 1 ? b.first_of_phase[1] : 0;
    for (std::int64_t phase = 0; phase < b.phases(); ++phase) {
        for (std::int64_t f = b.first_fork_of_phase[phase]; f < b.first_fork_of_phase[phase + 1];
             ++f) {
            Fork const& fork = b.forks[f];
            EXPECT_GE(fork.place, b.first_of_path[b.first_of_phase[phase]]);
            EXPECT_LT(fork.place, b.first_of_path[b.first_of_phase[phase + 1]]);
            ASSERT_EQ(fork.first_path, next);  // every side path hangs on one body
            ASSERT_GT(fork.paths(), 0);
            for (next = fork.first_path; next < fork.end_path; ++next)
                EXPECT_EQ(GetParam()[b.body[b.first_of_path[next]]], b.body[fork.place]);
        }
    }
    EXPECT_EQ(next, b.paths());
    EXPECT_LE(b.phases(), 1 + std::bit_width(GetParam().size()));
}

TEST_P(Paths, EliminateEveryJointOnce) {
    for (bool const pairwise : {false, true}) {
        Branches const b(GetParam(), pairwise);
        std::vector<int> count(GetParam().size(), 0);
        for (PhaseLists const& lists : b.lists) {
            for (dca::Run const& run : lists.runs)
                for (std::int64_t i = 1; i < run.count; ++i) ++count[run.body + i];
            for (auto const& level : lists.levels)
                for (Merge const& m : level) ++count[m.joint];
            for (Root const& root : lists.roots) ++count[root.first];
        }
        EXPECT_TRUE(std::all_of(count.begin(), count.end(), [](int c) { return c == 1; }));
    }
}

TEST(Branches, OfALineAreItsTree) {
    Branches const b(line(1000), false);
    EXPECT_EQ(b.phases(), 1);
    EXPECT_TRUE(b.forks.empty());
    EXPECT_EQ(b.depth(), ChainTree(1000, longest_run).depth());
}

TEST(Branches, OfABinaryTreeHaveAPhaseForEachGeneration) {
    Branches const b(binary(255), false);
    EXPECT_EQ(b.phases(), 8);
    EXPECT_EQ(b.first_of_path[1], 8);  // the longest path
    EXPECT_GE(b.depth(), 8);
}

}  // namespace
}  // namespace catena::dca
