#include "dca/stages.hpp"

#include <gtest/gtest.h>

namespace catena::dca {
namespace {

class Stages : public ::testing::TestWithParam<std::vector<std::int64_t>> {};

/// Walks the stages as a device does and notes who made each slot when.
class Walk {
  public:
    Walk(Schedule const& s, StagePlan plan) : runs_(s.runs), plan_(std::move(plan)), made_(static_cast<std::size_t>(s.slots)) {
        for (auto const& level : s.levels) merges_.insert(merges_.end(), level.begin(), level.end());
        if (plan_.runs_apart)
            for (Run const& run : runs_) make(run.slot, {-1, 0, 0});
        for (int i = 0; i < static_cast<int>(plan_.stages.size()); ++i)
            for (int b = 0; b < plan_.stages[static_cast<std::size_t>(i)].blocks(); ++b) do_block(i, b);
        EXPECT_EQ(done_, runs_.size() + merges_.size());
        EXPECT_EQ(closed_, s.roots.size());
        EXPECT_LE(plan_.stages.size(), 2U);
    }

  private:
    struct Made {
        int stage = -2, block = -1, level = -1;
    };
    void do_block(int i, int b) {
        Stage const& stage = plan_.stages[static_cast<std::size_t>(i)];
        auto const block = static_cast<std::size_t>(b);
        if (!stage.run.empty())
            for (std::int64_t r = stage.run[block].begin; r < stage.run[block].end; ++r) make(runs_[r].slot, {i, b, -1});
        for (int l = 0; l < stage.levels; ++l) {
            Range const range = stage.merge[block * static_cast<std::size_t>(stage.levels) + static_cast<std::size_t>(l)];
            for (std::int64_t m = range.begin; m < range.end; ++m) {
                Made const now{i, b, l};
                EXPECT_TRUE(ready(merges_[m].inboard, now) && ready(merges_[m].outboard, now)) << "stage " << i << ", level " << l;
                make(merges_[m].slot, now);
            }
        }
        for (std::int64_t r = stage.root[block].begin; r < stage.root[block].end; ++r) {
            EXPECT_TRUE(ready(plan_.roots[static_cast<std::size_t>(r)].slot, {i, b, stage.levels}));
            ++closed_;
        }
    }
    void make(std::int64_t slot, Made const& by) {
        EXPECT_EQ(made_[static_cast<std::size_t>(slot)].stage, -2) << "made twice";
        made_[static_cast<std::size_t>(slot)] = by;
        ++done_;
    }
    bool ready(std::int64_t slot, Made const& now) const {
        Made const& m = made_[static_cast<std::size_t>(slot)];
        return m.stage >= -1 && (m.stage < now.stage || (m.block == now.block && m.level < now.level));
    }

    std::vector<Run> const& runs_;
    StagePlan plan_;
    std::vector<Merge> merges_;
    std::vector<Made> made_;
    std::size_t done_ = 0, closed_ = 0;
};

TEST_P(Stages, EveryItemIsDoneOnceAndAfterWhatItNeeds) {
    for (int const ranks : {1, 2, 3, 5})
        for (bool const pairwise : {false, true})
            for (std::int64_t const threads : {1, 4, 128}) {
                Partition const partition(GetParam(), pairwise, ranks);
                for (int rank = 0; rank < ranks; ++rank) {
                    SCOPED_TRACE(testing::Message()
                                 << "rank " << rank << " of " << ranks << ", threads " << threads << ", pairwise " << pairwise);
                    Schedule const s = make_schedule(partition, rank);
                    Walk(s, plan_stages(s.runs, s.levels, s.roots, s.slots, threads));
                    if (HasFailure()) return;
                }
            }
}
TEST_P(Stages, BlocksHoldWholeChains) {
    for (std::int64_t const width : {1, 40}) {
        std::vector<std::int64_t> const& lengths = GetParam();
        Schedule const s = make_schedule(Partition(lengths, false, 1), 0);
        std::vector<std::int64_t> last;
        for (std::int64_t const n : lengths) last.push_back((last.empty() ? -1 : last.back()) + n);
        BlockPlan const plan = plan_blocks(s, last, width);
        StagePlan walked;
        walked.stages = {plan.stage};
        walked.roots = plan.roots;
        Walk(s, walked);
        Range before{0, 0}, tips{0, 0};
        for (std::size_t b = 0; b < plan.body.size(); ++b) {
            Range const body = plan.body[b], tip = plan.tip[b], run = plan.stage.run[b];
            EXPECT_EQ(body.begin, before.end);
            EXPECT_EQ(tip.begin, tips.end);
            EXPECT_GT(tip.end, tip.begin);
            EXPECT_EQ(last[static_cast<std::size_t>(tip.end - 1)], body.end - 1) << "a block ends within a chain";
            EXPECT_TRUE(run.end - run.begin <= width || tip.end - tip.begin == 1) << "too many chains in a block";
            before = body;
            tips = tip;
        }
        EXPECT_EQ(before.end, s.bodies);
    }
}
std::vector<std::int64_t> with_short_ones(std::int64_t bodies, std::int64_t of_short) {
    std::vector<std::int64_t> lengths(501, of_short);
    lengths[0] = bodies;
    return lengths;
}
INSTANTIATE_TEST_SUITE_P(Scenes, Stages,
                         ::testing::Values(std::vector<std::int64_t>{1}, std::vector<std::int64_t>{3}, std::vector<std::int64_t>{257},
                                           std::vector<std::int64_t>{4099}, std::vector<std::int64_t>{1000001},
                                           std::vector<std::int64_t>{7, 300, 2, 1000}, std::vector<std::int64_t>(3000, 140),
                                           with_short_ones(4128, 8), with_short_ones(300000, 16)));

TEST(Stages, SmallChainsNeedOneLaunch) {
    auto const plan = [](std::vector<std::int64_t> const& lengths) {
        Schedule const s = make_schedule(Partition(lengths, false, 1), 0);
        return plan_stages(s.runs, s.levels, s.roots, s.slots, 128);
    };
    EXPECT_EQ(plan({2048}).stages.size(), 1U);
    EXPECT_FALSE(plan({2048}).runs_apart);
    EXPECT_EQ(plan(std::vector<std::int64_t>(100, 140)).stages.size(), 1U);
    EXPECT_TRUE(plan({1 << 20}).runs_apart);
}

}  // namespace
}  // namespace catena::dca
