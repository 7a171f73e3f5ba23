#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "oracle/oracle.hpp"
#include "reader/load_scene.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

std::string const small = "chains[0].generator.random.bodies=";

Json solved(Words words) {
    words.insert(words.begin(), "solve");
    words.insert(words.end(), {"--json", "-", "--repeat", "1"});
    Ended const e = catena(words);
    expect_good(e);
    return e.json();
}

TEST(Solve, JsonHoldsWhatTheContractNames) {
    Json const json = solved({input("arm.yaml"), "--backend", "segments"});
    for (char const* const key : {"scene",
                                  "chains",
                                  "bodies",
                                  "dof",
                                  "backend",
                                  "ranks",
                                  "threads",
                                  "simd",
                                  "gpu_levels",
                                  "handles",
                                  "seconds",
                                  "phases",
                                  "residual",
                                  "residual_bound",
                                  "rnea_residual",
                                  "valid",
                                  "potential_energy",
                                  "joint_accelerations",
                                  "bead_accelerations",
                                  "bead_forces",
                                  "joint_forces"})
        EXPECT_TRUE(json.contains(key)) << key;
    EXPECT_EQ(
        json["chains"],
        Json::parse(R"([{"name": "arm", "bodies": 4, "kind": "revolute", "base": "fixed"}])"));
    for (char const* const key : {"median", "min", "max", "repeat"})
        EXPECT_TRUE(json["seconds"].contains(key)) << key;
    EXPECT_LE(json["residual"].get<double>(), json["residual_bound"].get<double>());
    EXPECT_TRUE(json["valid"].get<bool>());
    EXPECT_TRUE(json["joint_accelerations"][0].is_number());  // revolute
    EXPECT_EQ(json["joint_accelerations"][1].size(), 3U);     // spherical
    for (Json const& wrench : json["joint_forces"]) EXPECT_EQ(wrench.size(), 6U);
    EXPECT_EQ(json["bead_accelerations"], Json::array());
}

/// The numbers against an independent solver, through the file.
TEST(Solve, AccelerationsAreThoseOfTheOracle) {
    Json const json = solved({input("arm.yaml")});
    Scene const scene = load_scene(input("arm.yaml"));
    auto const expected = oracle::aba<long double>(scene.chains[0], {scene.forces.gravity, {}});
    double largest = 0, difference = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        Json const& found = json["joint_accelerations"][k];
        for (int i = 0; i < (found.is_number() ? 1 : 3); ++i) {
            auto const value = static_cast<double>(expected.qdd[k][i]);
            largest = std::max(largest, std::abs(value));
            difference = std::max(
                difference, std::abs(value - (found.is_number() ? found : found[i]).get<double>()));
        }
        for (int i = 0; i < 3; ++i) {
            auto const force = static_cast<double>(expected.constraint_force[k].force[i]),
                       torque = static_cast<double>(expected.constraint_force[k].torque[i]);
            EXPECT_NEAR(json["joint_forces"][k][3 + i].get<double>(), force, 1e-12 * 200) << k;
            EXPECT_NEAR(json["joint_forces"][k][i].get<double>(), torque, 1e-12 * 200) << k;
        }
    }
    EXPECT_LE(difference, 1e-13 * largest);
}

TEST(Solve, RefinementKeepsTheAnswerAndSaysWhatItTook) {
    Json const plain = solved({input("arm.yaml")}),
               refined = solved({input("arm.yaml"), "--refine", "2"});
    EXPECT_TRUE(plain["refinement"]["seconds_of_each"].empty());
    ASSERT_EQ(refined["refinement"]["seconds_of_each"].size(), 2U);
    EXPECT_GT(refined["refinement"]["seconds_of_each"][0].get<double>(), 0);
    EXPECT_LE(refined["residual"].get<double>(), refined["residual_bound"].get<double>());
    EXPECT_NEAR(refined["joint_accelerations"][0].get<double>(),
                plain["joint_accelerations"][0].get<double>(), 1e-10);
    Json const by_scene = solved({input("arm.yaml"), "--set", "solver.refine=2"});
    EXPECT_EQ(by_scene["joint_accelerations"], refined["joint_accelerations"]);
    Json const overridden =
        solved({input("arm.yaml"), "--set", "solver.refine=2", "--refine", "0"});
    EXPECT_EQ(overridden["joint_accelerations"], plain["joint_accelerations"]);
    expect_refused(catena({"solve", input("arm.yaml"), "--refine", "11"}), 2, "--refine");
    expect_refused(catena({"solve", input("random-link.yaml"), "--refine", "1"}), 2,
                   "cannot be refined (solver.refine): leave it out");
}

TEST(Solve, AFreeBaseHasTwoAccelerations) {
    Json const json = solved({input("spherical-chain.yaml")});
    EXPECT_EQ(json["joint_accelerations"][0]["alpha"].size(), 3U);
    EXPECT_EQ(json["joint_accelerations"][0]["acceleration"].size(), 3U);
    EXPECT_EQ(json["joint_accelerations"][1].size(), 3U);
    EXPECT_EQ(json["joint_forces"][0], Json({0.0, 0.0, 0.0, 0.0, 0.0, 0.0}));
}

/// Two beads of mass 2 hang at rest under gravity 10: the links bear 40 and 20.
TEST(Solve, TensionIsPositiveWhereALinkPulls) {
    TemporaryFolder const folder;
    std::ofstream(folder / "hanging.csv") << "0,0,-1\n0,0,-2\n";
    std::ofstream(folder / "hanging.yaml")
        << "units: si\nforces: {gravity: [0, 0, -10]}\nchains: [{base: fixed, anchor: [0, 0, 0], "
           "positions: hanging.csv, "
           "generator: {freely_jointed: {beads: 2, length: 1, mass: 2}}}]\n";
    for (std::string const handles : {"projected", "full"}) {
        Json const json = solved({folder / "hanging.yaml", "--handles", handles});
        EXPECT_NEAR(json["joint_forces"][0].get<double>(), 40, 1e-13);
        EXPECT_NEAR(json["joint_forces"][1].get<double>(), 20, 1e-13);
        EXPECT_EQ(json["joint_accelerations"], json["bead_accelerations"]);
        EXPECT_NEAR(json["bead_accelerations"][1][2].get<double>(), 0, 1e-13);
        EXPECT_EQ(json["potential_energy"]["gravity"], 2 * 10 * -1.0 + 2 * 10 * -2.0);
    }
}

/// Of two planar chains under gravity across their plane, one held at both ends: the other's joints
/// carry its weight all the same.
TEST(Solve, AChainHeldAtBothEndsLeavesTheForcesOfOthersAcrossThePlane) {
    TemporaryFolder const folder;
    std::string const bar =
                          "{mass: 2, com: [0.5, 0, 0], inertia: [0.1, 0.2, 0.2], joint: {type: "
                          "planar, axis: [0, 0, 1]",
                      free_chain = "  - {name: free, base: fixed, bodies: [" + bar + "}}, " + bar +
                                   ", translation: [1, 0, 0], q: 0.3}}]}\n",
                      head = "units: si\nforces: {gravity: [0, -9.81, -2]}\nchains:\n";
    std::ofstream(folder / "one.yaml") << head << free_chain;
    std::ofstream(folder / "two.yaml")
        << head << free_chain << "  - {name: held, base: fixed, bodies: [" << bar
        << ", q: 1.5707963267948966}}, " << bar
        << ", translation: [1, 0, 0], q: -1.5707963267948966}}, " << bar
        << ", translation: [1, 0, 0], q: -1.5707963267948966}}], tip: {joint: {type: planar, axis: "
           "[0, 0, 1], "
           "translation: [1, 0, 0], anchor: [1, 0, 0]}}}\n";
    Json const one = solved({folder / "one.yaml"})["joint_forces"],
               two = solved({folder / "two.yaml"})["joint_forces"];
    for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(one[k], two[k]) << k;
    EXPECT_NEAR(two[0][5].get<double>(), 8.0, 1e-13);  // both bars' weight along the axis
    EXPECT_EQ(two[2][5].get<double>(), 0.0);           // held twice: not determined
}

TEST(Solve, KnowsTheFixmanPotential) {
    Json const json =
        solved({input("freely-jointed-trimer.yaml"), "--set", "dynamics.fixman=true"});
    EXPECT_LT(json["potential_energy"]["fixman"].get<double>(), 0);
    EXPECT_TRUE(json["rnea_residual"].is_null());  // inverse dynamics does not know it
    EXPECT_TRUE(json["valid"].get<bool>());
}

TEST(Solve, SaysWhatTheReaderOfTheSceneChanged) {
    TemporaryFolder const folder;
    std::ofstream(folder / "scene.yaml")
        << "title: caf\xE9\nchains: [{generator: {pendulum: {links: 3}}}]\n";
    Ended const text = catena({"solve", folder / "scene.yaml", "--repeat", "1"}),
                json = catena({"solve", folder / "scene.yaml", "--json", "-"});
    expect_good(text);
    expect_good(json);
    ASSERT_EQ(json.json().at("notes").size(), 1U);
    EXPECT_NE(text.out.find(json.json().at("notes")[0].get<std::string>()), std::string::npos)
        << text.out;
}

TEST(Solve, ArraysEndAtTenThousandBodies) {
    EXPECT_EQ(
        solved({input("random-link.yaml"), "--set", small + "10000"})["bead_accelerations"].size(),
        10000U);
    Json const larger = solved({input("random-link.yaml"), "--set", small + "10001"});
    EXPECT_FALSE(larger.contains("joint_accelerations"));
    EXPECT_TRUE(larger["rnea_residual"].is_null());
    EXPECT_TRUE(larger["valid"].get<bool>());
}

TEST(Solve, TextNamesTimeResidualAndVerdict) {
    Ended const e =
        catena({"solve", input("random-spherical.yaml"), "--repeat", "3", "--backend", "serial"});
    expect_good(e);
    for (std::string const part : {"serial, projected handles, 1 rank", "median of 3",
                                   "matrix sweep", "bound", "(32 depth eps)\nVALID\n"})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << "\n" << e.out;
}

TEST(Solve, TextShowsTheFirstAccelerations) {
    Ended const arm = catena({"solve", input("arm.yaml"), "--repeat", "1"});
    expect_good(arm);
    Json const json = solved({input("arm.yaml")});
    EXPECT_NE(arm.out.find("arm       1  revolute "), std::string::npos) << arm.out;
    std::string const first = fmt::format("{:.6g}", json["joint_accelerations"][0].get<double>());
    EXPECT_NE(arm.out.find("  " + first + " "), std::string::npos) << first << "\n" << arm.out;
    EXPECT_NE(arm.out.find("rad/s^2\n"), std::string::npos) << arm.out;
    EXPECT_EQ(arm.out.find("other bod"), std::string::npos) << arm.out;
    Ended const many =
        catena({"solve", input("random-link.yaml"), "--repeat", "1", "--set", small + "100"});
    EXPECT_NE(many.out.find("- and 94 other bodies; --accelerations FILE.csv"), std::string::npos)
        << many.out;
    Ended const more =
        catena({"solve", input("random-link.yaml"), "--repeat", "1", "--set", small + "10001"});
    EXPECT_NE(more.out.find("accelerations        of 10001 bodies; --accel"), std::string::npos)
        << more.out;
}

TEST(Solve, TextNamesOnlyTheReasonThatApplies) {
    std::string const loop = catena({"solve", input("four-bar.yaml"), "--repeat", "1"}).out,
                      fixman = catena({"solve", input("freely-jointed-trimer.yaml"), "--repeat",
                                       "1", "--set", "dynamics.fixman=true"})
                                   .out,
                      many = catena({"solve", input("random-revolute.yaml"), "--repeat", "1",
                                     "--set", small + "10001"})
                                 .out;
    EXPECT_NE(loop.find("residual not computed (bodies form a loop)\n"), std::string::npos) << loop;
    EXPECT_NE(fixman.find("residual not computed (inverse dynamics has no Fixman potential)\n"),
              std::string::npos)
        << fixman;
    EXPECT_NE(fixman.find("not estimated (beads and bodies on links are not refined)\n"),
              std::string::npos)
        << fixman;
    EXPECT_NE(many.find("residual not computed (there are more than 10000 bodies)\n"),
              std::string::npos)
        << many;
}

}  // namespace
}  // namespace catena::test
