#include "bench/sampling_verdict.hpp"

#include <gtest/gtest.h>

namespace catena::command {
namespace {

SamplingRow row(SamplingMethod method, double step, double gyration, double temperature,
                double error = 0.001) {
    SamplingRow r;
    r.method = method;
    r.step = step;
    r.state = "VALID";
    r.gyration = {gyration, error * gyration, 1, true};
    r.end_to_end = {2 * gyration, error, 1, true};
    r.cosine = {0.1 * gyration, error, 1, true};
    r.temperature = {temperature, 300 * error, 1, true};
    return r;
}

constexpr auto rigid = SamplingMethod::rigid, bonds = SamplingMethod::bonds;

TEST(SamplingVerdict, TheLargestUsableStepHasNoWorseOneBelowIt) {
    std::vector<SamplingRow> const rows{row(rigid, 0.04, 3.0, 300), row(rigid, 0.01, 3.0, 300),
                                        row(rigid, 0.02, 3.006, 301.5), row(rigid, 0.03, 3.0, 306)};
    auto const all = verdicts_of(rows, 300);
    ASSERT_EQ(all.size(), 1U);
    ASSERT_NE(all[0].allowed, nullptr);
    EXPECT_EQ(all[0].allowed->step, 0.02);
    EXPECT_EQ(all[0].shown, all[0].allowed);
    EXPECT_NEAR(all[0].bias[1].gyration().percent, 0.2, 1e-9);
    EXPECT_NEAR(all[0].bias[1].gyration().error, 0.1 * std::hypot(1, 1.002), 1e-9);
    EXPECT_NEAR(all[0].bias[2].temperature().percent, 2, 1e-9);
    EXPECT_STREQ(all[0].bias[2].word(), "no");
    EXPECT_EQ(all[0].bias[0].gyration().error, 0);
}

TEST(SamplingVerdict, ErrorsDecideWhatIsShown) {
    std::vector<SamplingRow> const rows{row(bonds, 0.01, 3, 300),
                                        row(bonds, 0.02, 3.01, 300, 0.005),
                                        row(bonds, 0.03, 3.04, 300, 0.01)};
    SamplingMethodVerdict const v = verdicts_of(rows, 300).front();
    EXPECT_EQ(v.shown, nullptr);
    EXPECT_EQ(v.allowed->step, 0.02);
    EXPECT_STREQ(v.bias[0].word(), "reference");
    EXPECT_STREQ(v.bias[1].word(), "not contradicted");
    EXPECT_STREQ(v.bias[2].word(), "errors too large to tell");
}

/// Chains that all grow alike: the scatter between them is no error of the difference. As they
/// remember the start, a bias may still grow.
TEST(SamplingVerdict, RadiiAreComparedChainByChain) {
    std::vector<SamplingRow> rows{row(rigid, 0.01, 3, 300, 0.05),
                                  row(rigid, 0.02, 3.006, 300, 0.05)};
    rows[0].temperature.error = rows[1].temperature.error = 0.1;
    for (int c = 0; c < 20; ++c) {
        double const own = 2 + 0.1 * c, other = c % 2 ? 0.012 : 0;
        rows[0].gyration_of_chains.push_back(own);
        rows[1].gyration_of_chains.push_back(own + other);
    }
    SamplingMethodVerdict const v = verdicts_of(rows, 300).front();
    EXPECT_NEAR(v.bias[1].gyration().percent, 0.2, 1e-9);
    // 20 differences of 0.006 +- 0.006 nm.
    EXPECT_NEAR(v.bias[1].gyration().error, 100 * 0.006 / std::sqrt(19) / 3, 1e-9);
    EXPECT_STREQ(v.bias[1].word(), "not contradicted");
    // The error of independent rows is as small.
    rows[0].gyration.error = rows[1].gyration.error = 0.001;
    EXPECT_STREQ(verdicts_of(rows, 300).front().bias[1].word(), "shown");
}

TEST(SamplingVerdict, WithoutAPlateauNothingIsShownOrRefuted) {
    std::vector<SamplingRow> rows{row(rigid, 0.01, 3, 300), row(rigid, 0.02, 3, 300),
                                  row(rigid, 0.03, 3, 350)};
    rows[1].gyration.plateau = rows[2].temperature.plateau = false;
    SamplingMethodVerdict const v = verdicts_of(rows, 300).front();
    EXPECT_EQ(v.shown, nullptr);
    EXPECT_STREQ(v.bias[1].word(), "not contradicted");
    EXPECT_STREQ(v.bias[2].word(), "errors too large to tell");
}

TEST(SamplingVerdict, WhatErrorsHideIsNotUsable) {
    std::vector<SamplingRow> const rows{row(rigid, 0.01, 3, 300), row(rigid, 0.02, 3, 300, 0.05)};
    SamplingMethodVerdict const v = verdicts_of(rows, 300).front();
    EXPECT_EQ(v.allowed, nullptr);
    EXPECT_STREQ(v.bias[1].word(), "errors too large to tell");
}

TEST(SamplingVerdict, RigidLinksAreWeighedAsSuch) {
    EXPECT_EQ(measure_of(rigid), BondMeasure::rigid);
    EXPECT_EQ(measure_of(SamplingMethod::constraints), BondMeasure::rigid);
    EXPECT_EQ(measure_of(bonds), BondMeasure::flexible);
    EXPECT_EQ(measure_of(SamplingMethod::rigid_fixman), BondMeasure::flexible);
}

/// An energy near zero beside a large one is judged in units of both.
TEST(SamplingVerdict, WhatDescribesAllChainsIsJudgedToo) {
    auto const dense = [](double step, double hatch, double yukawa, double pairs) {
        SamplingRow r = row(rigid, step, 3, 300);
        r.together.means = {{"hatch energy", "kJ/mol", {hatch, 0.004, 1, true}},
                            {"yukawa energy", "kJ/mol", {yukawa, 0.004, 1, true}},
                            {"pairs", "per bead", {pairs, 0.001, 1, true}}};
        return r;
    };
    std::vector<SamplingRow> const rows{
        dense(0.01, -2, 0.001, 1), dense(0.02, -2.005, 0.005, 1.001), dense(0.03, -2, 0.001, 1.02)};
    SamplingMethodVerdict const v = verdicts_of(rows, 300).front();
    ASSERT_EQ(v.bias[1].of.size(), 5U);
    EXPECT_NEAR(v.bias[1].of[2].percent, -100 * 0.005 / 2.001, 1e-9);
    EXPECT_NEAR(v.bias[1].of[3].percent, 100 * 0.004 / 2.001, 1e-9);
    EXPECT_NEAR(v.bias[1].of[3].error, 100 * std::hypot(0.004, 0.004) / 2.001, 1e-9);
    EXPECT_STREQ(v.bias[1].word(), "shown");
    EXPECT_NEAR(v.bias[2].of[4].percent, 2, 1e-9);
    EXPECT_STREQ(v.bias[2].word(), "no");
    EXPECT_EQ(v.allowed->step, 0.02);
}

TEST(SamplingVerdict, WhatIsUnstableIsNotUsable) {
    std::vector<SamplingRow> rows{row(rigid, 0.01, 3, 300), row(rigid, 0.02, 3, 300),
                                  row(rigid, 0.03, 3, 300)};
    rows[1].state = "unstable";
    EXPECT_EQ(verdicts_of(rows, 300).front().allowed, nullptr);
    rows[0].state = "failed";
    EXPECT_EQ(verdicts_of(rows, 300).front().allowed, nullptr);
    EXPECT_STREQ(verdicts_of(rows, 300).front().bias[2].word(), "no reference");
    EXPECT_EQ(verdicts_of(rows, 300).front().bias[2].temperature().percent, 0);
    EXPECT_TRUE(differences_of(verdicts_of(rows, 300)).empty());
}

TEST(SamplingVerdict, DifferencesHaveTheirSign) {
    std::vector<SamplingRow> const rows{row(rigid, 0.01, 2.9, 300, 0.003),
                                        row(bonds, 0.01, 3, 300, 0.004), row(bonds, 0.02, 7, 300)};
    auto const found = differences_of(verdicts_of(rows, 300));
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].gyration.value, -0.1, 1e-12);
    EXPECT_NEAR(found[0].cosine.value, -0.01, 1e-12);
    EXPECT_NEAR(found[0].cosine.error, 0.005, 1e-12);
    EXPECT_NEAR(found[0].cosine.errors(), -2, 1e-9);
}

}  // namespace
}  // namespace catena::command
