// `catena analyse` and `catena convert` from outside.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/output_file.hpp"
#include "tests/analysis/sample_trajectory.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

/// Writes a trajectory of chains without a box, with frames at the given steps.
void write_run(std::string const& folder, Topology const& topology,
               std::vector<std::int64_t> const& steps) {
    std::filesystem::create_directories(folder);
    RandomChains draw(1);
    auto const trajectory =
        make_trajectory(folder + "/trajectory.h5md", topology, false, false, {});
    for (std::int64_t const step : steps) {
        Frame frame;
        frame.step = step;
        frame.time = 0.01 * static_cast<double>(step);
        for (Topology::Chain const& chain : topology.chains)
            for (Vec3 const& x : draw.chain(static_cast<std::size_t>(chain.count), 0.38, 0.5))
                frame.positions.push_back(x);
        trajectory->write(frame);
        if (step == steps.front()) write_topology(folder, topology, frame);
    }
    trajectory->close();
}

class Trajectories : public ::testing::Test {
  protected:
    void write(std::string const& name, std::vector<std::int64_t> const& steps,
               Topology const& topology = topology_of({12, 12})) {
        write_run(folder_ / name, topology, steps);
    }
    /// Writes two frames of 12 sites, with some sites of the second one far away: its last ones.
    void write_far(std::string const& name, std::vector<Vec3> const& last) {
        std::filesystem::create_directories(folder_ / name);
        auto const trajectory = make_trajectory(folder_ / name + "/trajectory.h5md",
                                                topology_of({12}), false, false, {});
        for (std::int64_t const step : {0, 1}) {
            Frame frame;
            frame.step = step;
            frame.positions.assign(12, Vec3::zero());
            if (step == 1)
                std::copy(last.begin(), last.end(), frame.positions.end() - std::ssize(last));
            trajectory->write(frame);
        }
        trajectory->close();
    }
    Ended in_folder(Words const& words) { return catena(words, folder_.path()); }
    bool is_there(std::string const& name) { return std::filesystem::exists(folder_ / name); }

    TemporaryFolder folder_;
};

TEST_F(Trajectories, FramesThatTheRunLeavesOutAreNamed) {
    write("run", {0, 10, 20, 30, 40, 50});
    char const* const note =
        "the run's own means leave out the first 2 as equilibration, as --first 2";
    auto const is_noted = [&](std::string const& summary, Words const& more = {}) {
        std::ofstream(folder_ / "run/summary.json") << summary;
        Words words{"analyse", "run"};
        words.insert(words.end(), more.begin(), more.end());
        Ended const e = in_folder(words);
        expect_good(e);
        return e.out.find(note) != std::string::npos;
    };
    std::string const left_out = R"({"equilibration": {"frames": 6, "frames_left_out": 2}})";
    EXPECT_TRUE(is_noted(left_out));
    EXPECT_FALSE(is_noted(left_out, {"--first", "2"}));
    EXPECT_FALSE(is_noted(R"({"equilibration": {"frames": 9, "frames_left_out": 2}})"));
    EXPECT_FALSE(is_noted("{\"equilibration\": {\"frames_left_out\": 2"));
}

TEST_F(Trajectories, AnAnalysisPrintsItsTableAndWritesItsFiles) {
    write("run", {0, 10, 20, 30, 40, 50});
    Ended const e = in_folder({"analyse", "run", "--discard", "0.4"});
    expect_good(e);
    for (std::string const part :
         {"frames", "4 of 6, steps 20 to 50", "2 x chain of 12 sites", "radius_of_gyration",
          "weighted by mass", "scaling_exponent", "persistence_length", "contacts_within",
          "distance to 1 nm, s >= 3", "run/analysis/summary.csv"})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << "\n" << e.out;
    for (std::string const name :
         {"summary.csv", "internal_distances.csv", "bond_correlation.csv", "maps.h5"})
        EXPECT_TRUE(is_there("run/analysis/" + name)) << name;
    EXPECT_FALSE(is_there("run/analysis/density.csv"));
    std::ofstream(folder_ / "run/analysis/density.csv") << "of an earlier analysis";
    expect_good(in_folder({"analyse", "run", "--cutoff", "0"}));
    EXPECT_FALSE(is_there("run/analysis/density.csv"));
    EXPECT_NE(read_text_file(folder_ / "run/analysis/summary.csv").find("asphericity,chain,,"),
              std::string::npos);
}

/// Six replicas of two chains, all at the same places: no contacts between replicas.
TEST_F(Trajectories, ReplicasAreIndependent) {
    Topology topology = topology_of({12, 12, 12, 12, 12, 12, 12, 12, 12, 12, 12, 12});
    write("together", {0, 10, 20, 30}, topology);
    for (std::size_t c = 0; c < topology.chains.size(); ++c)
        topology.chains[c].replica = static_cast<std::int64_t>(c / 2);
    write("replicas", {0, 10, 20, 30}, topology);
    auto const contacts = [&](std::string const& name) {
        Ended const e = in_folder({"analyse", name, "--json", name + ".json"});
        expect_good(e);
        EXPECT_EQ(e.out.find("6 replicas are independent of each other") != std::string::npos,
                  name == "replicas");
        nlohmann::json const found = nlohmann::json::parse(std::ifstream(folder_ / name + ".json"));
        for (auto const& each : found.at("quantities"))
            if (name == "replicas" && each.at("name") == "radius_of_gyration") {
                EXPECT_GE(each.at("error_by_blocking").get<double>(),
                          each.at("error_between_copies").get<double>());
            } else if (each.at("name") == "contacts_between") {
                return each.at("value").get<double>();
            }
        return -1.0;
    };
    double const together = contacts("together"), replicas = contacts("replicas");
    EXPECT_GT(replicas, 0);
    EXPECT_GT(together, 5 * replicas);
}

TEST_F(Trajectories, WhatCannotBeComputedIsRefusedInOneLine) {
    write("run", {0, 10});
    expect_refused(in_folder({"analyse"}), 2, "no folder is named (command line)");
    expect_refused(in_folder({"analyse", "nowhere"}), 2, "there is no trajectory (nowhere)");
    expect_refused(
        in_folder({"analyse", "run", "--slab", "z"}), 2,
        "a density profile needs a periodic box, and the trajectory has none (--slab z)");
    expect_refused(in_folder({"analyse", "run", "--slab", "w"}), 2, "`w` is not a value of --slab");
    expect_refused(in_folder({"analyse", "run", "--first", "2"}), 2,
                   "there is no frame from 2 on, the trajectory has 2 (--first)");
    for (Words const& command : {Words{"analyse", "run"}, Words{"convert", "run", "a.dcd"}}) {
        Words words = command;
        words.insert(words.end(), {"--first", "1", "--last", "0"});
        expect_refused(in_folder(words), 2, "the last frame, 0, is before the first, 1 (--last)");
    }
    expect_refused(in_folder({"analyse", "run", "--discard", "1"}), 2, "(--discard)");
    expect_refused(in_folder({"analyse", "run", "--first", "1", "--discard", "0.1"}), 2,
                   "both --first and --discard");
    expect_refused(in_folder({"analyse", "run", "--fit", "9"}), 2,
                   "`9` is not two numbers (--fit)");
    expect_refused(in_folder({"analyse", "run", "--fit", "9,3"}), 2, "`9,3` is no range (--fit)");
    expect_refused(in_folder({"analyse", "run", "--bins", "11"}), 2, "11 is odd (--bins)");
    expect_refused(in_folder({"analyse", "run", "--cutoff", "-1"}), 2, "(--cutoff)");
    EXPECT_FALSE(is_there("run/analysis"));
}

TEST_F(Trajectories, OtherFilesAreNoTrajectories) {
    std::ofstream(folder_ / "text.h5md") << "no HDF5 at all";
    expect_refused(in_folder({"analyse", "text.h5md"}), 2,
                   "the file is no trajectory of Catena (text.h5md): give the folder of a run, or "
                   "the trajectory.h5md in it");
    write("cut", {0, 10, 20});
    std::filesystem::resize_file(folder_ / "cut/trajectory.h5md", 3000);
    expect_refused(in_folder({"analyse", "cut"}), 2,
                   "the trajectory was cut, its end is missing (cut/trajectory.h5md)");
    write("other", {0, 10});
    std::filesystem::copy_file(folder_ / "other/topology.pdb", folder_ / "kept.pdb");
    write_run(folder_ / "other", topology_of({5}), {0});
    std::filesystem::copy_file(folder_ / "kept.pdb", folder_ / "other/topology.pdb",
                               std::filesystem::copy_options::overwrite_existing);
    expect_refused(in_folder({"analyse", "other"}), 2,
                   "the topology has 24 sites, but the trajectory 5 (other/topology.pdb)");
}

TEST_F(Trajectories, OneFrameHasValuesWithoutErrors) {
    write("run", {0});
    Ended const e = in_folder({"analyse", "run", "--json", "-"});
    expect_good(e);
    auto const answer = e.json();
    for (auto const& quantity : answer.at("quantities")) {
        if (quantity.at("name") != "radius_of_gyration") continue;
        EXPECT_GT(quantity.at("value").get<double>(), 0);
        EXPECT_TRUE(quantity.at("error_by_blocking").is_null());
    }
}

TEST_F(Trajectories, MissingResiduesAreNoted) {
    write("run", {0, 10});
    std::filesystem::remove(folder_ / "run/topology.pdb");
    Ended const e = in_folder({"analyse", "run/trajectory.h5md"});
    expect_good(e);
    EXPECT_NE(e.out.find("chains with equal masses are taken as copies"), std::string::npos);
}

TEST_F(Trajectories, DcdHoldsWhatItsFormatCan) {
    write("run", {0, 100, 200, 250});
    Ended const e = in_folder({"convert", "run", "run.dcd", "--json", "-"});
    expect_good(e);
    EXPECT_EQ(e.json().at("frames"), 3);
    EXPECT_EQ(e.json().at("left_out"), 1);
    // Header 92, titles 172, sites 12, three frames of three records of 24 floats.
    EXPECT_EQ(std::filesystem::file_size(folder_ / "run.dcd"), 92U + 172 + 12 + 3 * 3 * 104);
    write("gap", {0, 100, 200, 400});
    expect_refused(in_folder({"convert", "gap", "gap.dcd"}), 2,
                   "frames are not evenly spaced: after step 200 there is none 100 steps on");
    EXPECT_FALSE(is_there("gap.dcd"));
    expect_refused(in_folder({"convert", "run", "run.trr"}), 2, "is no name of a DCD or XTC file");
    expect_refused(in_folder({"convert", "run", "run.dcd", "--precision", "10"}), 2,
                   "a DCD file is not rounded (--precision)");
    expect_refused(in_folder({"convert", "run", "run.dcd", "--wrap", "chains"}), 2,
                   "there is no periodic box to wrap into");
    Topology metres = topology_of({12});
    metres.si = true;
    write("si", {0, 10}, metres);
    expect_refused(in_folder({"convert", "si", "si.dcd"}), 2, "a DCD file holds Angstrom");
}

TEST_F(Trajectories, XtcHoldsEveryFrameWithItsStep) {
    write("run", {0, 100, 200, 250});
    Ended const e = in_folder({"convert", "run", "run.xtc", "--json", "-"});
    expect_good(e);
    EXPECT_EQ(e.json().at("frames"), 4);
    EXPECT_EQ(e.json().at("last_step"), 250);
    EXPECT_EQ(e.json().at("precision"), 1000);
    EXPECT_EQ(e.json().at("bytes"), std::filesystem::file_size(folder_ / "run.xtc"));
    std::string const bytes = read_text_file(folder_ / "run.xtc");
    EXPECT_EQ(bytes.substr(0, 12), std::string("\0\0\x07\xcb\0\0\0\x18\0\0\0\0", 12));
    // The last frame alone: step 250, 2.5 ps, no box.
    expect_good(in_folder({"convert", "run", "last.xtc", "--first", "3", "--quiet"}));
    EXPECT_EQ(read_text_file(folder_ / "last.xtc").substr(8, 44),
              std::string("\0\0\0\xfa\x40\x20\0\0", 8) + std::string(36, '\0'));
}

TEST_F(Trajectories, XtcOfFewSitesIsNotRounded) {
    write("few", {0}, topology_of({9}));
    expect_good(in_folder({"convert", "few", "few.xtc"}));
    EXPECT_EQ(std::filesystem::file_size(folder_ / "few.xtc"), 16U + 36 + 4 + 9 * 12);
}

TEST_F(Trajectories, WhatAnXtcFileCannotHoldIsRefusedAndLeavesNoFile) {
    write("run", {0, 10});
    expect_refused(in_folder({"convert", "run", "a.xtc", "--wrap", "chains"}), 2,
                   "there is no periodic box to wrap into");
    expect_refused(in_folder({"convert", "run", "a.xtc", "--first", "2"}), 2,
                   "no frame from 2 on, the trajectory has 2 (--first)");
    expect_refused(in_folder({"convert", "run", "a.xtc", "--precision", "0"}), 2, "(--precision)");
    write("late", {0, 3000000000});
    expect_refused(in_folder({"convert", "late", "a.xtc"}), 2,
                   "an XTC file holds steps up to 2147483647 (late/trajectory.h5md)");
    Topology metres = topology_of({12});
    metres.si = true;
    write("si", {0, 10}, metres);
    expect_refused(in_folder({"convert", "si", "a.xtc"}), 2, "an XTC file holds nm");
    write_far("far", {{3e6, 0, 0}});
    expect_refused(in_folder({"convert", "far", "a.xtc"}), 2,
                   "site 12 of frame 1 is at 3e+06 nm, and an XTC file of precision 1000 holds "
                   "coordinates up to 2.147e+06 nm (far/trajectory.h5md)");
    expect_good(in_folder({"convert", "far", "a.xtc", "--precision", "100", "--quiet"}));
    std::filesystem::remove(folder_ / "a.xtc");
    write_far("wide", {{2e6, 0, 0}, {-2e6, 0, 0}});
    expect_refused(in_folder({"convert", "wide", "a.xtc"}), 2,
                   "the sites of frame 1 are up to 4e+06 nm apart");
    for (auto const& entry : std::filesystem::directory_iterator(folder_.path()))
        EXPECT_EQ(entry.path().string().find("a.xtc"), std::string::npos) << entry.path();
}

TEST_F(Trajectories, MembersOfAComplexAreChainsIfAskedFor) {
    // Members of 6 sites, the second backwards behind the first.
    Topology topology = topology_of({12});
    topology.chains[0].name = "H+L";
    topology.members = {{"H", "L"}, {{0, 6, 0, 0, 10, 1}, {6, 6, 1, 5, 6, -1}}};
    topology.residue[0] = topology.residue[11] = "MET";
    write("run", {0, 10, 20}, topology);
    Ended const whole = in_folder({"analyse", "run"});
    expect_good(whole);
    EXPECT_NE(whole.out.find("1 x H+L of 12 sites"), std::string::npos) << whole.out;
    EXPECT_NE(whole.out.find("--members takes each member as a chain"), std::string::npos);
    EXPECT_NE(whole.out.find("radius_of_gyration"), std::string::npos);
    for (char const* const name : {"end_to_end_distance", "scaling_exponent", "bond_length"})
        EXPECT_EQ(whole.out.find(name), std::string::npos) << name;
    Ended const members = in_folder({"analyse", "run", "--members"});
    expect_good(members);
    EXPECT_NE(members.out.find("2 x H+L:H and L of 6 sites"), std::string::npos) << members.out;
    EXPECT_NE(members.out.find("end_to_end_distance"), std::string::npos);
    EXPECT_EQ(members.out.find("--members takes"), std::string::npos);
}

/// A ring of sites that moves as one.
TEST_F(Trajectories, AChainWhoseSizeDoesNotVaryIsNoted) {
    std::filesystem::create_directories(folder_ / "rigid");
    auto const trajectory =
        make_trajectory(folder_ / "rigid/trajectory.h5md", topology_of({12}), false, false, {});
    for (std::int64_t const step : {0, 1, 2}) {
        Frame frame;
        frame.step = step;
        for (int k = 0; k < 12; ++k)
            frame.positions.push_back(
                {{std::cos(0.6 * k) + static_cast<double>(step), std::sin(0.6 * k), 0.1 * k}});
        trajectory->write(frame);
    }
    trajectory->close();
    Ended const e = in_folder({"analyse", "rigid"});
    expect_good(e);
    EXPECT_NE(e.out.find("% only, as in a folded chain or a short run: its scaling exponent and "
                         "persistence length do not describe a flexible chain"),
              std::string::npos)
        << e.out;
    write("flexible", {0, 10, 20, 30, 40});
    EXPECT_EQ(in_folder({"analyse", "flexible"}).out.find("folded chain"), std::string::npos);
}

TEST_F(Trajectories, EndingsMayBeInCapitals) {
    write("run", {0, 10});
    expect_good(in_folder({"convert", "run", "RUN.XTC"}));
    expect_good(in_folder({"convert", "run", "RUN.DCD"}));
    EXPECT_TRUE(is_there("RUN.XTC"));
    EXPECT_EQ(std::filesystem::file_size(folder_ / "RUN.DCD"), 92U + 172 + 12 + 2 * 3 * 104);
}

TEST_F(Trajectories, ARestartedRunLosesNoFrame) {
    Words const run{"run",      input("freely-jointed-trimer.yaml"),
                    "--set",    "output.every=10",
                    "--output", "trimer",
                    "--quiet",  "--steps"};
    Words first = run, second = run;
    first.push_back("25");
    second.insert(second.end(), {"50", "--restart", "trimer/checkpoint.h5"});
    ASSERT_EQ(in_folder(first).status, 0);
    Ended const before = in_folder({"convert", "trimer", "trimer.dcd", "--json", "-"});
    expect_good(before);
    EXPECT_EQ(before.json().at("frames"), 3);  // 0, 10, 20; the last state is between
    EXPECT_EQ(before.json().at("left_out"), 1);
    ASSERT_EQ(in_folder(second).status, 0);
    Ended const after = in_folder({"convert", "trimer", "trimer.dcd", "--json", "-"});
    expect_good(after);
    EXPECT_EQ(after.json().at("frames"), 6);
    EXPECT_EQ(after.json().at("left_out"), 0);
}

}  // namespace
}  // namespace catena::test
