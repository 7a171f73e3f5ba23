// mpirun with the executable: one voice, one status, the same numbers.
#include <filesystem>
#include <fstream>

#include "cuda/device/gpu.hpp"
#include "force/openmm_force.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

TEST(Ranks, EveryCommandPrintsOnce) {
    TemporaryFolder const folder;
    std::string const arm = input("arm.yaml");
    for (auto const& [words, part] : std::vector<std::pair<Words, std::string>>{
             {{"--version"}, "catena "},
             {{"solve", "--help"}, "Usage:"},
             {{"check", arm}, "The scene is valid."},
             {{"plan", arm}, "left out"},
             {{"solve", arm, "--repeat", "1"}, "\nVALID"},
             {{"bench", "solve", "--sizes", "9", "--joints", "link", "--backend", "segments",
               "--repeat", "1"},
              " VALID"},
             {{"report", arm, "--repeat", "1", "--backend", "segments"}, "\nVALID"}}) {
        Ended const e = catena_on(3, words, folder.path());
        EXPECT_EQ(e.status, 0) << words[0] << e.err;
        EXPECT_EQ(count(e.out, part), 1U) << words[0] << ":\n" << e.out;
    }
}

TEST(Ranks, MoreRanksThanBodies) {
    auto const json =
        catena_on(6, {"solve", input("arm.yaml"), "--repeat", "1", "--json", "-"}).json();
    EXPECT_EQ(json.at("ranks"), 6);
    EXPECT_EQ(json.at("joint_accelerations").size(), 4U);
}

TEST(Ranks, InputErrorsAreOneLineAndStatusTwo) {
    expect_refused(catena_on(3, {"solve", "missing.yaml"}), 2, "missing.yaml");
    expect_refused(catena_on(3, {"slove"}), 2, "did you mean `solve`?");
    expect_refused(catena_on(2, {"solve", input("arm.yaml"), "--json", "/no/such/folder/x"}), 2,
                   "no such folder");
}

TEST(Ranks, AGpuThatIsNotThereEndsThemAll) {
    if (cuda::why_not().empty()) GTEST_SKIP() << "NOT RUN: this machine has a GPU";
    expect_refused(catena_on(3, {"solve", input("arm.yaml"), "--backend", "cuda"}), 2,
                   cuda::why_not() + ", rank 0 (solver.backend: cuda)");
}

TEST(Ranks, AFailureThatEveryRankMeetsIsOneLineAndStatusOne) {
    TemporaryFolder const folder;
    Ended const e = catena_on(3,
                              {"run", input("spherical-chain.yaml"), "--set", "dynamics.step=50",
                               "--steps", "2", "--quiet"},
                              folder.path());
    EXPECT_EQ(e.status, 1);
    EXPECT_EQ(count(e.err, "catena: "), 1U) << e.err;
}

TEST(Ranks, TheRunSaysTheSharesOfItsRanks) {
    TemporaryFolder const folder;
    Words const balanced{"run",      input("spherical-chain.yaml"),
                         "--set",    "solver.balance=true",
                         "--output", folder / "run"};
    auto const with = [&](Words words, Words const& more) {
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    Ended const first = catena_on(2, with(balanced, {"--steps", "5"}));
    EXPECT_EQ(first.status, 0) << first.err;
    EXPECT_NE(first.out.find("bodies, by the ranks' speeds, as measured at the start"),
              std::string::npos)
        << first.out;
    auto const parallel =
        nlohmann::json::parse(std::ifstream(folder / "run/summary.json")).at("parallel");
    ASSERT_EQ(parallel.at("shares").size(), 2U);
    EXPECT_NEAR(parallel.at("shares")[0].get<double>() + parallel.at("shares")[1].get<double>(), 1,
                1e-12);
    Ended const second =
        catena_on(2, with(balanced, {"--steps", "10", "--restart", folder / "run/checkpoint.h5"}));
    EXPECT_EQ(second.status, 0) << second.err;
    EXPECT_NE(second.out.find("bodies, by the checkpoint's shares"), std::string::npos)
        << second.out;
    EXPECT_NE(catena_on(2, {"plan", input("spherical-chain.yaml"), "--set", "solver.balance=true"})
                  .out.find("divides the chains accordingly"),
              std::string::npos);
}

TEST(Ranks, TheRunSaysWhatGhostsCost) {
    if (openmm_version() == "none") GTEST_SKIP() << "NOT RUN: built without OpenMM";
    TemporaryFolder const folder;
    Ended const e = catena_on(3, {"run", input("alpha-synuclein.yaml"), "--steps", "20", "--set",
                                  "forces.openmm.audit=true", "--output", folder / "run"});
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_NE(e.out.find("own beads on a rank, lists made"), std::string::npos) << e.out;
    auto const ghosts =
        nlohmann::json::parse(std::ifstream(folder / "run/summary.json")).at("forces").at("ghosts");
    EXPECT_EQ(ghosts.at("evaluations"), 21);
    for (char const* const key :
         {"own_beads", "ghosts", "most_ghosts", "contexts", "messages_a_step", "bytes_a_step"})
        EXPECT_EQ(ghosts.at(key).size(), 3U) << key;
}

TEST(Ranks, AFullDiskOnRankZeroEndsAllInGoodOrder) {
    Ended const e = catena_on(
        3, {"solve", input("arm.yaml"), "--repeat", "1", "--quiet", "--json", "/dev/full"});
    expect_refused(e, 1, "/dev/full");
}

TEST(Ranks, TheSameNumbersInTheFile) {
    for (auto const& [scene, bodies] : {std::pair{"random-link.yaml", "10000"},
                                        {"random-spherical.yaml", "256"},
                                        {"random-revolute.yaml", "257"}}) {
        nlohmann::json expected;
        for (int const ranks : {1, 2, 3, 5, 6}) {
            Ended const e =
                catena_on(ranks, {"solve", input(scene), "--set",
                                  std::string("chains[0].generator.random.bodies=") + bodies,
                                  "--repeat", "1", "--backend", "segments", "--json", "-"});
            ASSERT_EQ(e.status, 0) << e.err;
            nlohmann::json const json = e.json();
            EXPECT_EQ(json.at("ranks"), ranks);
            if (ranks == 1) expected = json;
            for (char const* const key : {"joint_accelerations", "joint_forces"})
                EXPECT_EQ(json.at(key).dump(), expected.at(key).dump()) << scene << " on " << ranks;
        }
    }
}

}  // namespace
}  // namespace catena::test
