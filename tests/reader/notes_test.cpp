// Notes on steps, friction and starts that may not mean what they say.
#include <fmt/format.h>

#include "reader/force_notes.hpp"
#include "reader/load_scene.hpp"
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

/// Chains, a step in ps, and what else the scene has.
std::string residues(std::string const& chains, std::string const& step,
                     std::string const& more = "") {
    return "chains: [" + chains +
           "]\nforces: {openmm: {builder: calvados2, ionic_strength: 0.15}}\ndynamics: "
           "{integrator: g-baoab, step: " +
           step + ", temperature: 300}\n" + more;
}

std::string const peptide = "{sequence: GASGASGAS, model: calvados2}",
                  two = "{sequence: GAS, model: calvados2, count: 2}",
                  rna = "{sequence: GCUUACG, model: calvados_rna}",
                  box = "box: {periodic: [9, 9, 9]}";

/// All notes that begin with `first`, one after the other.
std::string notes(std::string const& yaml, std::string const& first) {
    std::string told;
    for (std::string const& note : parse_scene(yaml, "s.yaml").notes)
        if (note.starts_with(first)) told += note;
    return told;
}
std::string of_step(std::string const& yaml) { return notes(yaml, "dynamics.step"); }
std::string longer(std::string const& yaml) {
    return scene::longer_steps(parse_scene(yaml, "s.yaml"));
}

TEST(StepNotes, OfSingleChainsAndOfBoxes) {
    EXPECT_EQ(longer(residues(peptide, "0.01")),
              "up to 0.06 ps sample chains of beads within 1 % of shorter ones");
    EXPECT_EQ(longer(residues(two, "0.01", box)),
              "up to 0.04 ps no bias of condensates and slabs was found, within errors of 1 %");
    EXPECT_EQ(longer(residues(two, "0.04", box)), "");
    EXPECT_EQ(of_step(residues(two, "0.04", box)), "");
    EXPECT_EQ(
        of_step(residues(two, "0.05", box)),
        "dynamics.step is 50 fs: no bias of condensates and slabs was found up to 40 fs, within "
        "errors of 1 %, longer steps are not advised.");
    EXPECT_EQ(of_step(residues(peptide, "0.05")), "");
    // Chains without a box may meet, replicas of one chain do not.
    EXPECT_EQ(longer(residues(two, "0.01")),
              "up to 0.04 ps no bias of chains that may meet was found, within errors of 1 %");
    EXPECT_EQ(of_step(residues(peptide, "0.05", "replicas: 3")), "");
}

TEST(StepNotes, OfRnaPromiseNothing) {
    EXPECT_EQ(longer(residues(rna, "0.005")), "");
    EXPECT_EQ(of_step(residues(rna, "0.01")), "");
    EXPECT_EQ(of_step(residues(rna, "0.02")),
              "dynamics.step is 20 fs: RNA was simulated with steps up to 10 fs, longer ones were "
              "not compared.");
}

TEST(StepNotes, AskWhetherSecondsAreMeant) {
    EXPECT_EQ(of_step(residues(peptide, "1e-14")),
              "dynamics.step is 1e-14 ps: steps of such chains are 0.01 to 0.06 ps. Did you mean "
              "0.01?");
    EXPECT_EQ(of_step(residues(peptide, "1e-300")),
              "dynamics.step is 1e-300 ps: steps of such chains are 0.01 to 0.06 ps.");
    EXPECT_EQ(of_step(residues(peptide, "1e-6")), "");
}

TEST_F(SceneFiles, steps_of_light_beads_and_rigid_domains_are_shorter) {
    write("light.csv", "one,three,MW,lambdas,sigmas,q,bondlength\nX,LIG,14.2625,0,0.5,0,0.38\n");
    auto const light = [&](std::string const& step) {
        return read(
            residues("{sequence: XXXX, model: {residues: light.csv}, charge_termini: none}", step));
    };
    EXPECT_EQ(scene::longer_steps(light("0.01")), "");
    EXPECT_TRUE(notes_of(light("0.03")).empty());
    EXPECT_EQ(notes_of(light("0.05")).at(0),
              "dynamics.step is 50 fs: steps up to 60 fs were shown for residues, which are 30 fs "
              "for beads of 14.26 amu on links of 0.38 nm.");
    std::string atoms;
    for (int i = 1; i <= 8; ++i)
        atoms += fmt::format("ATOM  {0:5}  CA  ALA A{0:4}    {1:8.3f}{2:8.3f}{3:8.3f}\n", i,
                             3.2 * i, i % 2 * 2.05, 0.0);
    write("a.pdb", atoms);
    auto const domain = [&](std::string const& step) {
        return read(residues("{pdb: a.pdb, model: calvados2, rigid: [[1, 5]]}", step));
    };
    EXPECT_EQ(scene::longer_steps(domain("0.01")),
              "up to 0.02 ps no bias of rigid domains was found, within errors of 1 %");
    EXPECT_EQ(
        notes_of(domain("0.03")).at(0),
        "dynamics.step is 30 fs: no bias of rigid domains was found up to 20 fs, within errors "
        "of 1 %, longer steps are not advised.");
}

TEST(FrictionNotes, AskWhetherADampingTimeIsMeant) {
    auto const of = [](std::string const& friction, std::string const& units) {
        return notes(
            "units: " + units +
                "\nchains: [{generator: {freely_jointed: {beads: 3, length: 1}}}]\n"
                "dynamics: {integrator: g-baoab, step: 0.01, temperature: 300, friction: " +
                friction + "}",
            "dynamics.friction");
    };
    EXPECT_EQ(of("100", "md"),
              "dynamics.friction is a rate, 100/ps: velocities are forgotten within a step. If 100 "
              "ps is a damping time, write 0.01.");
    EXPECT_EQ(of("99", "md"), "");
    EXPECT_EQ(of("100", "si"), "");
}

TEST(WormLike, ARunKeepsNoPersistenceLength) {
    std::string const chain =
        "chains: [{generator: {worm_like: {bodies: 9, length: 1, persistence: 50}}}]\n";
    EXPECT_EQ(notes(chain + "dynamics: {integrator: g-baoab, step: 0.01}", "generator"),
              "generator `worm_like` gives the start alone: no force keeps the persistence length "
              "of 50 in a run, and the chain becomes a random walk. Take `elastic_rod`, or angle "
              "forces of an OpenMM System.");
    EXPECT_EQ(notes(chain, "generator"), "");
}

TEST(Syntax, TabsMergeKeysAndHdf5FilesAreNamed) {
    EXPECT_EQ(refusal_of("chains:\n\t- {sequence: GAS, model: calvados2}\n"),
              "not YAML: illegal block entry (s.yaml: line 2): indent with blanks instead of tabs");
    EXPECT_EQ(refusal_of("chains:\n  - &a {sequence: GAS, model: calvados2}\n  - <<: *a\n"),
              "merge keys `<<` are not read (s.yaml: chains[1].<<, line 3): write the keys out; an "
              "alias is a whole value");
    EXPECT_EQ(refusal_of("\x89HDF\r\n\x1a\n"),
              "an HDF5 file, not a scene (s.yaml): name a scene; catena run SCENE --restart "
              "FOLDER/checkpoint.h5 continues a run");
}

}  // namespace
}  // namespace catena::test
