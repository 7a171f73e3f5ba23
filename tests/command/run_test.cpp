#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(std::string const& file) {
    std::vector<std::string> lines;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(Run, WritesItsFolderBesideTheWorkingFolderAndGoesOn) {
    TemporaryFolder const folder;
    Words const run{"run", input("spherical-chain.yaml"), "--set", "output.every=10", "--quiet"};
    auto const with = [&](Words more) {
        Words words = run;
        words.insert(words.end(), more.begin(), more.end());
        return catena(words, folder.path());
    };
    Ended const first = with({"--steps", "20", "--json", "summary.json"});
    expect_good(first);
    EXPECT_EQ(first.out, "");
    std::string const made = folder / "spherical-chain-run/";
    for (char const* const file : {"trajectory.h5md", "topology.pdb", "observables.csv",
                                   "checkpoint.h5", "summary.json", "timeline.json", "report.html"})
        EXPECT_TRUE(fs::exists(made + file)) << file;
    auto const summary = nlohmann::json::parse(std::ifstream(folder / "summary.json"));
    EXPECT_EQ(summary.at("valid"), true);
    EXPECT_EQ(summary.at("run").at("last_step"), 20);

    expect_refused(with({"--steps", "20"}), 2, "the output folder exists");
    expect_refused(with({"--steps", "10", "--restart", made + "checkpoint.h5"}), 2, "step 20");
    expect_refused(with({"--restart", "missing.h5"}), 2, "missing.h5");
    expect_good(with({"--steps", "40", "--restart", made + "checkpoint.h5"}));
    EXPECT_EQ(lines_of(made + "observables.csv").size(), 1U + 5);  // steps 0, 10, .. 40
    expect_good(
        with({"--steps", "60", "--set", "output.every=30", "--restart", made + "checkpoint.h5"}));
    EXPECT_EQ(lines_of(made + "observables.csv").size(),
              1U + 6);  // what was recorded stays: 0, 10, .. 40; 60
    expect_good(with({"--steps", "10", "--overwrite"}));
    EXPECT_EQ(lines_of(made + "observables.csv").size(), 1U + 2);
}

TEST(Run, ABranchNeverOverwrites) {
    expect_refused(catena({"run", input("arm.yaml"), "--restart", "a/checkpoint.h5", "--branch",
                           "--output", "b", "--overwrite"}),
                   2, "leave --overwrite out and name a new folder with --output");
}

TEST(Run, ARunKilledBeforeItsFirstCheckpointIsToldHowToGoOn) {
    TemporaryFolder const folder;
    fs::create_directory(folder / "a");
    std::ofstream(folder / "a/observables.csv") << "step\n";
    expect_refused(
        catena({"run", input("arm.yaml"), "--restart", "a/checkpoint.h5"}, folder.path()), 2,
        "no such checkpoint (a/checkpoint.h5): name the checkpoint.h5 of a run; if this run ended "
        "before its first one, start it anew with --overwrite and a smaller "
        "output.checkpoint_every");
}

/// What `run` refuses while it makes the solver and the integrator, `check` refuses in the same
/// words.
TEST(Run, CheckRefusesWhatRunRefuses) {
    TemporaryFolder const folder;
    for (std::string const change :
         {"solver.refine=1", "solver.handles=articulated", "solver.simd=neon",
          "solver.backend=cuda-levels", "solver.threads=4096"}) {
        Words words{"check", input("spherical-chain.yaml"), "--set", change};
        Ended const checked = catena(words, folder.path());
        words[0] = "run";
        Ended const run = catena(words, folder.path());
        EXPECT_EQ(checked.status, run.status) << change << checked.out << run.err;
        if (run.status == 2) {
            EXPECT_EQ(checked.err, run.err) << change;
        }
        if (change.find("refine") != std::string::npos || change.ends_with("articulated")) {
            EXPECT_EQ(run.status, 2) << change;
        }
        fs::remove_all(folder / "spherical-chain-run");
    }
}

TEST(Run, ManyReplicasAreRefusedBeforeTheyAreMade) {
    TemporaryFolder const folder;
    std::ofstream(folder / "many.yaml")
        << "replicas: 1e6\nchains: [{generator: {freely_jointed: {beads: 1e4, length: 1}}}]\n"
           "dynamics: {integrator: g-baoab, step: 1e-3, steps: 1, temperature: 300, friction: 1}\n";
    expect_refused(catena({"check", "many.yaml"}, folder.path()), 2,
                   "1000000 replicas need at least ");
}

TEST(Run, NamesTheTopologyOfManySites) {
    TemporaryFolder const folder;
    std::ofstream(folder / "chain.yaml")
        << "chains: [{generator: {freely_jointed: {beads: 1e5, length: 1}}}]\n"
           "dynamics: {integrator: rattle, step: 1e-3, steps: 1}\n";
    expect_good(catena({"run", "chain.yaml", "--quiet"}, folder.path()));
    auto const files =
        nlohmann::json::parse(std::ifstream(folder / "chain-run/summary.json")).at("files");
    EXPECT_EQ(files.size(), 8U);
    for (auto const& file : files)
        EXPECT_TRUE(fs::exists(fs::path(folder.path()) / file.get<std::string>())) << file;
}

/// As many frames as steps, whatever the inner steps.
TEST(Run, TellsItsInnerSteps) {
    TemporaryFolder const folder;
    Ended const e = catena({"run", input("whip.yaml"), "--output", "a"}, folder.path());
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("inner steps          "), std::string::npos) << e.out;
    EXPECT_NE(e.out.find(" rejected, of 0.000"), std::string::npos) << e.out;
    auto const summary = nlohmann::json::parse(std::ifstream(folder / "a/summary.json"));
    auto const& inner = summary.at("inner_steps");
    EXPECT_EQ(inner.at("tolerance"), 1e-8);
    auto const taken = inner.at("taken").get<int>(),
               tried = taken + inner.at("rejected").get<int>();
    EXPECT_GT(taken, 500);
    EXPECT_LE(inner.at("evaluations").get<int>(), 1 + 6 * tried);
    EXPECT_GE(inner.at("evaluations").get<int>(), 1 + 6 * taken);
    EXPECT_LT(10 * inner.at("shortest").get<double>(), inner.at("longest").get<double>());
    auto const rows = lines_of(folder / "a/observables.csv");
    ASSERT_EQ(rows.size(), 102U);
    EXPECT_TRUE(rows.back().starts_with("100,1,")) << rows.back();
    Ended const fixed =
        catena({"run", input("arm.yaml"), "--steps", "2", "--output", "b"}, folder.path());
    EXPECT_EQ(fixed.status, 0) << fixed.err;
    EXPECT_EQ(fixed.out.find("inner steps"), std::string::npos);
    expect_refused(
        catena({"run", input("whip.yaml"), "--set", "dynamics.tolerance=1e-15", "--quiet"},
               folder.path()),
        2, "give 1e-13 or more");
    expect_refused(catena({"run", input("whip.yaml"), "--set",
                           "chains[0].bodies[3].joint.stiffness=1e40", "--quiet"},
                          folder.path()),
                   1,
                   "at step 0: the inner step cannot be shortened further for dynamics.tolerance "
                   "1e-08 at time 0 (");
}

/// Every text follows the one before it.
void expect_in_order(std::string const& text, std::vector<std::string> const& parts) {
    std::size_t at = 0;
    for (std::string const& part : parts) {
        std::size_t const found = text.find(part, at);
        ASSERT_NE(found, std::string::npos) << part << "\n" << text;
        at = found + part.size();
    }
}

TEST(Run, TheTerminalBeginsWithTheScienceAndEndsWithTheVerdict) {
    TemporaryFolder const folder;
    Ended const e =
        catena({"run", input("arm.yaml"), "--steps", "20", "--output", "a/b"}, folder.path());
    EXPECT_EQ(e.status, 0) << e.err;
    expect_in_order(
        e.out, {"  system               1 chain of 4 bodies (arm)", "gravity [", "rk4, step ",
                " s, 20 steps", "Observables", "standard error", "total energy", "All 3 frames",
                "no thermostat", "Speed", "per day", " steps/s", "Verdict", "valid ", "Solver",
                "1 rank", "constraint error", "a/b/trajectory.h5md", "\nVALID\n"});
    EXPECT_EQ(e.out.find("temperature"), std::string::npos) << e.out;
    EXPECT_TRUE(fs::exists(folder / "a/b/checkpoint.h5"));
}

std::vector<std::string> keys_of(nlohmann::ordered_json const& object) {
    std::vector<std::string> keys;
    for (auto const& [key, value] : object.items()) keys.push_back(key);
    return keys;
}

/// 100 frames from zero velocities: the kinetic energy rises within the first ones.
TEST(Run, TheSummaryBeginsWithSystemObservablesSpeedAndVerdict) {
    TemporaryFolder const folder;
    std::ofstream(folder / "chain.yaml")
        << "title: two chains\nbox: {periodic: [20, 20, 20]}\n"
           "chains: [{name: a, count: 2, velocities: zero, generator: {freely_jointed: {beads: 20, "
           "length: 0.38, mass: 100}}}]\n"
           "dynamics: {integrator: g-baoab, step: 0.01, steps: 1000, friction: 2}\n"
           "output: {every: 10}\n";
    expect_good(catena({"run", "chain.yaml", "--output", "out", "--quiet"}, folder.path()));
    auto const summary = nlohmann::ordered_json::parse(std::ifstream(folder / "out/summary.json"));
    std::vector<std::string> const keys = keys_of(summary),
                                   first{
                                       "title", "scene",       "units",         "system",
                                       "run",   "observables", "equilibration", "last_observables",
                                       "speed", "valid",       "verdict",       "notes"};
    EXPECT_TRUE(std::equal(first.begin(), first.end(), keys.begin())) << summary.dump(1);
    auto const& system = summary.at("system");
    EXPECT_EQ(system.at("description"), "2 chains of 20 beads (a-1 to a-2)");
    EXPECT_NEAR(system.at("mass_concentration"), 4000 * 1.66053907 / 8000, 1e-8);
    EXPECT_NEAR(system.at("chain_concentration"), 2 / 0.602214076 / 8000, 1e-12);
    EXPECT_EQ(summary.at("run").at("temperature"), 300);
    EXPECT_EQ(summary.at("run").at("simulated_time"), 10);
    auto const& temperature = summary.at("observables").at("temperature");
    EXPECT_EQ(temperature.at("unit"), "K");
    auto const left_out = summary.at("equilibration").at("frames_left_out").get<int>();
    EXPECT_GT(left_out, 0) << "the velocities of the start are zero";
    EXPECT_EQ(temperature.at("samples"), 101 - left_out);
    EXPECT_NEAR(temperature.at("mean"), 300,
                5 * temperature.at("standard_error").get<double>() + 15);
    EXPECT_GT(summary.at("speed").at("ns_per_day"), 0);
    EXPECT_NEAR(summary.at("speed").at("milliseconds_per_step").get<double>() *
                    summary.at("speed").at("steps_per_second").get<double>(),
                1000, 1e-6);
}

/// A restart's means are of all frames since the scene's start.
TEST(Run, ARestartCountsTheFramesBeforeIt) {
    TemporaryFolder const folder;
    Words run{"run",      input("spherical-chain.yaml"),
              "--set",    "output.every=1",
              "--output", "out",
              "--quiet",  "--steps",
              "5"};
    expect_good(catena(run, folder.path()));
    run.back() = "9";
    run.insert(run.end(), {"--restart", "out/checkpoint.h5"});
    expect_good(catena(run, folder.path()));
    auto const summary = nlohmann::json::parse(std::ifstream(folder / "out/summary.json"));
    EXPECT_EQ(summary.at("observables").at("total_energy").at("samples"), 10);
    double const step = summary.at("run").at("step");
    EXPECT_NEAR(summary.at("run").at("simulated_time"), 4 * step, 1e-12);
    EXPECT_NEAR(summary.at("run").at("time"), 9 * step, 1e-12);
}

/// In SI units a temperature needs a thermostat or its name in `observables`.
TEST(Run, MechanismsWithoutAThermostatHaveNoTemperature) {
    TemporaryFolder const folder;
    std::string const scene =
        "units: si\nforces: {gravity: [0, 0, -9.81]}\n"
        "chains: [{base: fixed, generator: {pendulum: {links: 3}}}]\n"
        "dynamics: {integrator: rk4, step: 1e-4, steps: 2}\n";
    std::ofstream(folder / "default.yaml") << scene;
    std::ofstream(folder / "named.yaml") << scene << "output: {observables: [temperature]}\n";
    Ended const e = catena({"run", "default.yaml", "--output", "a"}, folder.path());
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(e.out.find("temperature"), std::string::npos) << e.out;
    EXPECT_EQ(lines_of(folder / "a/observables.csv").at(0).find("temperature"), std::string::npos);
    expect_good(catena({"run", "named.yaml", "--output", "b", "--quiet"}, folder.path()));
    EXPECT_EQ(lines_of(folder / "b/observables.csv").at(0), "step,time [s],temperature [K]");
}

/// A link of 0.4 nm in the positions that is 0.37 nm long.
TEST(Run, AMovedStartIsNotedAtTheFirstStartOnly) {
    TemporaryFolder const folder;
    std::ofstream(folder / "moved.yaml")
        << "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: [0.4, 0, 0], "
           "joint: {type: link, length: 0.37}}]}]\n"
           "dynamics: {integrator: g-baoab, step: 0.01, steps: 2, temperature: 300, friction: 1}\n";
    std::string const note = "the start's positions were moved so that links have their lengths";
    Ended const first = catena({"run", "moved.yaml", "--output", "a"}, folder.path());
    EXPECT_EQ(first.status, 0) << first.err;
    EXPECT_NE(first.err.find(note), std::string::npos) << first.err;
    Ended const next = catena({"run", "moved.yaml", "--restart", "a/checkpoint.h5", "--steps", "4"},
                              folder.path());
    EXPECT_EQ(next.status, 0) << next.err;
    EXPECT_EQ((next.out + next.err).find(note), std::string::npos) << next.err;
}

}  // namespace
}  // namespace catena::test
