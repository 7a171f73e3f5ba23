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

TEST(Run, SummaryOnTheTerminal) {
    TemporaryFolder const folder;
    Ended const e =
        catena({"run", input("arm.yaml"), "--steps", "20", "--output", "a/b"}, folder.path());
    EXPECT_EQ(e.status, 0) << e.err;
    for (std::string const part :
         {"steps/s", "constraint error", "total_energy [J]", "a/b/trajectory.h5md", "\nVALID\n"})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << "\n" << e.out;
    EXPECT_TRUE(fs::exists(folder / "a/b/checkpoint.h5"));
}

}  // namespace
}  // namespace catena::test
