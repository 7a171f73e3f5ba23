// Paths of branched chains.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
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

TEST_P(Paths, HangOnBodiesOfLaterPhases) {
    Branches const b(GetParam(), false);
    std::vector<std::int64_t> phase_of_root(b.paths(), -1), forks(b.paths(), 0);
    for (std::int64_t phase = 0; phase < b.phases(); ++phase)
        for (Root const& root : b.lists[phase].roots) {
            EXPECT_EQ(root.first, b.first_of_path[root.chain]);
            phase_of_root[root.chain] = phase;
        }
    for (std::int64_t phase = 0; phase < b.phases(); ++phase)
        for (std::int64_t f = b.first_fork_of_phase[phase]; f < b.first_fork_of_phase[phase + 1];
             ++f) {
            Fork const& fork = b.forks[f];
            ASSERT_GT(fork.paths(), 0);
            std::int64_t last = -1;
            for (std::int64_t path = fork.first_path; path < fork.end_path; ++path) {
                EXPECT_EQ(GetParam()[b.body[b.first_of_path[path]]], b.body[fork.place]);
                last = std::max(last, phase_of_root[path]);
                ++forks[path];
            }
            EXPECT_EQ(phase, last + 1);
        }
    EXPECT_EQ(b.first_fork_of_phase.back(), std::ssize(b.forks));
    for (std::int64_t path = 0; path < b.paths(); ++path)  // each side path hangs on one body
        EXPECT_EQ(forks[path], path < b.first_side() ? 0 : 1);
    EXPECT_LE(b.phases(), 1 + std::bit_width(GetParam().size()));
}

/// Every segment is there when it is needed, and covers bodies one after the other.
TEST_P(Paths, MergeNeighboursThatAreThere) {
    for (bool const pairwise : {false, true}) {
        Branches const b(GetParam(), pairwise);
        std::vector<std::pair<std::int64_t, std::int64_t>> of_slot(b.slots, {-1, -1});
        auto const take = [&](std::int64_t slot, std::int64_t first, std::int64_t next) {
            EXPECT_EQ(of_slot[slot], std::pair(first, next));
            of_slot[slot] = {-2, -2};
        };
        for (PhaseLists const& lists : b.lists) {
            for (dca::Run const& run : lists.runs) {
                EXPECT_EQ(of_slot[run.slot], std::pair(std::int64_t{-1}, std::int64_t{-1}));
                of_slot[run.slot] = {run.body, run.next};
            }
            for (auto const& level : lists.levels) {
                std::vector<Merge> const& merges = level;
                for (Merge const& m : merges) {
                    take(m.inboard, m.first, m.joint);
                    take(m.outboard, m.joint, m.next);
                }
                for (Merge const& m : merges) of_slot[m.slot] = {m.first, m.next};
            }
            for (Root const& root : lists.roots) take(root.slot, root.first, b.joints - 1);
        }
        for (auto const& taken : of_slot) EXPECT_EQ(taken.first, -2);
    }
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

/// First joint, eliminated joint and joint after each merge, level by level.
std::vector<std::vector<std::array<std::int64_t, 3>>> joints_of(
    std::vector<std::vector<Merge>> const& levels) {
    std::vector<std::vector<std::array<std::int64_t, 3>>> joints;
    for (std::vector<Merge> const& level : levels) {
        joints.emplace_back();
        for (Merge const& m : level) joints.back().push_back({m.first, m.joint, m.next});
    }
    return joints;
}

/// Merges and runs are those of the canonical tree, whatever the length.
TEST(Branches, OfALineAreItsTree) {
    for (std::int64_t const bodies : {1, 2, 15, 16, 17, 33, 40, 100, 257, 1000, 5000})
        for (bool const pairwise : {false, true}) {
            Branches const b(line(bodies), pairwise);
            ASSERT_EQ(b.phases(), 1);
            EXPECT_TRUE(b.forks.empty());
            Schedule const expected = make_schedule(Partition({bodies}, pairwise, 1), 0);
            EXPECT_EQ(joints_of(b.lists[0].levels), joints_of(expected.levels)) << bodies;
            ASSERT_EQ(b.lists[0].runs.size(), expected.runs.size());
            for (std::size_t i = 0; i < expected.runs.size(); ++i)
                EXPECT_EQ(b.lists[0].runs[i].count, expected.runs[i].count);
            ChainTree const tree(bodies, run_length_for(pairwise));
            EXPECT_EQ(b.depth(), std::min(tree.run_length, bodies) - 1 + tree.levels());
        }
}

TEST(Branches, OfABinaryTreeHaveAPhaseForEachGeneration) {
    Branches const b(binary(255), false);
    EXPECT_EQ(b.phases(), 8);
    EXPECT_EQ(b.first_of_path[1], 8);  // the longest path
}

/// Each phase of a dendrimer takes one merge and one sum of two steps at most, and not the log2 of
/// a path's length.
TEST(Branches, AreAsDeepAsTheirPhases) {
    for (int const generations : {4, 8, 12, 16})
        EXPECT_LE(Branches(binary((std::int64_t{1} << generations) - 1), false).depth(),
                  2 * generations)
            << generations;
    for (int const levels : {10, 13, 16})
        EXPECT_LE(Branches(random_parents(3, std::int64_t{1} << levels), false).depth(), 6 * levels)
            << levels;
}

}  // namespace
}  // namespace catena::dca
