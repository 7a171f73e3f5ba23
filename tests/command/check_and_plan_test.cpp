#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "tests/command/program.hpp"
#include "tests/domains/helix.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

TEST(Check, SaysWhatTheSceneIs) {
    Ended const e = catena({"check", input("arm.yaml")});
    expect_good(e);
    for (std::string const part :
         {"degrees of freedom   6", "springs on 2 joints, dampers on 1 joint",
          "rk4, 2000 steps of 0.001 s", "The scene is valid."})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << "\n" << e.out;
}

TEST(Check, JsonHoldsTheSame) {
    auto const json = catena({"check", input("spherical-chain.yaml"), "--json", "-"}).json();
    EXPECT_EQ(json.at("bodies"), 100);
    EXPECT_EQ(json.at("dof"), 6 + 99 * 3);
    EXPECT_EQ(json.at("chains").at(0).at("kind"), "spherical");
    EXPECT_EQ(json.at("handles").at("bodies"), 3);
    EXPECT_EQ(json.at("dynamics").at("integrator"), "rattle");
    EXPECT_GT(json.at("memory_bytes_per_rank").at("state").get<double>(), 100 * 100 * 8);
    EXPECT_EQ(json.at("valid"), true);
    auto const links = catena({"check", input("random-link.yaml"), "--set", "chains[0].base=fixed",
                               "--handles", "full", "--json", "-"})
                           .json();
    EXPECT_EQ(links.at("dof"), 2000);
    EXPECT_EQ(links.at("handles").at("beads"), 3);
}

TEST(Check, QuietPrintsNothingAndWritesTheFile) {
    TemporaryFolder const folder;
    Ended const e = catena({"check", input("arm.yaml"), "--quiet", "--json", folder / "arm.json"});
    expect_good(e);
    EXPECT_EQ(e.out, "");
    EXPECT_EQ(nlohmann::json::parse(std::ifstream(folder / "arm.json")).at("dof"), 6);
}

TEST(Check, TheLogGoesToStandardError) {
    Ended const e = catena({"check", input("arm.yaml"), "--log-level", "debug"});
    EXPECT_EQ(e.status, 0);
    EXPECT_NE(e.err.find("catena: debug: "), std::string::npos) << e.err;
}

/// A predicted structure of two domains and a loop of 12 residues between them.
void write_prediction(TemporaryFolder const& folder, double between) {
    std::vector<AtomLine> atoms = helix(62, "A");
    std::string rows;
    for (int i = 0; i < 62; ++i) {
        auto const part = [](int k) { return k < 25 ? 0 : k < 37 ? 1 : 2; };
        atoms[static_cast<std::size_t>(i)].b_factor = part(i) == 1 ? 40 : 90;
        std::vector<double> row;
        for (int j = 0; j < 62; ++j) row.push_back(part(i) == part(j) ? 2 : between);
        rows += fmt::format("{}[{}]", i == 0 ? "" : ", ", fmt::join(row, ", "));
    }
    std::ofstream(folder / "a.pdb") << pdb_text(atoms);
    std::ofstream(folder / "pae.json") << "[{\"predicted_aligned_error\": [" << rows << "]}]";
    std::ofstream(folder / "s.yaml")
        << "chains: [{name: p, pdb: a.pdb, model: calvados2, rigid: {pae: pae.json}}]\n";
}

TEST(Check, SaysAndDrawsTheDomainsOfAPrediction) {
    TemporaryFolder const folder;
    write_prediction(folder, 20);
    Ended const e = catena({"check", "s.yaml", "--picture", "domains.svg"}, folder.path());
    expect_good(e);
    EXPECT_NE(e.out.find("chain `p`: 2 rigid domains by `pae.json`, pLDDT 70 and more, errors of 5 "
                         "angstrom at most: residues 1-25, 38-62"),
              std::string::npos)
        << e.out;
    std::ifstream svg(folder / "domains.svg");
    std::string const text(std::istreambuf_iterator<char>(svg), {});
    EXPECT_NE(text.find("Rigid domains of chain p"), std::string::npos);
}

/// A loop of a domain is refused; the picture shows it all the same.
TEST(Check, DrawsDomainsThatItRefuses) {
    TemporaryFolder const folder;
    write_prediction(folder, 3);
    Ended const e = catena({"check", "s.yaml", "--picture", "domains.svg"}, folder.path());
    expect_refused(e, 2, "residues 26 to 37 would be a flexible loop");
    EXPECT_TRUE(std::filesystem::exists(folder / "domains.svg"));
}

TEST(Check, DrawsNoPictureWithoutAPredictionOrFolder) {
    TemporaryFolder const folder;
    write_prediction(folder, 20);
    expect_refused(
        catena({"check", "s.yaml", "--picture", "nodir/x.svg"}, folder.path()), 2,
        "no such folder: nodir (--picture nodir/x.svg): create it, or name another file");
    expect_refused(catena({"check", input("arm.yaml"), "--picture", folder / "a.svg"}), 2,
                   "no chain of the scene decides its rigid domains by a prediction");
    expect_refused(catena({"check", input("arm.yaml"), "--picture", folder / "a.png"}), 2,
                   "the picture is an SVG file");
}

TEST(Plan, SaysWhatRunsAndWhatIsLeftOut) {
    Ended const e =
        catena({"plan", input("random-revolute.yaml"), "--backend", "serial", "--handles", "full"});
    expect_good(e);
    for (std::string const part :
         {"serial (requested)", "6x6, every direction",
          "1000 runs of up to 1 bodies, then 10 levels", "left out\n  - ",
          "predicted times of one evaluation", "serial *", "memory per rank"})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << "\n" << e.out;
}

TEST(Plan, JsonNamesTreeAndSweeps) {
    auto const json =
        catena({"plan", input("spherical-chain.yaml"), "--json", "-", "--backend", "segments"})
            .json();
    auto const& group = json.at("groups").at(0);
    EXPECT_EQ(group.at("directions"), 3);
    EXPECT_EQ(group.at("collectives").at("matrices"), 0);
    EXPECT_EQ(group.at("bodies_of_ranks"), nlohmann::json({100}));
    EXPECT_EQ(json.at("dynamics").at("matrix_sweeps_a_step"), 1);
    EXPECT_EQ(json.at("output").at("frames"), 101);
    for (char const* const arrangement : {"segments", "serial"})
        EXPECT_GT(json.at("predicted_seconds").at(arrangement).at("evaluation").get<double>(), 0);
    EXPECT_GT(json.at("memory_bytes_per_rank").at("gpu").get<double>(), 0);
    auto const langevin =
        catena({"plan", input("freely-jointed-trimer.yaml"), "--json", "-"}).json();
    EXPECT_EQ(langevin.at("dynamics").at("matrix_sweeps_a_step"), 2);
}

/// One rank computes a whole branched chain, so that more ranks do not help a single one.
TEST(Plan, PredictsWholeBranchedChainsOnRanks) {
    TemporaryFolder const folder;
    for (int const chains : {1, 4}) {
        std::string const scene = folder / "stars.yaml";
        std::ofstream(scene) << "chains: [{name: star, count: " << chains
                             << ", generator: {star: {arms: 4, arm_length: 50, length: 0.4}}}]\n"
                                "dynamics: {integrator: g-baoab, step: 0.01, steps: 10}\n";
        Ended const e = catena({"plan", scene, "--ranks", "4", "--latency", "2us", "--bandwidth",
                                "10GB/s", "--json", "-"});
        expect_good(e);
        auto const row = e.json().at("network").at("predicted").back();
        EXPECT_EQ(row.at("ranks"), 4) << e.out;
        EXPECT_EQ(row.at("bodies_a_rank"), 201) << e.out;
        EXPECT_EQ(row.at("gathers"), 0) << e.out;
        EXPECT_EQ(row.at("message_seconds"), 0) << e.out;
    }
}

TEST(Plan, DescribesThePathsOfBranchedChains) {
    TemporaryFolder const folder;
    std::string const scene = folder / "stars.yaml";
    std::ofstream(scene) << "chains: [{name: star, count: 3, generator: {star: {arms: 4, "
                            "arm_length: 5, length: 0.4}}}]\n";
    Ended const e = catena({"plan", scene});
    expect_good(e);
    for (std::string const part :
         {"3 branched chains of beads", "63 bodies in 12 paths and 2 phases",
          "predicted as unbranched ones"})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << "\n" << e.out;
    auto const json = catena({"plan", scene, "--json", "-"}).json();
    // The first arm goes on from the centre: paths of 6 beads, sums of three side paths of 5 beads.
    EXPECT_EQ(json.at("groups").at(0).at("depth"), 5 + 3 + 4);
    EXPECT_EQ(json.at("groups").at(0).at("runs"), 3 + 9);
    EXPECT_GT(json.at("memory_bytes_per_rank").at("gpu"), 0);
    for (char const* const handles : {"full", "articulated"})
        expect_refused(catena({"check", scene, "--handles", handles}), 2, "projected");
}

TEST(Plan, ImplicitJointsInAbsoluteCoordinatesAreNotMeasured) {
    expect_refused(catena({"plan", input("dna-rod.yaml"), "--measure"}), 2,
                   "no evaluation outside a step");
}

TEST(Plan, ExplainsWhatIsSavedAndMeasuresWhatWasPredicted) {
    auto const json =
        catena({"plan", input("random-revolute.yaml"), "--backend", "segments", "--set",
                "chains[0].generator.random.bodies=200", "--explain", "--measure", "--json", "-"})
            .json();
    EXPECT_GE(json.at("savings").size(), 4U);
    for (auto const& each : json.at("savings")) {
        bool const projection =
            each.at("left_out").get<std::string>().find("of 6 directions") != std::string::npos;
        if (!projection) continue;
        EXPECT_GT(each.at("seconds").get<double>(), 0);
    }
    EXPECT_GT(json.at("measured_seconds").at("matrix sweep").get<double>(), 0);
    EXPECT_GT(json.at("measured_seconds").at("ratio").get<double>(), 0);
}

TEST(Plan, AutoIsSaidOnceWithItsReason) {
    for (std::string const command : {"plan", "solve"}) {
        Ended const e = catena({command, input("random-revolute.yaml"), "--threads", "2"});
        expect_good(e);
        EXPECT_EQ(count(e.out, "auto: "), 1U) << e.out;
    }
    EXPECT_EQ(catena({"solve", input("arm.yaml"), "--backend", "segments", "--json", "-"})
                  .json()
                  .at("backend_reason"),
              "requested");
}

/// Between 1 us a message and 1 GB/s, whatever the machine.
std::string told_network(TemporaryFolder const& folder) {
    std::string const file = folder / "network.json",
                      link = R"({"latency": 1e-6, "seconds_a_byte": 1e-9})";
    std::ofstream(file) << R"({"network": {"near": )" << link << R"(, "far": )" << link
                        << R"(, "gather_overhead": 1}})";
    return file;
}

TEST(Plan, PredictsStepsOnMoreRanks) {
    TemporaryFolder const folder;
    Words const words{"plan",      input("freely-jointed-trimer.yaml"),
                      "--set",     "chains[0].generator.freely_jointed.beads=2000",
                      "--ranks",   "96",
                      "--hosts",   "12",
                      "--network", told_network(folder)};
    Words with_json = words;
    with_json.insert(with_json.end(), {"--json", "-"});
    auto const network = catena(with_json).json().at("network");
    auto const& rows = network.at("predicted");
    std::vector<int> ranks;
    for (auto const& row : rows) {
        ranks.push_back(row.at("ranks"));
        double const computing = row.at("computing_seconds"), messages = row.at("message_seconds"),
                     step = row.at("step_seconds");
        EXPECT_GT(computing, 0);
        EXPECT_EQ(messages > 0, ranks.back() > 1);
        EXPECT_DOUBLE_EQ(step, computing + messages);
        EXPECT_DOUBLE_EQ(row.at("speed_up"), rows[0].at("step_seconds").get<double>() / step);
        EXPECT_DOUBLE_EQ(row.at("efficiency"), row.at("speed_up").get<double>() / ranks.back());
    }
    EXPECT_EQ(ranks, (std::vector<int>{1, 2, 4, 8, 16, 32, 64, 96}));
    EXPECT_EQ(rows[0].at("speed_up"), 1);
    EXPECT_EQ(rows[0].at("bodies_a_rank"), 2000);
    EXPECT_GE(rows[1].at("bodies_a_rank"), 1000);
    EXPECT_EQ(rows[1].at("hosts"), 1);
    EXPECT_EQ(rows.back().at("hosts"), 12);
    Ended const e = catena(words);
    expect_good(e);
    for (std::string const part : {"speed-up", "efficiency", "predicted messages per step",
                                   "every rank is assumed to be like this one"})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << "\n" << e.out;
}

/// Where home cannot be written, nothing is kept and nothing else is different.
TEST(Plan, WorksWithoutAPlaceForItsCache) {
    Words words{program(), "plan", input("arm.yaml")};
    Ended const e = run_program(words, "", {"XDG_CACHE_HOME=/proc/nowhere"});
    expect_good(e);
    EXPECT_NE(e.out.find("predicted times"), std::string::npos) << e.out;
}

}  // namespace
}  // namespace catena::test
