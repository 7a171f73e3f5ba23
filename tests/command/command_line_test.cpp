#include "command/command_line.hpp"

#include <gtest/gtest.h>

#include "error.hpp"

namespace catena::command {
namespace {

Request parsed(std::vector<char const*> words) {
    words.insert(words.begin(), "catena");
    return parse_command_line(static_cast<int>(words.size()), words.data());
}
std::string refusal(std::vector<char const*> words) {
    try {
        parsed(std::move(words));
    } catch (InputError const& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(CommandLine, OptionsBecomeOverridesOfTheScene) {
    auto const r = std::get<SolveRequest>(
        parsed({"solve", "--set", "a.b=1", "s.yaml", "--set", "chains[0].count=10", "--backend",
                "openmp", "--threads", "3", "--handles", "full", "--repeat", "1e2"}));
    EXPECT_EQ(r.scene, "s.yaml");
    EXPECT_EQ(r.repeat, 100);
    EXPECT_EQ(overrides_of(r),
              (std::vector<std::string>{"a.b=1", "chains[0].count=10", "solver.backend=openmp",
                                        "solver.handles=full", "solver.threads=3"}));
    EXPECT_EQ(r.command_line.substr(0, 20), "catena solve --set a");
}

TEST(CommandLine, RunTakesItsOptions) {
    auto const r = std::get<RunRequest>(
        parsed({"run", "s.yaml", "--steps", "1e6", "--restart", "x/checkpoint.h5", "--quiet"}));
    EXPECT_EQ(r.steps, 1000000);
    EXPECT_EQ(r.restart, "x/checkpoint.h5");
    EXPECT_TRUE(r.quiet && !r.overwrite);
    EXPECT_FALSE(std::get<RunRequest>(parsed({"run", "s.yaml"})).steps.has_value());
}

TEST(CommandLine, BenchTakesLists) {
    auto const r =
        std::get<BenchRequest>(parsed({"bench", "solve", "--sizes", "1e3,20", "--joints",
                                       "link,revolute", "--backend", "serial,segments"}));
    EXPECT_EQ(r.sizes, (std::vector<std::int64_t>{1000, 20}));
    EXPECT_EQ(r.joints, (std::vector<std::string>{"link", "revolute"}));
    EXPECT_EQ(r.backends, (std::vector<Backend>{Backend::serial, Backend::segments}));
}

TEST(CommandLine, FiguresHaveSizesOfTheirOwn) {
    auto const all = std::get<BenchRequest>(parsed({"bench", "figures"}));
    EXPECT_EQ(all.sizes.size(), 11U);
    EXPECT_EQ(all.sizes.back(), 2048);
    EXPECT_EQ(all.figures.size(), 5U);
    auto const some = std::get<BenchRequest>(
        parsed({"bench", "figures", "--figure", "2.5,table-2.1", "--output", "x"}));
    EXPECT_EQ(some.figures, (std::vector<std::string>{"2.5", "table-2.1"}));
    EXPECT_EQ(some.output, "x");
    EXPECT_EQ(std::get<BenchRequest>(parsed({"bench", "solve"})).sizes,
              (std::vector<std::int64_t>{1000, 10000, 100000}));
    EXPECT_TRUE(refusal({"bench", "figures", "--figure", "2.4"})
                    .starts_with("`2.4` is not a value of --figure"));
}

TEST(CommandLine, ReportTakesSeveralScenesOrNone) {
    EXPECT_EQ(
        std::get<ReportRequest>(parsed({"report", "a.yaml", "b.yaml", "--repeat", "3"})).scenes,
        (std::vector<std::string>{"a.yaml", "b.yaml"}));
    EXPECT_TRUE(std::get<ReportRequest>(parsed({"report"})).scenes.empty());
    auto const suite =
        std::get<ReportRequest>(parsed({"report", "--suite", "stability", "--quick"}));
    EXPECT_EQ(suite.suite, "stability");
    EXPECT_TRUE(suite.quick);
    for (std::vector<char const*> const& option :
         std::vector<std::vector<char const*>>{{"--set", "solver.threads=2"},
                                               {"--repeat", "5"},
                                               {"--threads", "2"},
                                               {"--gpu-levels", "3"}}) {
        std::vector<char const*> words{"report", "--suite", "stability"};
        words.insert(words.end(), option.begin(), option.end());
        EXPECT_TRUE(refusal(words).starts_with("both --suite and " + std::string(option.front())))
            << refusal(words);
    }
    EXPECT_EQ(refusal({"report", "--suite", "stabilty"}),
              "`stabilty` is not a value of --suite (command line): did you mean `stability`?");
}

TEST(CommandLine, AMachineIsCalibratedWithoutAScene) {
    EXPECT_TRUE(std::get<PlanRequest>(parsed({"plan", "--calibrate"})).calibrate);
    EXPECT_TRUE(
        std::get<PlanRequest>(parsed({"plan", "s.yaml", "--explain", "--measure"})).explain);
    EXPECT_EQ(refusal({"plan", "--measure"}),
              "no scene is named (command line): write catena plan SCENE");
}

TEST(CommandLine, ACommandsNameIsNoSecondCommand) {
    EXPECT_EQ(std::get<CheckRequest>(parsed({"check", "run"})).scene, "run");
}

TEST(CommandLine, LaterCommandsAndOptionsSaySo) {
    for (std::vector<char const*> const& words : std::vector<std::vector<char const*>>{
             {"report", "--precision", "mixed"}, {"bench", "sweeps"}})
        EXPECT_TRUE(refusal(words).starts_with("not in this version: ")) << refusal(words);
}

TEST(CommandLine, TheNearestKnownWordIsNamed) {
    EXPECT_EQ(refusal({"slove", "s.yaml"}),
              "`slove` is not a command (command line): did you mean `solve`?");
    EXPECT_EQ(refusal({"solve", "s.yaml", "--bakend=serial"}),
              "`--bakend` is not an option (command line): did you mean `--backend`?");
    EXPECT_EQ(refusal({"solve", "s.yaml", "--handles", "ful"}),
              "`ful` is not a value of --handles (command line): did you mean `full`?");
    EXPECT_EQ(refusal({"bench", "slove"}),
              "`slove` is not a value of catena bench (command line): did you mean `solve`?");
}

TEST(CommandLine, WhatCannotBeIsRefused) {
    for (auto const& [words, part] : std::vector<std::pair<std::vector<char const*>, std::string>>{
             {{}, "no command"},
             {{"solve"}, "no scene"},
             {{"solve", "a", "b"}, "one argument too many"},
             {{"solve", "a", "--repeat", "0"}, "below 1 (--repeat)"},
             {{"solve", "a", "--repeat", "1.5"}, "not a whole number (--repeat)"},
             {{"solve", "a", "--threads", "-1"}, "(--threads)"},
             {{"solve", "a", "--json"}, "--json"},
             {{"solve", "a", "--quiet=perhaps"}, "quiet"},
             {{"solve", "a", "--log-level", "loud"}, "--log-level"},
             {{"run", "a", "--steps", "nan"}, "(--steps)"},
             {{"plan", "a", "--ranks", "8"}, "--ranks without --network"},
             {{"plan", "a", "--hosts", "2"}, "without --ranks"},
             {{"plan", "a", "--ranks", "2", "--hosts", "4"}, "more hosts than"},
             {{"run", "a", "--overwrite", "--restart", "c"}, "--overwrite"},
             {{"bench", "solve", "--sizes", "10,,20"}, "(--sizes)"},
             {{"bench", "solve", "--joints", "hinged"}, "--joints"},
             {{"bench", "peers", "--loads", "heavy"}, "--loads"},
             {{"--frob"}, "not an option"}}) {
        EXPECT_NE(refusal(words).find(part), std::string::npos) << refusal(words);
        EXPECT_EQ(refusal(words).find('\n'), std::string::npos) << refusal(words);
    }
}

}  // namespace
}  // namespace catena::command
