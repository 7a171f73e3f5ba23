#include "tree/stage_encoding.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "dca/articulated_sweeps.hpp"

namespace catena::dca {
namespace {

class Stages : public ::testing::TestWithParam<std::vector<std::int64_t>> {};

/// Directions of every joint, so that they tell one from the other.
std::vector<std::uint8_t> restricted(Schedule const& s) {
    std::vector<std::uint8_t> all(static_cast<std::size_t>(s.joints));
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<std::uint8_t>(k % 251);
    return all;
}

/// Climbs and descends the stages as a device does. A segment is the joints at its ends, a force
/// the joint that it belongs to.
class Walk {
  public:
    Walk(Schedule const& s, std::vector<Run> const& runs,
         std::vector<std::vector<Merge>> const& levels, std::vector<Root> const& roots,
         StageSizes const& sizes)
        : runs_(runs),
          sizes_(sizes),
          plan_(plan_stages(runs, levels, roots, s.slots, restricted(s), sizes)),
          segment_(index(s.slots)),
          around_(index(s.joints)),
          inner_(index(s.joints), 0),
          known_(index(s.joints), 0) {
        std::size_t merges = 0;
        for (auto const& level : levels)
            for (Merge const& m : level) {
                inner_[index(m.joint)] = 1;
                around_[index(m.joint)] = {m.first, m.next};
                ++merges;
                if (runs.empty()) {  // what other ranks or trees made
                    if (segment_[index(m.inboard)].first < 0)
                        segment_[index(m.inboard)] = {m.first, m.joint};
                    if (segment_[index(m.outboard)].first < 0)
                        segment_[index(m.outboard)] = {m.joint, m.next};
                    segment_[index(m.slot)] = {};
                }
            }
        if (plan_.runs_apart)
            for (Run const& run : runs) segment_[index(run.slot)] = {run.body, run.next};
        for (Stage const& stage : plan_.stages)
            if (stage.of_runs) {
                EXPECT_GE(threads_for(stage, sizes_), parts_of_run * stage.width);
            }
        for (Stage const& stage : plan_.stages)
            for (std::int64_t b = 0; b < stage.blocks(); ++b) climb(stage, index(b));
        EXPECT_EQ(merged_, merges);
        EXPECT_EQ(closed_, roots.size());
        for (std::size_t i = plan_.stages.size(); i-- > 0;)
            for (std::int64_t b = 0; b < plan_.stages[i].blocks(); ++b)
                descend(plan_.stages[i], index(b));
        EXPECT_EQ(parted_, merges);
        std::int64_t made = 0;
        for (std::size_t j = 0; j < inner_.size(); ++j) made += inner_[j] && known_[j];
        EXPECT_EQ(made, static_cast<std::int64_t>(merges));
        for (FrontierUnit const& unit : s.shared)
            EXPECT_TRUE(runs.empty() || !unit.is_own || segment_[index(unit.slot)].first >= 0)
                << "not there for other ranks";
        std::int64_t own_units = 0;
        for (FrontierUnit const& unit : s.shared) own_units += unit.is_own ? 1 : 0;
        if (!runs.empty() && own_units > 0 && own_units <= sizes_.most) {
            EXPECT_EQ(plan_.stages.back().blocks(), 1) << "no block has all units";
            if (Stage const& last = plan_.stages.back(); last.width + own_units <= sizes_.most) {
                EXPECT_EQ(std::ssize(last.segments_up), own_units);
            }
        }
        StagesTogether const together(plan_, sizes_);
        for (std::int32_t const item : together.places.segment) EXPECT_TRUE(!together || item >= 0);
        for (Stage const& stage : plan_.stages) {
            std::vector<StageWord> const words = words_of(stage, together);
            StageLayout const layout = layout_of(stage);
            EXPECT_EQ(std::ssize(words), stage.blocks() * layout.words());
            for (std::size_t b = 0; b < stage.root.size(); ++b) {
                if (stage.root[b].begin == stage.root[b].end) continue;
                StageRoot const& closed = stage.roots[index(stage.root[b].begin)];
                StageRoot const& first =
                    BlockEncoding(layout, words.data() + b * index(layout.words())).head().root;
                EXPECT_EQ(first.place, closed.place);
                EXPECT_EQ(first.restricted, closed.restricted);
                EXPECT_EQ(first.root.first, closed.root.first);
            }
            EXPECT_LE(stage.width, sizes.most);
            EXPECT_LE(stage.forces, 2 * stage.width);
        }
    }

  private:
    struct Ends {
        std::int64_t first = -1, next = -1;
    };
    static std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }
    template <class Action>
    static void each(Range const& range, Action const& action) {
        for (std::int64_t i = range.begin; i < range.end; ++i) action(index(i));
    }
    Ends item(Stage const& stage, std::size_t i) const {
        if (!stage.of_runs) return segment_[index(stage.items[i].slot)];
        EXPECT_EQ(runs_[i].slot, stage.items[i].slot);
        return {runs_[i].body, runs_[i].next};
    }

    void climb(Stage const& stage, std::size_t b) {
        std::size_t const begin = index(stage.item[b].begin);
        std::vector<Ends> own(index(stage.width));
        each(stage.item[b], [&](std::size_t i) {
            own.at(i - begin) = item(stage, i);
            EXPECT_EQ(own.at(i - begin).first, stage.items[i].joint);
        });
        for (int l = 0; l < stage.levels; ++l)
            each(stage.merge[b * index(stage.levels) + index(l)], [&](std::size_t i) {
                StageMerge const& m = stage.merges[i];
                Ends &inboard = own.at(index(m.inboard)), &outboard = own.at(index(m.outboard));
                EXPECT_GE(inboard.first, 0);
                EXPECT_EQ(m.restricted, m.joint % 251);
                EXPECT_EQ(inboard.next, m.joint);
                EXPECT_EQ(outboard.first, m.joint);
                inboard.next = outboard.next;
                outboard = {};
                ++merged_;
            });
        each(stage.up[b], [&](std::size_t i) {
            StageTransfer const& up = stage.segments_up[i];
            Ends const &made = own.at(index(up.place)), &before = segment_[index(up.at)];
            bool const is_handed_on = before.first == made.first && before.next == made.next;
            EXPECT_TRUE(plan_.runs_apart || runs_.empty() || is_handed_on || before.first == -1)
                << "made twice";
            segment_[index(up.at)] = made;
            EXPECT_GE(segment_[index(up.at)].first, 0);
        });
        each(stage.root[b], [&](std::size_t i) {
            StageRoot const& closed = stage.roots[i];
            EXPECT_EQ(own.at(index(closed.place)).first, closed.root.first);
            EXPECT_EQ(closed.restricted, closed.root.first % 251);
            EXPECT_EQ(own.at(index(closed.place)).next, closed.root.next);
            ++closed_;
        });
    }
    void descend(Stage const& stage, std::size_t b) {
        std::size_t const begin = index(stage.item[b].begin);
        std::vector<std::int64_t> own(index(stage.forces), -1);
        each(stage.down[b], [&](std::size_t i) {
            StageTransfer const& down = stage.forces_down[i];
            EXPECT_TRUE(!inner_[index(down.at)] || known_[index(down.at)])
                << "nobody has found the force at " << down.at;
            own.at(index(down.place)) = down.at;
        });
        for (int l = stage.levels; l-- > 0;)
            each(stage.merge[b * index(stage.levels) + index(l)], [&](std::size_t i) {
                StageMerge const& m = stage.merges[i];
                Ends const around = around_[index(m.joint)];
                EXPECT_EQ(own.at(index(m.inboard)), around.first) << "joint " << m.joint;
                EXPECT_EQ(own.at(index(m.next)), around.next) << "joint " << m.joint;
                EXPECT_EQ(own.at(index(m.outboard)), -1) << "at joint " << m.joint;
                own.at(index(m.outboard)) = m.joint;
                ++parted_;
            });
        each(stage.item[b], [&](std::size_t i) {
            EXPECT_EQ(own.at(i - begin), stage.items[i].joint);
            EXPECT_TRUE(!stage.of_runs || own.at(index(stage.items[i].next)) == runs_[i].next);
            if (stage.items[i].given) return;  // others may read it meanwhile
            EXPECT_TRUE(stage.of_runs || !known_[index(stage.items[i].joint)]) << "written twice";
            known_[index(stage.items[i].joint)] = 1;
        });
    }

    std::vector<Run> const& runs_;
    StageSizes sizes_;
    StagePlan plan_;
    std::vector<Ends> segment_, around_;  // by slot; of the segment that is joined at a joint
    std::vector<std::uint8_t> inner_,
        known_;  // by joint: whether a merge finds its force; whether it has
    std::size_t merged_ = 0, parted_ = 0, closed_ = 0;
};

TEST_P(Stages, EveryItemIsDoneOnceAndAfterWhatItNeeds) {
    std::vector<StageSizes> const all_sizes = {{1, 2, 0},
                                               {4, 8, 2},
                                               stage_sizes(stage_records(1, true), 232448, 8),
                                               stage_sizes(stage_records(3, true), 101376, 0),
                                               stage_sizes(stage_records(6, false), 232448, 8)};
    bool const large = *std::max_element(GetParam().begin(), GetParam().end()) > 100000;
    for (int const ranks : large ? std::vector<int>{1, 3} : std::vector<int>{1, 2, 3, 5})
        for (bool const pairwise :
             large ? std::vector<bool>{false} : std::vector<bool>{false, true})
            for (StageSizes const& sizes : all_sizes) {
                Partition const partition(GetParam(), pairwise, ranks);
                for (int rank = 0; rank < ranks; ++rank) {
                    SCOPED_TRACE(testing::Message() << "rank " << rank << " of " << ranks
                                                    << ", threads " << sizes.threads << ", at most "
                                                    << sizes.most << ", pairwise " << pairwise);
                    Schedule const s = make_schedule(partition, rank);
                    Walk(s, s.runs, s.levels, s.roots, sizes);
                    Walk(s, {}, s.top_levels, s.top_roots, sizes);
                    if (HasFailure()) return;
                }
            }
}
TEST_P(Stages, BlocksHoldAChainEach) {
    std::vector<std::int64_t> const& lengths = GetParam();
    Schedule const s = make_schedule(Partition(lengths, false, 1), 0);
    std::vector<std::int64_t> last;
    for (std::int64_t const n : lengths) last.push_back((last.empty() ? -1 : last.back()) + n);
    BlockPlan const plan = plan_blocks(s, last);
    ASSERT_EQ(plan.blocks(), std::ssize(lengths));
    std::int64_t runs = 0, merges = 0;
    for (std::size_t b = 0; b < plan.body.size(); ++b) {
        Range const body = plan.body[b], run = plan.run[b];
        EXPECT_EQ(body.begin, b == 0 ? 0 : plan.body[b - 1].end);
        EXPECT_EQ(body.end - 1, last[b]);
        EXPECT_EQ(plan.tip[b].begin, static_cast<std::int64_t>(b));
        EXPECT_EQ(plan.tip[b].end, static_cast<std::int64_t>(b) + 1);
        EXPECT_EQ(s.roots[static_cast<std::size_t>(plan.root[b].begin)].first, body.begin);
        EXPECT_EQ(s.runs[static_cast<std::size_t>(run.begin)].body, body.begin);
        EXPECT_EQ(s.runs[static_cast<std::size_t>(run.end - 1)].body +
                      s.runs[static_cast<std::size_t>(run.end - 1)].count,
                  body.end);
        runs += run.end - run.begin;
        std::int64_t offset = 0;
        for (int l = 0; l < plan.levels; ++l) {
            auto const& level = s.levels[static_cast<std::size_t>(l)];
            Range const range =
                plan.merge[b * static_cast<std::size_t>(plan.levels) + static_cast<std::size_t>(l)];
            for (std::int64_t i = range.begin; i < range.end; ++i) {
                std::int64_t const joint = level.at(static_cast<std::size_t>(i - offset)).joint;
                EXPECT_TRUE(joint > body.begin && joint < body.end);
            }
            merges += range.end - range.begin;
            offset += std::ssize(level);
        }
    }
    EXPECT_EQ(runs, std::ssize(s.runs));
    EXPECT_EQ(merges, std::ssize(s.runs) - std::ssize(lengths));
}
std::vector<std::int64_t> with_short_ones(std::int64_t bodies, std::int64_t of_short) {
    std::vector<std::int64_t> lengths(501, of_short);
    lengths[0] = bodies;
    return lengths;
}
INSTANTIATE_TEST_SUITE_P(Scenes, Stages,
                         ::testing::Values(std::vector<std::int64_t>{1},
                                           std::vector<std::int64_t>{3},
                                           std::vector<std::int64_t>{257},
                                           std::vector<std::int64_t>{4099},
                                           std::vector<std::int64_t>{1000001},
                                           std::vector<std::int64_t>{7, 300, 2, 1000},
                                           std::vector<std::int64_t>{5000, 70, 4100},
                                           std::vector<std::int64_t>(3000, 140),
                                           with_short_ones(4128, 8), with_short_ones(300000, 16)));

/// With a segment a thread for the parts of runs.
TEST(Stages, BlocksFindRoomInSmallSharedMemories) {
    for (std::int64_t const shared_bytes : {65536, 101376, 166912, 232448})
        for (StageRecords const& records :
             {stage_records(1, true), stage_records(2, true), stage_records(3, true),
              stage_records(4, true), stage_records(5, true), stage_records(6, false),
              ArticulatedSweeps<ArticulatedLeaf<false>>::in_stage}) {
            StageSizes const sizes = stage_sizes(records, shared_bytes, 0);
            Schedule const s = make_schedule(Partition({100000}, false, 1), 0);
            Stage const stage =
                plan_stages(s.runs, s.levels, s.roots, s.slots, restricted(s), sizes)
                    .stages.front();
            ASSERT_TRUE(stage.of_runs);
            std::int64_t const threads = threads_for(stage, sizes);
            EXPECT_GE(threads, parts_of_run * stage.width);
            std::int64_t const of_words =
                layout_of(stage).words() * static_cast<std::int64_t>(sizeof(StageWord));
            EXPECT_LE(of_words + 8 * (records.segment * (threads + stage.width) +
                                      2 * records.state * stage.width),
                      shared_bytes)
                << records.segment << " numbers";
        }
}

TEST(Stages, OneLaunchUpToAHundredThousandBodiesAndFiveForAny) {
    /// Launches of a sweep up and down, on a GPU of which so many blocks run at once.
    auto const launches = [](std::vector<std::int64_t> const& lengths, int directions) {
        StageSizes const sizes =
            stage_sizes(stage_records(directions, directions < 6), 232448, 132);
        Schedule const s = make_schedule(Partition(lengths, false, 1), 0);
        StagePlan const plan =
            plan_stages(s.runs, s.levels, s.roots, s.slots, restricted(s), sizes);
        return 2 * (std::ssize(plan.stages) - (StagesTogether(plan, sizes) ? 2 : 1) +
                    (plan.runs_apart ? 1 : 0)) +
               1;
    };
    for (int const directions : {1, 3}) {
        EXPECT_EQ(launches({1}, directions), 1);
        EXPECT_EQ(launches({8192}, directions), 1);
        EXPECT_EQ(launches(std::vector<std::int64_t>(100, 140), directions), 1);
        EXPECT_EQ(launches({1 << 17}, directions), 1);
        for (std::int64_t runs = 131 * 64 - 1; runs <= 132 * 64 + 1; ++runs)
            EXPECT_LE(launches({16 * runs}, directions), 3);
        EXPECT_EQ(launches({1 << 20}, directions), 3);
        EXPECT_LE(launches({1 << 24}, directions), 5);
    }
    EXPECT_EQ(launches({4096}, 6), 1);
}

}  // namespace
}  // namespace catena::dca
