#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/command/program.hpp"
#include "tests/io/temporary_folder.hpp"

namespace catena::test {
namespace {

using Json = nlohmann::json;

/// Ten residues under a friction that lets them forget within a picosecond.
std::string write_scene(TemporaryFolder const& folder) {
    std::string const file = folder / "ten.yaml";
    std::ofstream(file)
        << "title: ten residues\n"
           "chains: [{name: ten, sequence: MDVFMKGLSK, model: calvados2, conformation: "
           "self_avoiding, velocities: thermal}]\n"
           "forces: {openmm: {builder: calvados2, platform: Reference, path: inline}}\n"
           "dynamics: {integrator: g-baoab, step: 0.01, temperature: 300, friction: 1}\n";
    return file;
}

Words sampling(std::string const& scene, Words const& more) {
    Words words{"bench", "sampling", scene, "--backend", "segments", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

TEST(Sampling, AlphaSynucleinIsSampledByEveryMethod) {
    TemporaryFolder const folder;
    std::string const file = folder / "sampling.json";
    Ended const e = catena({"bench", "sampling", "--copies", "2", "--duration", "2", "--discard",
                            "0.5", "--backend", "segments", "--methods",
                            "rigid,rigid-fixman,bonds,constraints", "--json", file});
    EXPECT_EQ(e.status, 0) << e.err;
    for (char const* const part : {"2 copies of asyn (140 beads)",
                                   "rigid (10 fs) minus bonds (10 fs): Rg ", "  reference  "})
        EXPECT_NE(e.out.find(part), std::string::npos) << part << e.out;
    EXPECT_NE(e.err.find("steps/s"), std::string::npos);
    Json const json = Json::parse(std::ifstream(file));
    ASSERT_EQ(json.at("results").size(), 4U);
    for (Json const& row : json.at("results")) {
        EXPECT_EQ(row.at("state"), "VALID") << row;
        EXPECT_EQ(row.at("samples_per_copy"), 2);
        EXPECT_NEAR(row.at("total_ns").get<double>(), 0.004, 1e-12);
        EXPECT_GT(row.at("radius_of_gyration").at("mean").get<double>(), 1.5);
        EXPECT_LT(row.at("radius_of_gyration").at("mean").get<double>(), 6);
        EXPECT_GT(row.at("ns_per_day").get<double>(), 0);
        EXPECT_GT(row.at("copies_apart_nm").get<double>(), 4);
    }
    EXPECT_LT(json.at("results")[0].at("largest_link_error").get<double>(), 1e-10);
    EXPECT_GT(json.at("results")[2].at("largest_link_error").get<double>(), 0.01);
    EXPECT_LT(json.at("results")[3].at("largest_link_error").get<double>(), 2e-5);
    EXPECT_EQ(json.at("differences").size(), 4U);
    EXPECT_TRUE(json.at("hardware").contains("processor"));
}

// Copies that never meet have no box, and therefore no places in it.
TEST(Sampling, PlacesOfASceneAndOfItsChainAreLeftOut) {
    TemporaryFolder const folder;
    for (std::string const place : {"place", "chains[0].place"}) {
        Ended const e = catena(
            sampling(write_scene(folder),
                     {"--set", "box.periodic=[12, 12, 30]", "--set", place + ".slab.thickness=10",
                      "--copies", "2", "--duration", "1", "--discard", "0", "--equilibrate", "0",
                      "--methods", "rigid", "--json", folder / "s.json"}));
        EXPECT_EQ(e.status, 0) << place << e.err;
        EXPECT_EQ(Json::parse(std::ifstream(folder / "s.json")).at("results").size(), 1U) << place;
    }
}

TEST(Sampling, NotesOnTheSceneAreShown) {
    TemporaryFolder const folder;
    Ended const e = catena(sampling(
        write_scene(folder),
        {"--set", "dynamics.temperature=260", "--copies", "2", "--duration", "1", "--discard", "0",
         "--equilibrate", "0", "--methods", "rigid", "--json", folder / "s.json"}));
    EXPECT_EQ(e.status, 0) << e.err;
    std::string const notes = Json::parse(std::ifstream(folder / "s.json")).at("notes").dump();
    EXPECT_NE(notes.find("water is frozen at 260 K"), std::string::npos) << notes;
}

TEST(Sampling, TheTemperaturesAreTheThermostats) {
    TemporaryFolder const folder;
    Ended const e =
        catena(sampling(write_scene(folder), {"--copies", "12", "--duration", "60", "--discard",
                                              "4", "--every", "0.2", "--steps", "0.02", "--methods",
                                              "rigid,rigid-fixman,bonds", "--json", "-"}));
    expect_good(e);
    Json const json = e.json();
    for (Json const& row : json.at("results"))
        for (char const* const kind : {"configurational_temperature", "kinetic_temperature"}) {
            // Five standard deviations of what other seeds give: any seed, and other processors
            // have other trajectories, keeps to them.
            double const largest = std::string(kind) == "kinetic_temperature" ? 25 : 65;
            EXPECT_LT(std::abs(row.at(kind).at("mean").get<double>() - 300), largest)
                << row.at("method") << kind;
            double const error = row.at(kind).at("error");
            EXPECT_GT(error, largest / 25) << row.at("method") << kind;
            EXPECT_LT(error, largest / 2) << row.at("method") << kind;
        }
}

TEST(Sampling, AStepThatIsTooLongIsAFindingNoFailure) {
    TemporaryFolder const folder;
    Ended const e = catena(sampling(
        write_scene(folder), {"--copies", "2", "--duration", "20", "--discard", "0", "--methods",
                              "rigid,bonds,constraints", "--steps", "0.5,0.01", "--json", "-"}));
    expect_good(e);
    Json const json = e.json();
    ASSERT_EQ(json.at("results").size(), 6U);
    for (std::size_t i = 0; i < 6; ++i) {
        Json const& row = json.at("results")[i];
        EXPECT_EQ(row.at("state"), i < 3 ? "unstable" : "VALID") << row;
        EXPECT_EQ(row.at("why").get<std::string>().empty(), i >= 3) << row;
    }
    for (Json const& verdict : json.at("verdicts"))
        EXPECT_EQ(verdict.at("biases")[1].at("usable"), "unstable");
}

TEST(Sampling, ARowEndsWithItsSeconds) {
    TemporaryFolder const folder;
    std::string const scene = write_scene(folder);
    auto const run = [&scene](std::string const& discard) {
        return catena(sampling(
            scene, {"--copies", "2", "--duration", "1e6", "--discard", discard, "--equilibrate",
                    "0", "--seconds", "0.5", "--methods", "bonds", "--json", "-"}));
    };
    Ended const e = run("0");
    expect_good(e);
    Json const row = e.json().at("results")[0];
    EXPECT_EQ(row.at("state"), "VALID");
    EXPECT_EQ(row.at("cut_by_seconds"), true);
    EXPECT_GT(row.at("samples_per_copy"), 0);
    EXPECT_LT(row.at("ps_per_copy").get<double>(), 1e5);
    Ended const none = run("1e6");  // a method without samples is no result
    EXPECT_EQ(none.status, 1);
    EXPECT_EQ(none.json().at("results")[0].at("state"), "too short");
}

TEST(Sampling, DenseChainsAreSampledInTheirBox) {
    TemporaryFolder const folder;
    std::string const file = folder / "dense.yaml";
    std::ofstream(file)
        << "title: a small slab\n"
           "chains: [{name: ten, count: 12, sequence: MDVFMKGLSK, model: calvados2, "
           "conformation: self_avoiding}]\n"
           "box: {periodic: [8.2, 8.2, 20]}\n"
           "place: {slab: {axis: z, thickness: 6}}\n"
           "forces: {openmm: {builder: calvados2, platform: CPU}}\n"
           "dynamics: {integrator: g-baoab, step: 0.01, temperature: 300, "
           "friction: 1}\n";
    Ended const e = catena(sampling(
        file, {"--dense", "--duration", "8", "--discard", "1", "--equilibrate", "1", "--every",
               "0.5", "--steps", "0.01,0.02", "--methods", "rigid,bonds", "--json", "-"}));
    expect_good(e);
    Json const json = e.json();
    EXPECT_EQ(json.at("dense"), true);
    ASSERT_EQ(json.at("results").size(), 4U);
    for (Json const& row : json.at("results")) {
        EXPECT_EQ(row.at("state"), "VALID") << row;
        EXPECT_NEAR(row.at("total_ns").get<double>(), 0.008, 1e-9);
        Json const& system = row.at("system");
        for (char const* const name : {"ashbaugh-hatch energy", "yukawa energy",
                                       "pairs within 0.5 nm", "pairs within 0.8 nm"})
            EXPECT_TRUE(system.at(name).at("mean").is_number()) << name;
        // 120 residues of 9.5 kDa in 6 of 20 nm: more than the mean over the box, less than all in
        // a nanometre.
        double const density = system.at("density seen").at("mean");
        EXPECT_GT(density, 1.66 * 13e3 / (8.2 * 8.2 * 20));
        EXPECT_LT(density, 1.66 * 14e3 / (8.2 * 8.2));
        EXPECT_GT(row.at("diffusion_of_chains").at("mean").get<double>(), 0);
    }
    EXPECT_EQ(json.at("verdicts")[0].at("biases")[1].at("density seen").size(), 3U);
}

TEST(Sampling, WhatCannotBeSampledIsRefused) {
    expect_refused(
        catena({"bench", "sampling", input("condensate.yaml"), "--dense", "--copies", "2"}), 2,
        "--dense takes all chains of SCENE (--copies)");
    expect_refused(catena({"bench", "sampling", input("alpha-synuclein.yaml"), "--dense", "--set",
                           "box=none"}),
                   2, "takes a scene with a periodic box");
    expect_refused(catena({"bench", "openmm", "--dense"}), 2, "does not take --dense");
    expect_refused(catena({"bench", "sampling", "--methods", "rigid,bond"}), 2,
                   "did you mean `bonds`?");
    expect_refused(catena({"bench", "sampling", "--steps", "0.01,fast"}), 2,
                   "`fast` is not a number (--steps)");
    expect_refused(catena({"bench", "sampling", "--steps", "0.01,20"}), 2,
                   "20 ps is 20000 fs (--steps): give time steps in ps, such as 0.01");
    expect_refused(catena({"bench", "sampling", "--copies", "0"}), 2, "--copies");
    expect_refused(catena({"bench", "sampling", "--duration", "1", "--every", "50"}), 2,
                   "50 ps between samples are more than the 1 ps");
    expect_refused(catena({"bench", "sampling", "--every", "0.001"}), 2,
                   "are 0.1 steps of 0.01 ps (--every)");
    expect_refused(catena({"bench", "sampling", "--every", "4e7", "--duration", "4e7"}), 2,
                   "--every");
    expect_refused(catena({"bench", "sampling", "--sizes", "140"}), 2,
                   "catena bench sampling does not take --sizes");
    expect_refused(catena({"bench", "openmm", "--copies", "2"}), 2,
                   "catena bench openmm does not take --copies");
    expect_refused(catena({"bench", "openmm", "scene.yaml"}), 2,
                   "catena bench openmm does not take `scene.yaml`");
    expect_refused(catena({"bench", "sampling", input("several-chains.yaml")}), 2,
                   "leave the others out");
    expect_refused(catena({"bench", "sampling", input("several-chains.yaml"), "--set",
                           "place={slab: {axis: z, thickness: 9}}"}),
                   2, "leave the others out");
    expect_refused(catena({"bench", "sampling", input("arm.yaml")}), 2, "takes a free chain");
    std::string const scene = input("alpha-synuclein.yaml");
    expect_refused(catena({"bench", "sampling", scene, "--set", "forces.gravity=[0, 0, -1]"}), 2,
                   "gravity");
    expect_refused(catena({"bench", "sampling", scene, "--json", scene}), 2,
                   "the scene would be overwritten");
}

}  // namespace
}  // namespace catena::test
