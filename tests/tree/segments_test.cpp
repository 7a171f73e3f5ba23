#include "tree/segments.hpp"

#include <gtest/gtest.h>

#include <set>

namespace catena::dca {
namespace {

/// Schedule of two chains, of 7 and of 300 bodies, on one rank.
Schedule schedule() { return make_schedule(Partition({7, 300}, false, 1), 0); }

TEST(Segments, RunsAreNeededAlongTheChains) {
    Schedule const s = schedule();
    Segments const segments(s.runs, s.levels, s.slots);
    std::vector<std::int64_t> const needed = segments.needed(0, static_cast<int>(s.levels.size()));
    std::vector<std::int64_t> merged;  // a chain of one run has no merge
    for (dca::Run const& run : s.runs)
        if (segments.of(run.slot).met >= 0) merged.push_back(run.slot);
    ASSERT_GT(merged.size(), 1U);
    EXPECT_EQ(needed, merged);
    std::vector<std::int64_t> reversed(merged.rbegin(), merged.rend());
    segments.sort(reversed);
    EXPECT_EQ(reversed, merged);
}

TEST(Segments, RootsContainAllRuns) {
    Schedule const s = schedule();
    int const end = static_cast<int>(s.levels.size());
    Segments const segments(s.runs, s.levels, s.slots);
    std::set<std::int64_t> tops;
    for (dca::Run const& run : s.runs) {
        std::int64_t const top = segments.ancestor(run.slot, end);
        EXPECT_TRUE(segments.is_top(top, end));
        EXPECT_EQ(segments.of(run.slot).whole, segments.of(top).joint);
        EXPECT_EQ(segments.ancestor(run.slot, 0), run.slot);
        tops.insert(top);
    }
    std::set<std::int64_t> roots;
    std::int64_t leaves = 0;
    for (Root const& root : s.roots) {
        roots.insert(root.slot);
        leaves += segments.of(root.slot).leaves;
    }
    EXPECT_EQ(tops, roots);
    EXPECT_EQ(leaves, std::ssize(s.runs));
}

}  // namespace
}  // namespace catena::dca
