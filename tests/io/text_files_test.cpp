#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <limits>
#include <thread>

#include "error.hpp"
#include "io/observables_table.hpp"
#include "io/output.hpp"
#include "io/output_file.hpp"
#include "temporary_folder.hpp"

namespace catena::test {
namespace {

void write_records(std::string const& file, std::vector<std::int64_t> const& steps,
                   std::optional<std::int64_t> after = {}) {
    ObservablesWriter table(file, {"total_energy [kJ/mol]", "temperature [K]"}, after);
    for (std::int64_t const step : steps)
        table.write(step, 0.01 * static_cast<double>(step),
                    {1.0 / (1 + static_cast<double>(step)), 300});
    table.close();
}

TEST(Observables, HeaderHasUnitsAndNumbersReadBackBitForBit) {
    TemporaryFolder const folder;
    std::string const file = folder / "observables.csv";
    {
        ObservablesWriter table(file, {"total_energy [kJ/mol]", "odd"}, {});
        table.write(1, 0.1 + 0.2, {1 / 3.0, -std::numeric_limits<double>::infinity()});
        table.write(2, 1e-320, {-0.0, std::numeric_limits<double>::quiet_NaN()});
        table.close();
    }
    EXPECT_TRUE(read_text_file(file).starts_with(
        "step,time [ps],total_energy "
        "[kJ/mol],odd\n1,0.30000000000000004,0.33333333333333331,-inf\n"));
    ObservablesTable const table = read_observables(file);
    EXPECT_EQ(table.columns[1], (std::vector<double>{0.1 + 0.2, 1e-320}));
    EXPECT_EQ(table.columns[2], (std::vector<double>{1 / 3.0, 0}));
    EXPECT_TRUE(std::signbit(table.columns[2][1]));
    EXPECT_TRUE(std::isnan(table.columns[3][1]));
}

TEST(Observables, EveryRecordIsThereBeforeTheFileIsClosed) {
    TemporaryFolder const folder;
    ObservablesWriter table(folder / "observables.csv", {"a"}, {}, "s");
    table.write(7, 1, {2});
    EXPECT_EQ(read_text_file(folder / "observables.csv"), "step,time [s],a\n7,1,2\n");
}

TEST(Observables, RestartCutsLaterRecordsAndGoesOn) {
    TemporaryFolder const folder;
    std::string const file = folder / "observables.csv",
                      uninterrupted = folder / "uninterrupted.csv";
    write_records(uninterrupted, {0, 100, 200, 300, 400});
    write_records(file, {0, 100, 200, 250, 300});
    write_records(file, {300, 400}, 200);
    EXPECT_EQ(read_text_file(file), read_text_file(uninterrupted));
    write_records(file, {}, -1);
    EXPECT_EQ(read_observables(file).columns[0].size(), 0U);
}

TEST(Observables, ALineCutShortByAKillIsDropped) {
    TemporaryFolder const folder;
    std::string const file = folder / "observables.csv";
    write_records(file, {0, 100});
    std::string const whole = read_text_file(file);
    std::ofstream(file, std::ios::app) << "150,1.5,0.00";
    EXPECT_EQ(read_observables(file).columns[0], (std::vector<double>{0, 100}));
    write_records(file, {}, 1000);
    EXPECT_EQ(read_text_file(file), whole);
}

TEST(Observables, RestartRefusesOtherColumnsAndBrokenLines) {
    TemporaryFolder const folder;
    std::string const file = folder / "observables.csv";
    auto const restart = [&] { return message_of([&] { write_records(file, {}, 100); }); };
    EXPECT_EQ(restart(), "there is no table of observables to continue (" + file +
                             "): restore it, or " + Continuation::way_beside);
    std::ofstream(file) << "step,time [ps],other\n";
    EXPECT_NE(restart().find("other columns"), std::string::npos) << restart();
    write_records(file, {0});
    std::ofstream(file, std::ios::app) << "not a record\n";
    EXPECT_EQ(restart(), "not a record of observables (" + file +
                             ", line 3): correct the line, or " + Continuation::way_beside);
    std::string const before = read_text_file(file);
    EXPECT_THROW(write_records(file, {}, 100), InputError);
    EXPECT_EQ(read_text_file(file), before) << "a refused restart changed the file";
}

TEST(Observables, ARecordOfAnotherLengthIsRefused) {
    TemporaryFolder const folder;
    ObservablesWriter table(folder / "observables.csv", {"a", "b"}, {});
    EXPECT_THROW(table.write(1, 0.1, {1}), ComputationError);
}

TEST(TextFile, ReplacesWholeAndLeavesNoDraft) {
    TemporaryFolder const folder;
    write_text_file(folder / "a.json", "first");
    write_text_file(folder / "a.json", "second");
    EXPECT_EQ(read_text_file(folder / "a.json"), "second");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
    EXPECT_EQ(message_of([&] { write_text_file(folder / "none/a.json", "x"); }),
              "cannot open for writing (" + (folder / "none/a.json.writing") +
                  "): No such file or directory");
}

TEST(TextFile, WritesThroughLinksAndPipesInsteadOfReplacingThem) {
    TemporaryFolder const folder;
    write_text_file(folder / "target", "old");
    std::filesystem::create_symlink(folder / "target", folder / "link");
    write_text_file(folder / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(read_text_file(folder / "target"), "new");
}

std::string progress_of(bool quiet, bool si, int updates) {
    TemporaryFolder const folder;
    std::string const log = folder / "log";
    std::FILE* const out = std::fopen(log.c_str(), "w");
    Progress progress(quiet, 1000, 2000, 0.01, si, out);
    for (int k = 1; k <= updates; ++k) progress.update(1000 + k);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    progress.update(1500);
    progress.update(1501);
    progress.finish();
    std::fclose(out);
    return read_text_file(log);
}

TEST(Progress, ALogGetsALineNowAndThen) {
    std::string const log = progress_of(false, false, 400);
    EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 2) << log;
    EXPECT_TRUE(log.starts_with(" 50.0 %  step 1500 of 2000  ")) << log;
    EXPECT_NE(log.find("ns/day  0:01 left\n"), std::string::npos) << log;
    EXPECT_NE(log.find("step 1501 of 2000"), std::string::npos) << log;
    EXPECT_EQ(log.find('\r'), std::string::npos) << log;
}

TEST(Progress, QuietIsSilentAndSiHasNoNanosecondsPerDay) {
    EXPECT_EQ(progress_of(true, false, 1), "");
    EXPECT_EQ(progress_of(false, true, 1).find("ns/day"), std::string::npos);
}

TEST(Progress, RatesAreOfTheStepsDoneHere) {
    Progress progress(true, 5000, 6000, 0.01, false);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    progress.update(5100);
    double const rate = progress.rate();
    EXPECT_LE(rate, 500);
    EXPECT_GE(rate, 50) << "100 steps took far longer than 200 ms";
}

}  // namespace
}  // namespace catena::test
