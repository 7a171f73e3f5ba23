#include <sched.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

TEST(OpenMm, CheckAndPlanDescribeIt) {
    for (std::string const command : {"check", "plan"}) {
        Ended const e = catena({command, input("alpha-synuclein.yaml")});
        expect_good(e);
        EXPECT_NE(e.out.find("139 links replace the model's harmonic bonds"), std::string::npos)
            << e.out;
        EXPECT_EQ(e.out.find("not loaded"), std::string::npos)  // no GPU, and none asked for
            << e.out;
    }
}

TEST(OpenMm, SolveGivesForcesAndAccelerationsThatBelongTogether) {
    Ended const e =
        catena({"solve", input("several-chains.yaml"), "--set", "forces.openmm.platform=Reference",
                "--set", "forces.gravity=[0, 0, -3]", "--repeat", "1", "--json", "-"});
    expect_good(e);
    Json const json = e.json();
    EXPECT_EQ(json["bead_forces"].size(), 118U);
    EXPECT_TRUE(json["potential_energy"].contains("yukawa"));
    EXPECT_LT(json["rnea_residual"].get<double>(), 1e-12);  // by the oracle, with these very forces
    double sum[3] = {}, largest = 0;
    for (Json const& force : json["bead_forces"])
        for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += force[i].get<double>();
            largest = std::max(largest, std::abs(force[i].get<double>()));
        }
    EXPECT_GT(largest, 1);
    for (double const s : sum)
        EXPECT_NEAR(s, 0, 1e-12 * largest);  // forces between pairs, and gravity is not among them
}

TEST(OpenMm, AMissingPlatformIsRefused) {
    expect_refused(
        catena({"solve", input("alpha-synuclein.yaml"), "--set", "forces.openmm.platform=Quantum"}),
        2, "Quantum");
}

TEST(OpenMm, APathOnAGpuIsRefusedWhereThereIsNone) {
    expect_refused(
        catena({"check", input("alpha-synuclein.yaml"), "--set", "forces.openmm.path=device"}), 2,
        "positions and forces cannot stay on a GPU: the backend is not cuda");
    expect_refused(
        catena({"check", input("alpha-synuclein.yaml"), "--set", "forces.openmm.path=remote"}), 2,
        "device");
}

TEST(OpenMm, TheRunSaysItsPathAndWhatWasHidden) {
    TemporaryFolder const folder;
    for (std::string const path : {"host", "inline"}) {
        // Of one chain the sweep may be over before the worker is awake.
        Ended const e = catena({"run", input("alpha-synuclein.yaml"), "--set", "chains[0].count=20",
                                "--steps", "20", "--set", "forces.openmm.path=" + path, "--output",
                                folder / path, "--json", folder / (path + ".json")});
        EXPECT_EQ(e.status, 0) << e.err;
        EXPECT_NE(e.out.find("platform CPU, path " + path), std::string::npos) << e.out;
        EXPECT_NE(e.out.find("matrix sweep hidden"), std::string::npos) << e.out;
    }
    auto const hidden = [&](std::string const& path) {
        return Json::parse(std::ifstream(folder / (path + ".json")))
            .at("forces")
            .at("matrix_sweep_hidden")
            .get<double>();
    };
    EXPECT_GT(hidden("host"), 0);
    EXPECT_LE(hidden("host"), 1);
    EXPECT_EQ(hidden("inline"), 0);
    expect_good(catena({"run", input("alpha-synuclein.yaml"), "--steps", "20", "--set",
                        "forces.openmm.path=host", "--set", "forces.openmm.overlap=false",
                        "--output", folder / "off", "--json", folder / "off.json", "--quiet"}));
    EXPECT_EQ(hidden("off"), 0);
}

TEST(OpenMm, OnOneCoreNothingIsHidden) {
    cpu_set_t all, one;
    ASSERT_EQ(sched_getaffinity(0, sizeof(all), &all), 0);
    CPU_ZERO(&one);
    for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
        if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
    ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);  // what is started inherits it
    Ended const e = catena({"bench", "overlap", "--sizes", "140", "--backend", "segments",
                            "--repeat", "2", "--json", "-"});
    ASSERT_EQ(sched_setaffinity(0, sizeof(all), &all), 0);
    EXPECT_EQ(e.status, 0) << e.err;
    EXPECT_EQ(e.json().at("results").at(0).at("matrix_sweep_hidden"), 0);
}

TEST(OpenMm, BenchmarksSayWhatTheyCompare) {
    Ended const e = catena({"bench", "openmm", "--sizes", "140", "--backend", "segments",
                            "--repeat", "2", "--json", "-"});
    expect_good(e);
    Json const row = e.json().at("results").at(0);
    EXPECT_EQ(row.at("beads"), 140);
    EXPECT_EQ(row.at("valid"), true);
    for (char const* const of : {"catena", "openmm_harmonic", "openmm_constrained"})
        EXPECT_GT(row.at(of).at("seconds_per_step").at("median").get<double>(), 0) << of;
    EXPECT_LT(row.at("openmm_constrained").at("link_error").get<double>(),
              2e-5);  // OpenMM's own tolerance is 1e-5
    EXPECT_GT(row.at("openmm_harmonic").at("link_error").get<double>(), 1e-4);
    TemporaryFolder const folder;
    Ended const overlap = catena({"bench", "overlap", "--sizes", "140", "--backend", "segments",
                                  "--repeat", "2", "--output", folder / "pictures", "--json", "-"});
    expect_good(overlap);
    Json const found = overlap.json().at("results").at(0);
    double const sweep = found.at("matrix_sweep_seconds_per_step");
    EXPECT_GT(sweep, 0);
    for (char const* const of : {"overlap_off", "overlap_on"})
        EXPECT_GT(found.at("seconds_per_step").at(of).at("median").get<double>(), sweep) << of;
    EXPECT_GT(std::filesystem::file_size(folder / "pictures/overlap.html"), 1000U);
    std::ofstream(folder / "file") << "no folder\n";
    expect_refused(catena({"bench", "overlap", "--output", folder / "file/pictures"}), 2,
                   "the output folder cannot be created");
}

}  // namespace
}  // namespace catena::test
