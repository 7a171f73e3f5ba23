#include <gtest/gtest.h>

#include "tests/plan/told_machine.hpp"

namespace catena::test {
namespace {

plan::LevelPlan told_levels(std::int64_t bodies) {
    plan::Planner planner(told_machine(true), {}, 65536);
    return planner.plan_levels(plan::shares_of(told_scene(bodies), Axes::joint, 1));
}

/// By hand: 8 bodies, 4 + 2 + 1 merges; the told costs are linear, so only the curve's logarithms
/// stand between.
TEST(LevelPlan, SumsWhatEachPlaceDoesAndWhatCrosses) {
    plan::LevelPlan const levels = told_levels(8);
    ASSERT_EQ(levels.levels(), 3);
    EXPECT_EQ(levels.rows()[0].items, 8);
    EXPECT_EQ(levels.rows()[1].items, 4);
    EXPECT_EQ(levels.rows()[3].items, 1);
    double const host = 2 * 8e-6 + 1.5 * 0.5e-6 * 7;
    EXPECT_NEAR(levels.seconds({0, 0}), host, 0.05 * host);
    double const gpu =
        2e-5 + 1.5 * 3e-5 +
        15e-6;  // bodies, levels, three transfers; each merge and item next to nothing
    EXPECT_NEAR(levels.seconds({3, 3}), gpu, 0.02 * gpu);
}

TEST(LevelPlan, TheBestIsTheLeastOfAll) {
    for (std::int64_t const bodies : {1, 2, 100, 3000, 40000}) {
        plan::LevelPlan const levels = told_levels(bodies);
        GpuLevels const best = levels.best();
        for (int up = 0; up <= levels.levels(); ++up)
            for (int down = 0; down <= levels.levels(); ++down)
                EXPECT_LE(levels.seconds(best), levels.seconds({up, down}));
    }
    EXPECT_EQ(told_levels(2).best().up, 0);
    GpuLevels const many = told_levels(40000).best();
    EXPECT_GT(many.up, 5);
    EXPECT_LT(many.up, 16);  // the top's few merges are the host's
}

/// The real measurement, with the host's part in the GPU's place: every cost is there, and more
/// bodies cost more.
TEST(LevelCosts, AreMeasuredForEveryFamily) {
    auto const executor = serial_executor();
    for (plan::Family const& family : plan::all_families()) {
        SCOPED_TRACE(family.name());
        auto const few =
            plan::measure_level_costs(family, 16, dca::host_levels(*executor), {3, 20, 0.005});
        auto const many =
            plan::measure_level_costs(family, 2048, dca::host_levels(*executor), {3, 20, 0.02});
        for (plan::LevelCost const cost :
             {plan::bodies_up, plan::bodies_down, plan::merges_up, plan::merges_down})
            EXPECT_GT(many[cost], few[cost]) << plan::level_cost_names[cost];
        EXPECT_GT(few[plan::bodies_up], 0);
    }
}

}  // namespace
}  // namespace catena::test
