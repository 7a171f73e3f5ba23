#include "page/run_facts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "error.hpp"
#include "page/observable_statistics.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::ordered_json;

/// A table whose energy starts `high` above its mean of -50 and forgets that within 5 frames.
ObservablesTable table_of(std::size_t frames, double high) {
    ObservablesTable table{{"step", "time [ps]", "total_energy [kJ/mol]", "constraint_error [1]"},
                           std::vector<std::vector<double>>(4)};
    std::mt19937_64 draw(3);
    std::normal_distribution<double> normal(-50, 1);
    for (std::size_t i = 0; i < frames; ++i) {
        auto const at = static_cast<double>(i);
        table.columns[0].push_back(10 * at);
        table.columns[1].push_back(0.1 * at);
        table.columns[2].push_back(normal(draw) + high * std::exp(-at / 5));
        table.columns[3].push_back(1e-12 * at);
    }
    return table;
}

TEST(ObservableStatistics, LeaveTheEquilibrationOutAndSaySo) {
    TableStatistics const found = statistics_of(table_of(400, 200), Frames::equilibrated);
    EXPECT_GT(found.left_out, 20U);
    EXPECT_LT(found.left_out, 200U);
    ASSERT_EQ(found.observables.size(), 2U);
    ObservableStatistics const& energy = found.observables[0];
    EXPECT_EQ(energy.name, "total_energy");
    EXPECT_EQ(energy.unit, "kJ/mol");
    EXPECT_EQ(energy.samples, std::int64_t(400 - found.left_out));
    EXPECT_NEAR(energy.mean, -50, 5 * energy.standard_error);
    EXPECT_NEAR(energy.standard_error, 1 / std::sqrt(energy.samples), 0.03);
    EXPECT_EQ(found.says, "The first " + std::to_string(found.left_out) +
                              " of 400 frames, before step " + std::to_string(10 * found.left_out) +
                              ", are left out as equilibration of the total energy.");
}

TEST(ObservableStatistics, SayWhyEveryFrameCounts) {
    EXPECT_EQ(statistics_of(table_of(400, 200), Frames::without_thermostat).left_out, 0U);
    EXPECT_EQ(statistics_of(table_of(400, 200), Frames::without_thermostat).says,
              "All 400 frames count: there is no thermostat, so no equilibration is left out.");
    EXPECT_EQ(statistics_of(table_of(11, 200), Frames::equilibrated).says,
              "All 11 frames count, equilibration included: fewer than 20 frames do not show where "
              "it ends.");
    EXPECT_EQ(statistics_of(table_of(30, 0), Frames::all).says, "All 30 frames count.");
    EXPECT_EQ(statistics_of(table_of(1, 0), Frames::all).says, "The only frame counts.");
    EXPECT_TRUE(statistics_of(table_of(0, 0), Frames::equilibrated).observables.empty());
}

/// The constraint error rises all the time here; the energy alone decides.
TEST(ObservableStatistics, TheConstraintErrorCutsNothing) {
    EXPECT_LT(statistics_of(table_of(400, 0), Frames::equilibrated).left_out, 100U);
}

TEST(ObservableStatistics, ADriftThatNeverEndsIsSaid) {
    ObservablesTable table = table_of(100, 0);
    for (std::size_t i = 0; i < 100; ++i) table.columns[2][i] = static_cast<double>(i);
    TableStatistics const found = statistics_of(table, Frames::equilibrated);
    EXPECT_EQ(found.left_out, 50U);
    EXPECT_NE(found.says.find("the run may not have reached equilibrium"), std::string::npos);
    EXPECT_FALSE(found.observables[0].converged);
}

/// The mean of replicas that stay where they started has no scatter in time: the error is theirs.
TEST(ObservableStatistics, ReplicasAreIndependent) {
    std::size_t constexpr frames = 40, replicas = 64;
    ObservablesTable means{{"step", "time [ps]", "temperature [K]", "mean_radius [nm]"},
                           std::vector<std::vector<double>>(4)},
        each{{"step", "time [ps]"}, std::vector<std::vector<double>>(2 + replicas)};
    std::mt19937_64 draw(5);
    std::normal_distribution<double> normal(3, 0.8);
    std::vector<double> radius(replicas);
    double mean = 0;
    for (double& r : radius) mean += (r = normal(draw)) / replicas;
    for (std::size_t r = 0; r < replicas; ++r)
        each.names.push_back("radius_replica_" + std::to_string(r + 1));
    for (std::size_t f = 0; f < frames; ++f) {
        for (ObservablesTable* table : {&means, &each}) {
            table->columns[0].push_back(static_cast<double>(f));
            table->columns[1].push_back(0.1 * static_cast<double>(f));
        }
        means.columns[2].push_back(300);
        means.columns[3].push_back(mean);
        for (std::size_t r = 0; r < replicas; ++r) each.columns[2 + r].push_back(radius[r]);
    }
    TableStatistics const found = statistics_of(means, Frames::equilibrated, each);
    ObservableStatistics const& of = found.observables[1];
    EXPECT_EQ(found.observables[0].replicas, 0);
    EXPECT_EQ(of.replicas, 64);
    EXPECT_NEAR(of.mean, 3, 4 * of.standard_error);
    EXPECT_NEAR(of.between_replicas, 0.1, 0.03);
    EXPECT_NEAR(of.standard_error, of.between_replicas, 1e-3);
    EXPECT_TRUE(of.converged);
    EXPECT_NE(found.says.find("over 64 replicas"), std::string::npos);
    each.columns[0].back() = -1;
    EXPECT_THROW(statistics_of(means, Frames::equilibrated, each), InputError);
}

/// Replicas that walk away from one start have too small an error.
TEST(ObservableStatistics, ReplicasThatStillSpreadAreNamed) {
    ObservablesTable means{{"step", "time [ps]", "mean_radius [nm]"},
                           std::vector<std::vector<double>>(3)},
        each{{"step", "time [ps]"}, std::vector<std::vector<double>>(2)};
    std::mt19937_64 draw(6);
    std::normal_distribution<double> normal(0, 0.1);
    std::vector<double> at(64, 3);
    for (std::size_t r = 0; r < at.size(); ++r) {
        each.names.push_back("radius_replica_" + std::to_string(r + 1));
        each.columns.emplace_back();
    }
    for (std::size_t f = 0; f < 60; ++f) {
        for (ObservablesTable* table : {&means, &each}) {
            table->columns[0].push_back(static_cast<double>(f));
            table->columns[1].push_back(0.1 * static_cast<double>(f));
        }
        double mean = 0;
        for (std::size_t r = 0; r < at.size(); ++r) {
            each.columns[2 + r].push_back(at[r]);
            mean += at[r] / static_cast<double>(at.size());
            at[r] += normal(draw);
        }
        means.columns[2].push_back(mean);
    }
    TableStatistics const found = statistics_of(means, Frames::all, each);
    EXPECT_FALSE(found.observables[0].converged);
    EXPECT_NE(found.says.find("Replicas still spread"), std::string::npos);
}

TEST(RunFacts, MeanAndErrorEndAtTheSameDecimal) {
    using Texts = std::pair<std::string, std::string>;
    EXPECT_EQ(rounded_alike(300.2345, 0.1234), Texts("300.23", "0.12"));
    EXPECT_EQ(rounded_alike(-1234.5, 87.3), Texts("-1234", "87"));
    EXPECT_EQ(rounded_alike(2.5e-12, 1.3e-13), Texts("2.50e-12", "1.3e-13"));
    EXPECT_EQ(rounded_alike(2.23983858399483, 2.2e-13), Texts("2.23984", "2.2e-13"));
    EXPECT_EQ(rounded_alike(-2.5e-9, 3e-18), Texts("-2.5e-09", "3.0e-18"));
    EXPECT_EQ(rounded_alike(300.2345, 4e-4), Texts("300.23450", "0.00040"));
    EXPECT_EQ(rounded_alike(1.5, 0), Texts("1.5", "0"));
    EXPECT_EQ(rounded_alike(1.5, NAN), Texts("1.5", "-"));
    EXPECT_EQ(rounded_alike(NAN, NAN), Texts("-", "-"));
}

Json summary_of_run() {
    Json summary = Json::parse(R"x({
        "units": {"length": "nm", "time": "ps", "energy": "kJ/mol"},
        "system": {"description": "2 chains of 10 beads (a-1 to a-2)", "forces": "calvados2 at 300 K and 0.15 mol/l",
                   "box": [20, 20, 30], "mass_concentration": 12.5, "chain_concentration": 2.767e-4},
        "run": {"integrator": "g-baoab", "step": 0.01, "first_step": 100, "last_step": 600, "time": 6, "simulated_time": 5,
                "temperature": 300, "friction": 0.01},
        "speed": {"seconds": 2, "steps_per_second": 250, "ns_per_day": 216, "milliseconds_per_step": 4},
        "valid": true,
        "verdict": {"valid": true, "checks": [
            {"name": "joints", "passed": true, "value": 2e-12, "limit": 1e-10, "step": 3, "advice": ""}
        ]}
    })x");
    summary.update(json_of(statistics_of(table_of(8, 0), Frames::equilibrated)));
    return summary;
}

TEST(RunFacts, BeginWithTheSystemAndItsUnits) {
    std::string text;
    for (Fact const& fact : system_facts(summary_of_run()))
        text += fact.name + ": " + fact.value + "\n";
    EXPECT_EQ(text,
              "system: 2 chains of 10 beads (a-1 to a-2)\n"
              "forces: calvados2 at 300 K and 0.15 mol/l\n"
              "box: 20 x 20 x 30 nm, periodic\n"
              "concentration: 12.5 mg/ml, 0.2767 mmol/l of chains, mean over the box\n"
              "temperature: 300 K, Langevin thermostat of friction 0.01/ps\n"
              "integrator: g-baoab, step 0.01 ps\n"
              "simulated time: 5 ps, 500 steps, from step 100 to 600; 6 ps since the scene's "
              "start\n");
}

TEST(RunFacts, AFewFramesGiveAnErrorThatIsAtLeast) {
    std::vector<ObservableRow> const rows = observable_rows(summary_of_run());
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].name, "total energy");
    EXPECT_EQ(rows[0].unit, "kJ/mol");
    EXPECT_TRUE(rows[0].standard_error.starts_with("at least 0.")) << rows[0].standard_error;
    EXPECT_EQ(rows[1].unit, "");
}

TEST(RunFacts, SpeedIsSimulatedTimePerDayAndTimePerStep) {
    Json summary = summary_of_run();
    EXPECT_EQ(speed_facts(summary)[0].value, "216 ns");
    EXPECT_EQ(speed_facts(summary)[1].value, "4 ms, 250 steps/s");
    summary["speed"].erase("ns_per_day");
    summary["speed"]["simulated_seconds_per_day"] = 0.5;
    EXPECT_EQ(speed_facts(summary)[0].value, "0.5 s");
}

TEST(RunFacts, TheVerdictHasAReason) {
    Json summary = summary_of_run();
    EXPECT_EQ(verdict_reason(summary), "every check is within its limit: joints 2e-12 of 1e-10");
    summary["verdict"]["checks"].push_back({{"name", "energy"},
                                            {"passed", false},
                                            {"value", 1},
                                            {"limit", 0.1},
                                            {"step", 600},
                                            {"advice", "choose a smaller dynamics.step"}});
    EXPECT_EQ(verdict_reason(summary), "energy at step 600: choose a smaller dynamics.step");
}

TEST(RunFacts, WhatASummaryLacksIsLeftOut) {
    Json const empty = Json::object();
    EXPECT_TRUE(system_facts(empty).empty());
    EXPECT_TRUE(observable_rows(empty).empty());
    EXPECT_TRUE(speed_facts(empty).empty());
    EXPECT_EQ(verdict_reason(empty), "");
    EXPECT_EQ(equilibration_sentence(empty), "");
}

}  // namespace
}  // namespace catena::test
