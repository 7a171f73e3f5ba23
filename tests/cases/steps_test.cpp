// Steps that once left joints open, grew energy or ran away, and what is said of them now.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

std::string scene_of(std::string const& name) {
    return std::string(CATENA_SOURCE_DIR) + "/tests/data/cases/" + name + "/scene.yaml";
}

/// `steps` of a scene with every one of them in its table; its summary.
nlohmann::json run(TemporaryFolder const& folder, std::string const& scene,
                   std::string const& steps, Words const& more = {}) {
    Words words{"run", scene,   "--output",       "out",    "--quiet",     "--steps",
                steps, "--set", "output.every=1", "--json", "summary.json"};
    words.insert(words.end(), more.begin(), more.end());
    Ended const ended = catena(words, folder.path());
    EXPECT_EQ(ended.status, 0) << ended.err << ended.out;
    return nlohmann::json::parse(std::ifstream(folder / "summary.json"));
}

/// The numbers of a column of observables.csv.
std::vector<double> column(TemporaryFolder const& folder, std::string const& name) {
    std::ifstream stream(folder / "out/observables.csv");
    std::vector<double> values;
    std::ptrdiff_t at = -1;
    for (std::string line; std::getline(stream, line);) {
        std::istringstream cells(line);
        std::string cell;
        for (std::ptrdiff_t i = 0; std::getline(cells, cell, ','); ++i) {
            if (at < 0 && cell.find(name) != std::string::npos) {
                at = i;
                break;
            }
            if (i == at) values.push_back(std::stod(cell));
        }
    }
    return values;
}

void expect_closed(std::vector<double> const& errors, std::size_t steps) {
    EXPECT_EQ(errors.size(), steps + 1);
    for (double const error : errors) EXPECT_LE(error, 1e-10);
}

// 400 beads of 100 amu exactly on a line, thermal at 300 K, 10 fs. A Newton iteration with the
// matrix of each sweep closes all links to rounding in three sweeps. No force acts, so that kinetic
// energy is a constant: its jump from 978 to 1300 kJ/mol is the step's length.
TEST(Steps, AStraightThermalChainClosesInEveryStepAndItsJumpIsSaid) {
    TemporaryFolder const folder;
    nlohmann::json const summary = run(folder, scene_of("straight-thermal"), "20");
    EXPECT_EQ(summary.at("valid"), true);
    expect_closed(column(folder, "constraint_error"), 20);
    EXPECT_NE(summary.at("notes").dump().find("jumped from 97"), std::string::npos)
        << summary.at("notes");
    EXPECT_GE(summary.at("solver").at("steps_closed_further").at("steps"), 1);
}

TEST(Steps, RanksCloseJointsAlike) {
    TemporaryFolder const folder;
    Words const words{"run",
                      scene_of("straight-thermal"),
                      "--output",
                      "out",
                      "--quiet",
                      "--steps",
                      "20",
                      "--set",
                      "output.every=10",
                      "--json",
                      "two.json"};
    Ended const ended = catena_on(2, words, folder.path());
    EXPECT_EQ(ended.status, 0) << ended.err;
    TemporaryFolder const alone;
    run(alone, scene_of("straight-thermal"), "20", {"--set", "output.every=10"});
    EXPECT_EQ(column(folder, "total_energy"), column(alone, "total_energy"));
}

// 236 links from a coarse-grained protein in a straight start, 10 fs at 300 K.
TEST(Steps, AStraightProteinClosesInEveryStep) {
    TemporaryFolder const folder;
    EXPECT_EQ(run(folder, scene_of("09-straight-start"), "20").at("valid"), true);
    expect_closed(column(folder, "constraint_error"), 20);
}

// 200 rods with bend 4 K / I = 4 * 366.8 / 168.8 and twist 4 * 733.6 / 325 = 9.03 / ps^2 in their
// stiffest (zigzag) modes: 2 / omega = 0.666 ps. At 0.47 ps (omega h = 1.41, four steps a period)
// total energy, a constant of the motion, goes from 1394 to 1929 kJ/mol in 3000 steps.
TEST(Steps, EnergyThatGrowsIsWarnedOfAndInvalid) {
    TemporaryFolder const folder;
    Ended const ended =
        catena({"run", scene_of("energy-drift-valid"), "--output", "out"}, folder.path());
    EXPECT_EQ(ended.status, 1) << ended.out;
    EXPECT_NE(ended.err.find("near the longest stable step"), std::string::npos) << ended.err;
    std::string const last =
        ended.out.substr(std::min(ended.out.size(), ended.out.find("\nINVALID")));
    EXPECT_EQ(last.find("\nINVALID: energy at step 3000: total energy"), 0U)
        << ended.out << ended.err;
    EXPECT_EQ(count(last, "\n"), 2U) << "the last line";
    auto const summary = nlohmann::json::parse(std::ifstream(folder / "out/summary.json"));
    EXPECT_EQ(summary.at("verdict").at("valid"), false);
    EXPECT_EQ(summary.at("verdict").at("checks").at(0).at("name"), "joints");
}
TEST(Steps, AStepBeyondTheExplicitLimitIsRefused) {
    TemporaryFolder const folder;
    Words const at{"--set", "dynamics.step=0.7"};
    expect_refused(catena({"run", scene_of("energy-drift-valid"), "--output", "out", at[0], at[1]},
                          folder.path()),
                   2, "0.66");
    expect_refused(catena({"check", scene_of("energy-drift-valid"), at[0], at[1]}), 2,
                   "dynamics.step");
}
TEST(Steps, CheckTellsTheLongestStableStep) {
    Ended const ended =
        catena({"check", scene_of("energy-drift-valid"), "--set", "dynamics.step=0.1"});
    expect_good(ended);
    EXPECT_NE(ended.out.find("longest stable step"), std::string::npos) << ended.out;
}
// Rods of 1e8 and 1e-8 amu in turn, which handles of less digits cannot take.
TEST(Steps, TheLongestStableStepIsFoundWithTheRunsHandles) {
    TemporaryFolder const folder;
    std::ofstream scene(folder / "rods.yaml");
    scene << "chains:\n  - name: r\n    base: fixed\n    bodies:\n";
    for (int k = 0; k < 20; ++k) {
        double const mass = k % 2 == 0 ? 1e8 : 1e-8;
        scene << "      - {mass: " << mass << ", inertia: [" << mass / 1000 << ", " << mass / 12
              << ", " << mass / 12
              << "], com: [0.5, 0, 0], joint: {type: revolute, axis: [0, 0, 1], translation: ["
              << (k == 0 ? 0 : 1) << ", 0, 0], stiffness: 1}}\n";
    }
    scene << "dynamics: {integrator: velocity-verlet, step: 1e-7, steps: 5}\nsolver: {handles: "
             "articulated}\n";
    scene.close();
    expect_good(catena({"check", "rods.yaml"}, folder.path()));
}

// A folded rope with a weight of 10 kg falls by 2 m and is taut within one step of 1 ms.
TEST(Steps, ASlackRopeGoesThroughItsJerk) {
    TemporaryFolder const folder;
    std::ofstream scene(folder / "slack.yaml");
    scene << "units: si\nchains:\n  - name: rope\n    base: fixed\n    anchor: [0, 0, 0]\n    "
             "bodies:\n";
    for (int k = 0; k < 20; ++k)
        scene << "      - {mass: " << (k == 19 ? 10 : 0.1) << ", position: [" << 0.01 * (k + 1)
              << ", 0, " << (k % 2 == 0 ? -0.0995 : 0) << "], joint: {type: link}}\n";
    scene << "forces: {gravity: [0, 0, -9.81]}\ndynamics: {integrator: rattle, step: 1e-3, steps: "
             "700}\n"
             "output: {every: 100, observables: [energy, constraint_error]}\n";
    scene.close();
    EXPECT_EQ(run(folder, "slack.yaml", "700", {"--set", "output.every=100"}).at("valid"), true);
    expect_closed(column(folder, "constraint_error"), 7);
    // Whose sweeps have grown until then, so that they lose the joints' matrices at the jerk.
    EXPECT_EQ(run(folder, "slack.yaml", "700", {"--overwrite"}).at("valid"), true);
    std::vector<double> const alone = column(folder, "total_energy");
    expect_closed(column(folder, "constraint_error"), 700);
    // On two ranks, of which one alone may lose matrices.
    Ended const ended = catena_on(2,
                                  {"run", "slack.yaml", "--output", "out", "--quiet", "--overwrite",
                                   "--set", "output.every=1", "--set", "solver.threads=1"},
                                  folder.path());
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(column(folder, "total_energy"), alone);
}

}  // namespace
}  // namespace catena::test
