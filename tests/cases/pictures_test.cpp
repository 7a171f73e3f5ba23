// Pictures, plans, what `auto` takes, and what a process does with signals, descriptors and text
// that are not as usual.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

std::string case_file(std::string const& path) {
    return std::string(CATENA_TEST_DATA) + "/cases/" + path;
}
std::string const plain = case_file("closed-descriptors/scene.yaml");

Ended shell(std::string const& line, std::string const& folder) {
    return run_program({"sh", "-c", "catena=" + program() + "; " + line}, folder);
}

std::string contents(std::string const& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}

// An HDF5 file begins with the signature of its format's specification, a table of observables with
// its first column: where a descriptor from 0 to 2 is closed at the start, a file of the run got
// its number, and progress lines were written over its head.
TEST(Process, ClosedDescriptorsAreNotGivenToFilesOfTheRun) {
    for (std::string const closed : {"0<&- 2>&-", "1>&- 2>&-", "0<&- 1>&- 2>&-"}) {
        TemporaryFolder const folder;
        Ended const e =
            shell("$catena run " + plain + " --steps 100 --output m " + closed, folder / "");
        EXPECT_EQ(e.status, 0) << closed << e.err;
        EXPECT_TRUE(contents(folder / "m/trajectory.h5md").starts_with("\x89HDF\r\n\x1a\n"))
            << closed;
        EXPECT_TRUE(contents(folder / "m/observables.csv").starts_with("step,")) << closed;
    }
}

TEST(Process, ARunGoesOnWhereNobodyReadsItsProgress) {
    TemporaryFolder const folder;
    Ended const e = shell("{ $catena run " + plain +
                              " --steps 100 --output m; echo $? > status; } 2>&1 | true; sleep 0.1",
                          folder / "");
    EXPECT_EQ(e.err, "");
    for (int tries = 0; tries < 200 && contents(folder / "status").empty(); ++tries)
        run_program({"sleep", "0.1"});
    EXPECT_EQ(contents(folder / "status"), "0\n");
    EXPECT_EQ(Json::parse(contents(folder / "m/summary.json")).at("run").at("last_step"), 100);
}

TEST(Process, AReaderThatStopsReadingIsNoError) {
    TemporaryFolder const folder;
    Ended const e =
        shell("{ $catena check " + plain + "; echo $? > status; } | head -c 1", folder / "");
    EXPECT_EQ(e.err, "");
    EXPECT_EQ(contents(folder / "status"), "0\n");
}

// setrlimit(2): a process that ignores SIGXFSZ gets EFBIG ("File too large") from write().
TEST(Process, ALimitOfFileSizesEndsARunWithOneLine) {
    TemporaryFolder const folder;
    Ended const e = shell("ulimit -f 2000; $catena run " + case_file("file-size-limit/scene.yaml") +
                              " --quiet --output m",
                          folder / "");
    expect_refused(e, 1, "cannot write the trajectory (m/trajectory.h5md): File too large");
    EXPECT_TRUE(fs::exists(folder / "m/checkpoint.h5"));
}

/// The only checkpoint would come after all steps.
TEST(Process, ALimitBelowACheckpointIsToldBeforeTheFirstStep) {
    TemporaryFolder const folder;
    std::ofstream(folder / "s.yaml")
        << "chains: [{generator: {freely_jointed: {beads: 2000, length: 0.5, mass: 100}}}]\n"
           "dynamics: {integrator: rattle, step: 0.001, steps: 1e9}\n";
    Ended const e = shell("ulimit -f 64; $catena run s.yaml --quiet --output m", folder / "");
    expect_refused(e, 2, "a checkpoint takes ");
    EXPECT_NE(e.err.find("(m/checkpoint.h5): raise it"), std::string::npos) << e.err;
    EXPECT_FALSE(fs::exists(folder / "m/trajectory.h5md"));
}

TEST(Process, SignalsOfTerminalsAndBatchSystemsStopARunWithACheckpoint) {
    for (std::string const name : {"HUP", "XCPU"}) {
        TemporaryFolder const folder;
        Ended const e = shell("$catena run " + plain +
                                  " --quiet --steps 1000000 --output m & run=$!; while [ ! -e "
                                  "m/checkpoint.h5 ]; do sleep 0.02; done; kill -" +
                                  name + " $run; wait $run",
                              folder / "");
        EXPECT_EQ(e.status, 3) << e.err;
        EXPECT_NE(e.err.find("catena: stopped by SIG" + name + " at step"), std::string::npos)
            << e.err;
        EXPECT_EQ(count(e.err, "\n"), 1U) << e.err;
    }
}

TEST(Process, AnIgnoredHangUpStaysIgnored) {
    TemporaryFolder const folder;
    Ended const e = shell("trap '' HUP; $catena run " + plain +
                              " --quiet --steps 300 --output m & run=$!; while [ ! -e "
                              "m/checkpoint.h5 ]; do sleep 0.02; done; kill -HUP $run; wait $run",
                          folder / "");
    EXPECT_EQ(e.status, 0) << e.err;
}

// ld.so(8): an empty entry of RUNPATH is the working folder.
TEST(Process, LibrariesOfTheWorkingFolderAreNeverLookedFor) {
    Ended const e = run_program({"readelf", "-d", program()});
    if (e.status != 0) GTEST_SKIP() << "NOT RUN: readelf is missing";
    std::istringstream lines(e.out);
    for (std::string line; std::getline(lines, line);) {
        auto const open = line.find("path: [");
        if (open == std::string::npos) continue;
        std::string const paths = ":" + line.substr(open + 7, line.find(']') - open - 7) + ":";
        EXPECT_EQ(paths.find("::"), std::string::npos) << line;
    }
}

// Byte 0xE9 alone is no UTF-8; what stands for it is U+FFFD, in UTF-8 EF BF BD.
TEST(Text, ATitleThatIsNotUtf8IsSaidAndReplaced) {
    TemporaryFolder const folder;
    std::string const scene = case_file("latin1-title/scene.yaml");
    Ended const e = catena({"run", scene, "--quiet", "--output", folder / "m"});
    EXPECT_EQ(e.status, 0) << e.err;
    Json const summary = Json::parse(contents(folder / "m/summary.json"));
    EXPECT_EQ(summary.at("title"),
              "mol\xEF\xBF\xBD"
              "cule");
    EXPECT_TRUE(fs::exists(folder / "m/report.html"));
    EXPECT_NE(catena({"check", scene}).out.find("bytes that are not UTF-8 are shown as U+FFFD"),
              std::string::npos);
}

TEST(Text, FoldersThatAreNotUtf8DoNotEndARun) {
    TemporaryFolder const folder;
    Ended const e =
        catena({"run", plain, "--quiet", "--steps", "10", "--output", folder / "m\xE9"});
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_TRUE(fs::exists(folder / "m\xE9/summary.json"));
}

TEST(Text, ControlCharactersOfFilesDoNotReachATerminal) {
    TemporaryFolder const folder;
    std::ofstream(folder / "title.yaml") << "title: \"\\e[31mred\\u009b2J\"\nchains: [{name: a, "
                                            "generator: {pendulum: {links: 2}}}]\nunits: si\n";
    std::ofstream(folder / "name.yaml")
        << "chains: [{name: \"\\e[2J\", generator: {pendulum: {links: 2}}}]\nunits: si\n";
    Ended const e = catena({"check", folder / "title.yaml"});
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(e.out.find('\x1b'), std::string::npos);
    EXPECT_EQ(e.out.find("\xC2\x9B"), std::string::npos);
    expect_refused(catena({"check", folder / "name.yaml"}), 2, "the name has control characters");
    Ended const missing = catena({"check", "no\x1b[31mfile.yaml"});
    expect_refused(missing, 2, "file.yaml");
    EXPECT_EQ(missing.err.find('\x1b'), std::string::npos);
}

// The file's "far" link is null: it was measured on one host. 1e7 beads take 13 s to make, which
// nobody waits for to be told so.
TEST(Plan, ANetworkOfOneHostIsRefusedBeforeBodiesAreMade) {
    Words const words{"plan",      case_file("plan-one-host/scene.yaml"),
                      "--set",     "chains[0].generator.freely_jointed.beads=1e9",
                      "--ranks",   "64",
                      "--hosts",   "16",
                      "--network", case_file("plan-one-host/network.json")};
    expect_refused(catena(words), 2, "has no link between hosts");
}

// 1 / (12.5 GB/s) = 8e-11 s a byte.
TEST(Plan, LatencyAndBandwidthOfALinkMayBeGiven) {
    Words words{"plan",        case_file("plan-one-host/scene.yaml"),
                "--ranks",     "64",
                "--hosts",     "16",
                "--latency",   "1.5us",
                "--bandwidth", "12.5GB/s",
                "--json",      "-"};
    Ended const alone = catena(words);
    EXPECT_EQ(alone.status, 0) << alone.err;
    Json const network = alone.json().at("network");
    for (char const* const link : {"near", "far"}) {
        EXPECT_DOUBLE_EQ(network.at(link).at("latency").get<double>(), 1.5e-6) << link;
        EXPECT_DOUBLE_EQ(network.at(link).at("seconds_a_byte").get<double>(), 8e-11) << link;
    }
    words.insert(words.end(), {"--network", case_file("plan-one-host/network.json")});
    Json const with_file = catena(words).json().at("network");
    EXPECT_NEAR(with_file.at("near").at("latency").get<double>(), 5.758e-7, 1e-10);
    EXPECT_DOUBLE_EQ(with_file.at("far").at("latency").get<double>(), 1.5e-6);
}

TEST(Plan, LinksThatCannotBeAreRefused) {
    TemporaryFolder const folder;
    auto const plan = [&](Words const& more) {
        Words words{"plan", plain, "--ranks", "4"};
        words.insert(words.end(), more.begin(), more.end());
        return catena(words);
    };
    expect_refused(plan({"--latency", "1us"}), 2,
                   "--latency and --bandwidth must be given together");
    expect_refused(plan({"--latency", "1 week", "--bandwidth", "1GB/s"}), 2,
                   "`1 week` is not a positive number with a unit");
    expect_refused(plan({"--latency", "-1us", "--bandwidth", "1GB/s"}), 2,
                   "`-1us` is not a positive number");
    expect_refused(plan({"--latency", "1us", "--bandwidth", "12.5"}), 2,
                   "write a number and one of these units: B/s");
    std::ofstream(folder / "n.json")
        << R"({"network": {"near": {"latency": -1, "bandwidth": 1e9}}})";
    expect_refused(plan({"--network", folder / "n.json"}), 2, "latency is -1");
    std::ofstream(folder / "n.json")
        << R"({"network": {"near": {"latency": 1e-6, "bandwidth": 1e9}}})";
    EXPECT_EQ(plan({"--network", folder / "n.json"}).status, 0);
}

void expect_no_negative(Json const& value) {
    if (value.is_number()) {
        EXPECT_GE(value.get<double>(), 0);
    }
    if (value.is_structured())
        for (Json const& each : value) expect_no_negative(each);
}

// Times of levels are differences of two timings. Where noise is larger there is none (null), and
// the verdict counts them.
TEST(Figures, NoTimeIsBelowZeroAndNothingIsDrawnThatWasNotMeasured) {
    TemporaryFolder const folder;
    Ended const e = catena({"bench", "figures", "--sizes", "2,16,64", "--repeat", "3", "--output",
                            folder / "figures"});
    EXPECT_EQ(e.status, 0) << e.err;
    Json const json = Json::parse(contents(folder / "figures/figures.json"));
    std::int64_t missing = 0;
    for (Json const& study : json.at("figure_2.3"))
        for (Json const& level : study.at("levels"))
            for (char const* const place : {"one_core", "threads", "gpu"}) {
                expect_no_negative(level.at(place));
                if (level.at(place).is_object())
                    for (Json const& time : level.at(place)) missing += time.is_null() ? 1 : 0;
            }
    EXPECT_EQ(json.at("not_resolved"), missing);
    EXPECT_EQ(e.out.find("times are below the noise") != std::string::npos, missing > 0) << e.out;
    bool const timed = e.out.find("Figure 2.7: transfers of one solve, full handles: left out") ==
                       std::string::npos;
    EXPECT_EQ(fs::exists(folder / "figures/figure-2.7-full.svg"), timed);
}

// No machine has 4000 threads' worth of processors for such a run, and thread libraries end the
// process where the system refuses one.
TEST(Threads, NumbersFarBeyondTheProcessorsAreRefused) {
    expect_refused(catena({"solve", plain, "--backend", "openmp", "--threads", "4000"}), 2,
                   "4000 threads on ");
    expect_refused(catena({"solve", input("alpha-synuclein.yaml"), "--set",
                           "forces.openmm.threads=4000", "--set", "forces.openmm.platform=CPU"}),
                   2, "openmm.threads");
}

// What path inline computes before the matrix sweep are the forces: the handing over of 140
// positions takes microseconds.
TEST(Timeline, ForcesOfPathInlineAreNoHandingOver) {
    TemporaryFolder const folder;
    Ended const e = catena({"run", input("alpha-synuclein.yaml"), "--quiet", "--steps", "20",
                            "--set", "forces.openmm.path=inline", "--set",
                            "forces.openmm.platform=Reference", "--output", folder / "m"});
    EXPECT_EQ(e.status, 0) << e.err;
    double handing = 0, forces = 0;
    Json const timeline = Json::parse(contents(folder / "m/timeline.json"));
    for (Json const& step : timeline.at("ranks").at(0).at("steps"))
        for (Json const& phase : step.at("phases")) {
            double const seconds = phase.at("end").get<double>() - phase.at("begin").get<double>();
            if (phase.at("name") == "hand over positions") handing += seconds;
            if (phase.at("name") == "forces") forces += seconds;
        }
    EXPECT_GT(forces, 0);
    EXPECT_LT(handing, 0.5 * forces);
}

}  // namespace
}  // namespace catena::test
