#include <fstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

TEST(Check, SaysWhatTheSceneIs) {
    Ended const e = catena({"check", input("arm.yaml")});
    expect_good(e);
    for (std::string const part :
         {"degrees of freedom   6", "springs on 2 joints, dampers on 1 joint", "rk4, 2000 steps of 0.001 s", "The scene is valid."})
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
    auto const links =
        catena({"check", input("random-link.yaml"), "--set", "chains[0].base=fixed", "--handles", "full", "--json", "-"}).json();
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

TEST(Plan, SaysWhatRunsAndWhatIsLeftOut) {
    Ended const e = catena({"plan", input("random-revolute.yaml"), "--backend", "serial", "--handles", "full"});
    expect_good(e);
    for (std::string const part : {"serial (asked for)", "6x6, every direction", "runs of 1, 1000 of them, then 10 levels",
                                   "left out\n  - ", "no prediction of times in this version"})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << "\n" << e.out;
}

TEST(Plan, JsonNamesTreeAndSweeps) {
    auto const json = catena({"plan", input("spherical-chain.yaml"), "--json", "-", "--backend", "segments"}).json();
    auto const& group = json.at("groups").at(0);
    EXPECT_EQ(group.at("directions"), 3);
    EXPECT_EQ(group.at("collectives").at("matrices"), 0);
    EXPECT_EQ(group.at("bodies_of_ranks"), nlohmann::json({100}));
    EXPECT_EQ(json.at("dynamics").at("matrix_sweeps_a_step"), 1);
    EXPECT_EQ(json.at("output").at("frames"), 101);
    EXPECT_TRUE(json.at("predicted_seconds").is_null());
    auto const langevin = catena({"plan", input("freely-jointed-trimer.yaml"), "--json", "-"}).json();
    EXPECT_EQ(langevin.at("dynamics").at("matrix_sweeps_a_step"), 2);
}

}  // namespace
}  // namespace catena::test
