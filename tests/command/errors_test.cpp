// One line on standard error and the right status for each class of mistake.
#include <filesystem>
#include <fstream>

#include "cuda/device/gpu.hpp"
#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

TEST(Errors, TheCommandLine) {
    expect_refused(catena({}), 2, "no command is named");
    expect_refused(catena({"slove", "x.yaml"}), 2, "did you mean `solve`?");
    expect_refused(catena({"solve", input("arm.yaml"), "--bakend", "serial"}), 2,
                   "did you mean `--backend`?");
    expect_refused(catena({"plan", input("arm.yaml"), "--ranks", "4"}), 2,
                   "--ranks without --network");
    expect_refused(catena({"bench", "sweeps"}), 2, "not in this version: catena bench sweeps");
    expect_refused(catena({"bench", "peers", "--joints", "helical"}), 2,
                   "use link, spherical, revolute or planar");
    expect_refused(catena({"bench", "peers", "--sizes", "2e6"}), 2, "use at most 1e6");
    expect_refused(catena({"bench", "solve", "--figure", "2.5"}), 2,
                   "catena bench solve does not take --figure");
    expect_refused(catena({"bench", "openmm", "--joints", "link"}), 2,
                   "catena bench openmm does not take --joints");
    expect_refused(catena({"bench", "network", "--loads", "none"}), 2,
                   "catena bench network does not take --loads");
    expect_refused(catena({"run", input("arm.yaml"), "--output", ""}), 2, "--output is empty");
    expect_refused(catena({"run", input("arm.yaml"), "--steps", "1e30"}), 2,
                   "1e30 is above 9000000000000000");
}

TEST(Errors, AGpuThatIsNotThere) {
    if (cuda::why_not().empty()) GTEST_SKIP() << "NOT RUN: this machine has a GPU";
    for (char const* const command : {"check", "plan", "solve"})
        for (std::string const backend : {"cuda", "cuda-levels"})
            expect_refused(catena({command, input("arm.yaml"), "--backend", backend}), 2,
                           cuda::why_not() + " (solver.backend: " + backend + ")");
}

/// On one rank and without a GPU too, where they change nothing.
TEST(Errors, TheEnvironment) {
    Words const check = {program(), "check", input("arm.yaml")};
    expect_refused(run_program(check, "", {"CATENA_GATHER=two-stages"}), 2,
                   "`two-stages` is not a way to gather (CATENA_GATHER)");
    expect_refused(run_program(check, "", {"CATENA_GPU_EXCHANGE=hots"}), 2,
                   "`hots` is not a way for GPUs to exchange numbers (CATENA_GPU_EXCHANGE): use "
                   "auto, direct or host");
    expect_good(run_program({program(), "--version"}, "", {"CATENA_GPU_EXCHANGE=hots"}));
    expect_good(run_program(check, "", {"CATENA_GATHER=two-stage:2", "CATENA_GPU_EXCHANGE=host"}));
}

TEST(Errors, TheScene) {
    expect_refused(catena({"check", "missing.yaml"}), 2, "missing.yaml");
    expect_refused(catena({"check", "."}), 2, "(.)");
    expect_refused(catena({"check", input("arm.yaml"), "--set", "chains[0].bass=fixed"}), 2,
                   "did you mean `base`?");
    expect_refused(catena({"check", input("arm.yaml"), "--set", "chains[0].bodies[1].mass=-1"}), 2,
                   "body 2");
    expect_refused(catena({"check", input("arm.yaml"), "--set", "nonsense"}), 2, "--set nonsense");
    expect_refused(catena({"run", input("random-link.yaml")}), 2, "no dynamics section");
    TemporaryFolder const folder;
    std::ofstream(folder / "bad.yaml") << "chains: [{name: a\n";
    expect_refused(catena({"check", folder / "bad.yaml"}), 2, "bad.yaml");
}

TEST(Errors, FilesThatCannotBe) {
    expect_refused(catena({"check", input("arm.yaml"), "--json", "/no/such/folder/x.json"}), 2,
                   "no such folder: /no/such/folder (--json");
    expect_refused(catena({"check", input("arm.yaml"), "--json", "/"}), 2, "--json /");
    expect_refused(catena({"report", input("arm.yaml"), "--output", "/dev/null/x"}), 2,
                   "--output /dev/null/x");
}

/// What was there stays: the scene, another output, a run's page.
TEST(Errors, NothingIsWrittenOverBesides) {
    TemporaryFolder const folder;
    std::string const scene = folder / "arm.yaml";
    std::filesystem::copy_file(input("arm.yaml"), scene);
    auto const size = std::filesystem::file_size(scene);
    expect_refused(catena({"check", scene, "--json", folder / "./arm.yaml"}), 2,
                   "the scene would be overwritten");
    expect_refused(catena({"solve", scene, "--accelerations", scene}), 2,
                   "the scene would be overwritten");
    expect_refused(
        catena({"solve", scene, "--json", folder / "a", "--accelerations", folder / "a"}), 2,
        "name the same file");
    std::ofstream(folder / "observables.csv") << "step\n";
    expect_refused(catena({"report", scene, "--quick", "--output", folder.path()}), 2,
                   "the folder contains a run");
    EXPECT_EQ(std::filesystem::file_size(scene), size);
    EXPECT_FALSE(std::filesystem::exists(folder / "report.html"));
}

TEST(Errors, AFullDiskIsAFailedComputation) {
    expect_refused(catena({"check", input("arm.yaml"), "--quiet", "--json", "/dev/full"}), 1,
                   "/dev/full");
    expect_refused(
        run_program({"sh", "-c", program() + " check " + input("arm.yaml") + " > /dev/full"}), 1,
        "cannot write to standard output");
}

TEST(Errors, AComputationThatFailsIsStatusOne) {
    TemporaryFolder const folder;
    Ended const e = catena({"run", input("spherical-chain.yaml"), "--set", "dynamics.step=50",
                            "--steps", "2", "--quiet"},
                           folder.path());
    expect_refused(e, 1, "dynamics.step");
}

}  // namespace
}  // namespace catena::test
