// Files that a scene names, good and bad.
#include <nlohmann/json.hpp>
#include <sstream>

#include "force/openmm_force.hpp"
#include "structure/calvados2.hpp"
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

TEST_F(SceneFiles, scene_missing_empty_or_a_folder) {
    EXPECT_EQ(refusal_of_file("nowhere.yaml"),
              "no such file: `nowhere.yaml` (nowhere.yaml): check the path");
    fs::create_directories(folder_ / "sub");
    EXPECT_EQ(refusal_of_file("sub"), "a folder, not a file: `sub` (sub): check the path");
    write("empty.yaml", "");
    EXPECT_EQ(refusal_of_file("empty.yaml"),
              "the scene is empty (empty.yaml): describe at least one chain under `chains:`");
}

TEST_F(SceneFiles, table_of_positions) {
    write("start.csv", "# a comment\nx, y, z\n0,0,0\n\n0.4,0,0   # another\n0.4,+3.6e-1,0\r\n");
    BeadArrays const beads = read(with_table_).chains.at(0).beads;
    for (std::size_t k : {1, 2})
        EXPECT_NEAR(norm(beads.position[k] - beads.position[k - 1]), 0.38, 1e-15);
    EXPECT_NEAR(beads.position[0][0], 0.01, 1e-3);  // the link's ends share what it has too much
    EXPECT_NEAR(beads.position[2][1], 0.37, 1e-3);
    std::string const mark = "\xEF\xBB\xBF";  // of the byte order, which spreadsheets write
    write("start.csv", mark + "0,0,0\n0.38,0,0\n0.76,0,0\n");
    EXPECT_EQ(read(with_table_).chains.at(0).beads.position[1][0], 0.38);
}

TEST_F(SceneFiles, bad_tables) {
    std::string const where = " (s.yaml: chains[0].positions, line 1): ";
    write("start.csv", "0,0,0\n1,0,0\n");
    EXPECT_EQ(refusal(with_table_), "`start.csv` contains 2 positions, the chain has 3 beads" +
                                        where + "give one position per bead");
    write("start.csv", "0,0,0\n1,0\n2,0,0\n");
    EXPECT_EQ(refusal(with_table_),
              "the line has 2 columns, not 3 (start.csv: line 2): give x,y,z");
    write("start.csv", "0,0,0\n1,zero,0\n2,0,0\n");
    EXPECT_EQ(refusal(with_table_),
              "`zero` is not a number (start.csv: line 2): give finite decimal numbers");
    write("start.csv", "0,0,0\n1,nan,0\n2,0,0\n");
    EXPECT_EQ(refusal(with_table_),
              "`nan` is not finite (start.csv: line 2): give finite decimal numbers");
    write("start.csv", "0,0,0\n1,0,0,\n2,0,0\n");
    EXPECT_EQ(refusal(with_table_),
              "the line has 4 columns, not 3 (start.csv: line 2): give x,y,z");
    write("start.csv", "0,0,0\n1,0,0\n1,0,0\n");
    EXPECT_EQ(refusal(with_table_),
              "bead 3 coincides with bead 2: their link has no direction (s.yaml: "
              "chains[0].positions, bead 3, line 1): move one of them");
    fs::remove(folder_ / "start.csv");
    EXPECT_EQ(refusal(with_table_), "no such file: `start.csv`" + where + "check the path");
}

TEST_F(SceneFiles, one_record_of_a_fasta_file) {
    write("a.fasta", "\xEF\xBB\xBF>one some words\r\nGA\r\nS*\r\n");
    EXPECT_EQ(read(with_fasta_).chains.at(0).beads.residue,
              (std::vector<std::string>{"GLY", "ALA", "SER"}));
    EXPECT_TRUE(read(with_fasta_).notes.empty());
}

TEST_F(SceneFiles, records_of_a_fasta_file_are_chosen_by_name_or_number) {
    auto const first = [&](std::string const& keys) {
        return read("chains: [{fasta: a.fasta, model: calvados2" + keys + "}]")
            .chains.at(0)
            .beads.residue.at(0);
    };
    std::string const where = " (s.yaml: chains[0].fasta, line 1): ";
    write("a.fasta", ">one\nGA\n>sp|P1|TWO_X words\nWW\n>2\nKK\n>one\nAA\n");
    EXPECT_EQ(first(", record: P1"), "TRP");
    EXPECT_EQ(first(", record: 2"), "LYS");  // a name goes before a number
    EXPECT_EQ(first(", record: 1"), "GLY");
    EXPECT_EQ(first(", name: TWO_X"), "TRP");
    EXPECT_EQ(first(", name: one, record: 4"), "ALA");
    EXPECT_EQ(refusal(with_fasta_),
              "`a.fasta` contains 4 records: `one`, `sp|P1|TWO_X`, `2`, `one`" + where +
                  "name the chain after one of them, or add `record: NAME` or its number");
    EXPECT_EQ(refusal("chains: [{name: one, fasta: a.fasta, model: calvados2}]"),
              "2 records have the name `one` (s.yaml: chains[0].name, line 1): choose one by its "
              "number: `record: 1`");
    EXPECT_EQ(refusal("chains: [{fasta: a.fasta, model: calvados2, record: 5}]"),
              "`a.fasta` has no record `5`: it contains `one`, `sp|P1|TWO_X`, `2`, `one` (s.yaml: "
              "chains[0].record, line 1): give a name, or a number from 1 to 4");
    EXPECT_EQ(refusal("chains: [{sequence: GG, model: calvados2, record: 5}]"),
              "key `record` chooses among the sequences of a `fasta` file (s.yaml: "
              "chains[0].record, line 1): leave it out");
}

TEST_F(SceneFiles, bad_fasta_files) {
    write("a.fasta", "GAS\n");
    EXPECT_EQ(
        refusal(with_fasta_),
        "sequence before the first record (a.fasta: line 1): start the record with a line `>name`");
    write("a.fasta", ">one\n\n");
    EXPECT_EQ(refusal(with_fasta_),
              "no sequence in `a.fasta` (s.yaml: chains[0].fasta, line 1): give a record: `>name`, "
              "then one-letter codes");
    std::string const codes = "use the one-letter codes ARNDCQEGHILKMFPSTWYV";
    auto const refused = [&](std::string const& sequence, std::string const& what,
                             std::string const& remedy) {
        write("a.fasta", ">one\n" + sequence + "\n");
        EXPECT_EQ(refusal(with_fasta_), what + " (s.yaml: chains[0].fasta, line 1): " + remedy);
    };
    refused("GXS", "`X` at position 2 of the sequence is not a residue of calvados2", codes);
    refused(
        "GU",
        "`U` at position 2 of the sequence is not a residue of calvados2: selenocysteine, or RNA",
        "write C for selenocysteine, or `model: calvados_rna` for RNA");
    refused("G*S",
            "`*` at position 2 of the sequence is not a residue of calvados2: a stop within the "
            "sequence",
            "end the sequence there");
    refused(
        "G-S",
        "`-` at position 2 of the sequence is not a residue of calvados2: a gap of an alignment",
        "give the sequence without gaps");
    refused("1 GAS", "`1` at position 1 of the sequence is not a residue of calvados2: a number",
            "leave the numbers of positions out");
    write("a.fasta", std::string(">one\0GAS\n", 9));
    EXPECT_EQ(refusal(with_fasta_),
              "`a.fasta` is not a text file (s.yaml: chains[0].fasta, line 1): give a FASTA file: "
              "`>name`, then one-letter codes");
}

TEST_F(SceneFiles, slips_in_sequences_are_noted) {
    auto const notes = [&](std::string const& sequence) {
        return read("chains: [{sequence: " + sequence + ", model: calvados2}]").notes;
    };
    std::string const threes = "`chains[0].sequence` looks like three-letter codes and is read as ";
    EXPECT_EQ(notes("MET ASP VAL"),
              std::vector<std::string>{
                  threes + "9 one-letter codes (M, E, T, ...): write one letter per residue"});
    EXPECT_EQ(notes("METASPVAL").size(), 1u);
    EXPECT_EQ(notes("met asp val").size(), 2u);
    EXPECT_EQ(notes("MKVF"), std::vector<std::string>{});
    EXPECT_EQ(notes("GSK EEL RKA"), std::vector<std::string>{});
    EXPECT_EQ(notes("MKvf"),
              std::vector<std::string>{
                  "`chains[0].sequence`: 2 of 4 letters are lower case and are read as capitals"});
}

TEST_F(SceneFiles, NucleotidesReadAsAProteinAreNoted) {
    auto const notes = [&](std::string const& sequence) {
        return read("chains: [{sequence: " + sequence + ", model: calvados2}]").notes;
    };
    std::string const way =
        " alone and is read as a protein: RNA takes `model: calvados_rna` and the letter U, DNA "
        "has no model";
    EXPECT_EQ(notes("ACGTACGT"),
              std::vector<std::string>{"`chains[0].sequence` has the letters A, C, G and T" + way});
    EXPECT_EQ(notes("GGCAACGACG"),
              std::vector<std::string>{"`chains[0].sequence` has the letters A, C and G" + way});
    EXPECT_EQ(notes("AAAAAAAA"),
              std::vector<std::string>{"`chains[0].sequence` has the letter A" + way});
    write("a.fasta", ">a\nAAAAAAAAAA\n");
    EXPECT_EQ(read("chains: [{fasta: a.fasta, model: calvados2}]").notes,
              std::vector<std::string>{"`chains[0].fasta` has the letter A" + way});
    EXPECT_EQ(notes("CCCC"),
              std::vector<std::string>{"`chains[0].sequence` has the letter C" + way});
    EXPECT_EQ(notes("gcgc").back(), "`chains[0].sequence` has the letters C and G" + way);
    for (char const* const protein : {"ACG", "AAA", "GSGSGSGS", "ACGTACGK"})
        EXPECT_EQ(notes(protein), std::vector<std::string>{}) << protein;
    write("own.csv",
          "one,three,MW,lambdas,sigmas,q,bondlength\nA,AAA,70,0,0.5,0,0.4\n"
          "C,CCC,70,0,0.5,0,0.4\nG,GGG,70,0,0.5,0,0.4\n");
    EXPECT_EQ(read("chains: [{sequence: GGCAACGACG, model: {residues: own.csv}}]").notes,
              std::vector<std::string>{});
}

class SystemFiles : public SceneFiles {
  protected:
    SystemFiles() {
        write("system.xml", system_of("1"));
        write("topology.pdb", "END\n");
    }
    /// Seven particles without forces.
    static std::string system_of(std::string const& mass) {
        std::string particles;
        for (int i = 0; i < 7; ++i) particles += "<Particle mass=\"" + mass + "\"/>";
        return "<?xml version=\"1.0\" ?>\n<System openmmVersion=\"8.1\" type=\"System\" "
               "version=\"1\"><PeriodicBoxVectors><A x=\"2\" "
               "y=\"0\" z=\"0\"/>"
               "<B x=\"0\" y=\"2\" z=\"0\"/><C x=\"0\" y=\"0\" "
               "z=\"2\"/></PeriodicBoxVectors><Particles>" +
               particles + "</Particles><Constraints/><Forces/></System>\n";
    }
    std::string scene(std::string const& openmm) const {
        return "chains: [{name: a, sequence: GAS, model: calvados2}]\nforces: {openmm: {system: "
               "system.xml, " +
               openmm + "}}";
    }
};

TEST_F(SystemFiles, paths_are_relative_to_the_scene) {
    if (openmm_version() == "none") GTEST_SKIP() << "built without OpenMM";
    Scene const s = read(scene("topology: topology.pdb"));
    EXPECT_EQ(s.forces.openmm->system, (folder_ / "system.xml").string());
    EXPECT_EQ(s.forces.openmm->topology, (folder_ / "topology.pdb").string());
    EXPECT_TRUE(s.forces.openmm->builder.empty());
}

TEST_F(SystemFiles, map_of_chains) {
    if (openmm_version() == "none") GTEST_SKIP() << "built without OpenMM";
    auto const map = read(scene("map: {a: [4, 6]}")).forces.openmm->map;
    ASSERT_EQ(map.size(), 1u);
    EXPECT_EQ(map[0].first, "a");
    EXPECT_EQ(map[0].second, (std::pair<std::int64_t, std::int64_t>{4, 6}));
    EXPECT_EQ(refusal(scene("map: {b: [0, 2]}")),
              "no chain is named `b` (s.yaml: forces.openmm.map.b, line 2): use the chains' names");
    EXPECT_EQ(refusal(scene("map: {a: [0, 3]}")),
              "4 particles for the 3 beads of chain `a` (s.yaml: forces.openmm.map.a, line 2): "
              "give [first, last], both included");
    EXPECT_EQ(refusal(scene("map: {a: [3, 0]}")),
              "the last particle 0 comes before the first 3 (s.yaml: forces.openmm.map.a, line 2): "
              "give [first, last] with particles "
              "counted from 0");
    EXPECT_EQ(refusal(scene("map: {a: 3}")),
              "`3` is not a pair of particles (s.yaml: forces.openmm.map.a, line 2): give [first, "
              "last] with particles counted from 0");
    EXPECT_EQ(refusal(scene("map: {a: [-1, 1]}")),
              "a -1 is below 0 (s.yaml: forces.openmm.map.a[0], line 2): give 0 or more");
}

TEST_F(SystemFiles, what_a_system_says_itself) {
    EXPECT_EQ(refusal(scene("ionic_strength: 0.1, topology: topology.pdb")),
              "key `ionic_strength` does not apply to a serialised System (s.yaml: "
              "forces.openmm.ionic_strength, line 2): leave it out: the System defines it");
    EXPECT_EQ(refusal(scene("threads: 1")),
              "the particles are not assigned to chains (s.yaml: forces.openmm, line 2): add "
              "`topology: topology.pdb`, or `map: {chain: [first, last]}` with particles counted "
              "from 0");
    EXPECT_EQ(refusal("forces: {openmm: {system: system.xml, map: {a: [0, 2]}}}"),
              "the scene has no `chains` and the system has no topology (s.yaml: forces.openmm, "
              "line 1): add `topology: topology.pdb`, or `chains`");
}

/// A scene without chains takes them from the System and its topology.
TEST_F(SystemFiles, chains_of_the_topology) {
    if (openmm_version() == "none") GTEST_SKIP() << "built without OpenMM";
    nlohmann::json reference;
    std::ifstream(CATENA_TEST_DATA "/reference/calvados2-asyn-coil.json") >> reference;
    std::string pdb;
    std::string const letters = reference["sequence"];
    for (std::size_t k = 0; k < letters.size(); ++k) {
        auto const& p = reference["positions"][k];
        pdb += atom(static_cast<int>(k) + 1, "CA", find_calvados2(letters[k])->name, 'A',
                    static_cast<int>(k) + 1, 10 * p[0].get<double>(), ' ', 10 * p[1].get<double>(),
                    10 * p[2].get<double>());
    }
    write("topology.pdb", pdb + "END\n");
    Scene const s = read("forces: {openmm: {system: " CATENA_TEST_DATA
                         "/reference/calvados2-asyn-system.xml, topology: topology.pdb}}");
    ASSERT_EQ(s.chains.size(), 1u);
    BeadArrays const& beads = s.chains[0].beads;
    ASSERT_EQ(beads.size(), 140u);
    EXPECT_EQ(beads.residue[0], "MET");
    EXPECT_NEAR(beads.mass[139], 71.07 + 16, 1e-12);
    for (std::size_t k = 1; k < beads.size(); ++k)
        EXPECT_NEAR(norm(beads.position[k] - beads.position[k - 1]), 0.38, 1e-14);
    EXPECT_FALSE(s.box.has_value());
}

TEST_F(SystemFiles, content_decides_the_hash) {
    if (openmm_version() == "none") GTEST_SKIP() << "built without OpenMM";
    std::string const before = read(scene("topology: topology.pdb")).hash;
    EXPECT_EQ(read(scene("topology: topology.pdb, platform: Reference, threads: 2")).hash, before);
    write("copy.pdb", "END\n");
    EXPECT_EQ(read(scene("topology: copy.pdb")).hash, before);
    write("system.xml", system_of("2"));
    EXPECT_NE(read(scene("topology: topology.pdb")).hash, before);
}

}  // namespace
}  // namespace catena::test
