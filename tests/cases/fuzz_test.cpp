// What fuzzing and kill campaigns found: libraries that break on damaged files, and limits that
// were judged in parts.
#include <csignal>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "io/trial.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

std::string bytes_of(std::string const& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write(std::string const& file, std::string const& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

TrialLimits const small{100'000'000, 1};

TEST(Trials, TellHowACopyOfTheProcessEnds) {
    int changed = 0;
    EXPECT_EQ(trial([&] { changed = 1; }, small), "");
    EXPECT_EQ(changed, 0);  // in the copy alone
    EXPECT_EQ(trial([] { throw std::runtime_error("comes again"); }, small), "");
    EXPECT_EQ(trial([] { std::raise(SIGSEGV); }, small), "Segmentation fault");
    EXPECT_EQ(trial([] { std::abort(); }, small), "Aborted");
}

TEST(Trials, EndWhereThereIsNoEnd) {
    EXPECT_EQ(trial(
                  [] {
                      for (bool volatile ever = true; ever;) continue;
                  },
                  small),
              "no end within 1 s");
}

TEST(Trials, MayTakeWhatACompressedFileOfTheSizeCanNeed) {
    TemporaryFolder const folder;
    write(folder / "x", std::string(2'000'000, 'x'));
    EXPECT_GE(limits_for_file(folder / "x").bytes, 2'000'000'000);
    EXPECT_GE(limits_for_file(folder / "x").seconds, 10);
    EXPECT_LE(limits_for_file(folder / "missing").bytes, 1'000'000'000);
}

Words const run{"run", CATENA_TEST_DATA "/cases/running-folder/scene.yaml", "--output", "o",
                "--quiet"};

Ended run_with(TemporaryFolder const& folder, Words const& more) {
    Words words = run;
    words.insert(words.end(), more.begin(), more.end());
    return catena(words, folder.path());
}

// The texts of `unit` attributes lie in the file's global heap, whose damage lets HDF5 1.10 crash,
// or go on for ever, where it reads one.
TEST(Restarts, GoOnWithTrajectoriesWhoseTextsAreDamaged) {
    TemporaryFolder const folder;
    expect_good(run_with(folder, {"--steps", "2"}));
    std::string const good = bytes_of(folder / "o/trajectory.h5md");
    std::size_t const heap = good.find("GCOL");
    ASSERT_NE(heap, std::string::npos);
    std::string steps = "2";
    for (std::size_t const at : {24, 49, 50, 55}) {
        std::string bad = bytes_of(folder / "o/trajectory.h5md");
        bad[heap + at] = static_cast<char>(bad[heap + at] ^ (at % 2 == 0 ? 0xff : 0x10));
        write(folder / "o/trajectory.h5md", bad);
        steps = std::to_string(std::stoi(steps) + 2);
        expect_good(run_with(folder, {"--restart", "o/checkpoint.h5", "--steps", steps}));
    }
}

TEST(Restarts, RefuseATrajectoryInOtherUnits) {
    TemporaryFolder const folder;
    expect_good(run_with(folder, {"--steps", "2"}));
    std::string bytes = bytes_of(folder / "o/trajectory.h5md");
    std::size_t const name = bytes.find("length_unit");
    ASSERT_NE(name, std::string::npos);
    std::size_t const at = bytes.find("nm", name);
    ASSERT_LT(at, name + 100);
    bytes[at] = 'A';
    write(folder / "o/trajectory.h5md", bytes);
    expect_refused(run_with(folder, {"--restart", "o/checkpoint.h5", "--steps", "4"}), 2,
                   "is in Am, unlike the scene");
}

// U+202E turns around what a terminal shows after it: a message could then name another file or
// value than it means.
TEST(Messages, HaveNoMarksThatTurnLinesAround) {
    TemporaryFolder const folder;
    write(folder / "s.yaml", "chains: \"a\xE2\x80\xAE!b\xE2\x81\xA6\xE2\x80\xA9\xE2\x82\xAC\"\n");
    Ended const e = catena({"check", "s.yaml"}, folder.path());
    expect_refused(e, 2,
                   "`a?!b??\xE2\x82\xAC` in quotes is not a list");  // a sign of a currency stays
}

// 900,000 chains need at least 2.7 GB, each entry of 300,000 fits into 2 GB.
TEST(Memory, IsJudgedForAllChainsTogether) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "NOT RUN: the address sanitizer needs more address space than the limit";
#endif
    TemporaryFolder const folder;
    std::string const entry =
        "  - {count: 300000, generator: {freely_jointed: {beads: 3, length: 0.38}}}\n";
    write(folder / "s.yaml", "chains:\n" + entry + entry + entry);
    Ended const e = run_program(
        {"sh", "-c", "ulimit -v 2000000; exec \"$0\" check s.yaml", program()}, folder.path());
    expect_refused(e, 2, "chains[1]");
    EXPECT_NE(e.err.find("the chains up to this one need about"), std::string::npos) << e.err;
    EXPECT_NE(e.err.find("and only 2.05 GB are allowed by `ulimit -v`"), std::string::npos)
        << e.err;
}

}  // namespace
}  // namespace catena::test
