// Files that a scene names, good and bad.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "force/calvados2.hpp"
#include "force/openmm_force.hpp"
#include "tests/scene/refusal.hpp"

namespace catena::test {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, removed at the end. Messages are compared with its path cut out.
class SceneFiles : public testing::Test {
  protected:
    SceneFiles()
        : folder_(fs::temp_directory_path() /
                  (std::string("catena-scene-") + testing::UnitTest::GetInstance()->current_test_info()->name() + "-" +
                   std::to_string(::getpid()))) {
        fs::create_directories(folder_);
    }
    ~SceneFiles() override { fs::remove_all(folder_); }

    std::string write(std::string const& name, std::string const& text) const {
        std::ofstream(folder_ / name) << text;
        return (folder_ / name).string();
    }
    Scene read(std::string const& yaml) const { return parse_scene(yaml, (folder_ / "s.yaml").string()); }
    std::string refusal(std::string const& yaml) const { return without_folder(refusal_of(yaml, {}, (folder_ / "s.yaml").string())); }
    std::string refusal_of_file(std::string const& name) const {
        try {
            load_scene((folder_ / name).string());
        } catch (InputError const& error) {
            return without_folder(error.what());
        }
        return "accepted";
    }
    std::string without_folder(std::string message) const {
        std::string const prefix = folder_.string() + "/";
        for (std::size_t at; (at = message.find(prefix)) != std::string::npos;) message.erase(at, prefix.size());
        return message;
    }

    fs::path folder_;
    std::string const with_table_ = "chains: [{sequence: GAS, model: calvados2, positions: start.csv}]";
    std::string const with_fasta_ = "chains: [{fasta: a.fasta, model: calvados2}]";
    std::string const with_pdb_ = "chains: [{pdb: a.pdb, model: calvados2, links: as_given}]";
};

std::string atom(int serial, std::string const& name, std::string const& residue, char chain, int number, double x, char alternate = ' ',
                 double y = 0.5, double z = -0.25) {
    char line[100];
    std::snprintf(line, sizeof line, "ATOM  %5d  %-3s%c%-3s %c%4d    %8.3f%8.3f%8.3f  1.00  0.00\n", serial, name.c_str(), alternate,
                  residue.c_str(), chain, number, x, y, z);
    return line;
}

TEST_F(SceneFiles, scene_missing_empty_or_a_folder) {
    EXPECT_EQ(refusal_of_file("nowhere.yaml"), "no such file: `nowhere.yaml` (nowhere.yaml): check the path");
    fs::create_directories(folder_ / "sub");
    EXPECT_EQ(refusal_of_file("sub"), "a folder, not a file: `sub` (sub): check the path");
    write("empty.yaml", "");
    EXPECT_EQ(refusal_of_file("empty.yaml"), "the scene is empty (empty.yaml): describe at least one chain under `chains:`");
}

TEST_F(SceneFiles, table_of_positions) {
    write("start.csv", "# a comment\nx, y, z\n0,0,0\n\n0.5,0,0   # another\n0.5,+2e-1,0\r\n");
    BeadArrays const beads = read(with_table_).chains.at(0).beads;
    EXPECT_EQ(beads.position[0][0], 0);
    EXPECT_DOUBLE_EQ(beads.position[1][0], 0.38);  // projected
    EXPECT_DOUBLE_EQ(beads.position[2][1], 0.38);
    EXPECT_DOUBLE_EQ(beads.position[2][0], 0.38);
}

TEST_F(SceneFiles, bad_tables) {
    std::string const where = " (s.yaml: chains[0].positions, line 1): ";
    write("start.csv", "0,0,0\n1,0,0\n");
    EXPECT_EQ(refusal(with_table_), "`start.csv` holds 2 positions, the chain has 3 beads" + where + "give one position a bead");
    write("start.csv", "0,0,0\n1,0\n2,0,0\n");
    EXPECT_EQ(refusal(with_table_), "the line has 2 columns, not 3 (start.csv: line 2): give x,y,z");
    write("start.csv", "0,0,0\n1,zero,0\n2,0,0\n");
    EXPECT_EQ(refusal(with_table_), "`zero` is not a number (start.csv: line 2): give finite decimal numbers");
    write("start.csv", "0,0,0\n1,nan,0\n2,0,0\n");
    EXPECT_EQ(refusal(with_table_), "`nan` is not finite (start.csv: line 2): give finite decimal numbers");
    write("start.csv", "0,0,0\n1,0,0,\n2,0,0\n");
    EXPECT_EQ(refusal(with_table_), "the line has 4 columns, not 3 (start.csv: line 2): give x,y,z");
    write("start.csv", "0,0,0\n1,0,0\n1,0,0\n");
    EXPECT_EQ(refusal(with_table_),
              "bead 3 stands on bead 2: their link has no direction (s.yaml: chains[0].positions, bead 3, line 1): move one of them");
    fs::remove(folder_ / "start.csv");
    EXPECT_EQ(refusal(with_table_), "no such file: `start.csv`" + where + "check the path");
}

TEST_F(SceneFiles, first_record_of_a_fasta_file) {
    write("a.fasta", ">one\nGA\nS*\n>two\nWWWW\n");
    BeadArrays const beads = read(with_fasta_).chains.at(0).beads;
    EXPECT_EQ(beads.residue, (std::vector<std::string>{"GLY", "ALA", "SER"}));
}

TEST_F(SceneFiles, bad_fasta_files) {
    write("a.fasta", "GAS\n");
    EXPECT_EQ(refusal(with_fasta_), "sequence before the first record (a.fasta: line 1): start the record with a line `>name`");
    write("a.fasta", ">one\n>two\nGAS\n");
    EXPECT_EQ(refusal(with_fasta_),
              "no sequence in `a.fasta` (s.yaml: chains[0].fasta, line 1): give a record: `>name`, then one-letter codes");
    write("a.fasta", ">one\nGXS\n");
    EXPECT_EQ(refusal(with_fasta_),
              "`X` at position 2 of the sequence is no residue of calvados2 (s.yaml: chains[0].fasta, line 1): use the one-letter codes "
              "ARNDCQEGHILKMFPSTWYV");
}

TEST_F(SceneFiles, alpha_carbons_of_a_pdb_file) {
    write("a.pdb", "HEADER\n" + atom(1, "N", "GLY", 'A', 1, 0) + atom(2, "CA", "GLY", 'A', 1, 1) + atom(3, "CA", "ALA", 'A', 2, 4.8, 'A') +
                       atom(4, "CA", "ALA", 'A', 2, 5.8, 'B') + "ENDMDL\n" + atom(5, "CA", "SER", 'A', 3, 9));
    BeadArrays const beads = read(with_pdb_).chains.at(0).beads;
    EXPECT_EQ(beads.residue, (std::vector<std::string>{"GLY", "ALA"}));
    EXPECT_DOUBLE_EQ(beads.position[0][0], 0.1);
    EXPECT_DOUBLE_EQ(beads.position[0][2], -0.025);
    EXPECT_DOUBLE_EQ(beads.length[1], 0.38);
}

TEST_F(SceneFiles, bad_pdb_files) {
    std::string const where = " (s.yaml: chains[0].pdb, line 1): ";
    write("a.pdb", "HEADER\n");
    EXPECT_EQ(refusal(with_pdb_), "no atoms in `a.pdb`" + where + "give ATOM records");
    write("a.pdb", atom(1, "N", "GLY", 'A', 1, 0) + atom(2, "C", "GLY", 'A', 1, 1));
    EXPECT_EQ(refusal(with_pdb_), "residue A   1 of `a.pdb` has several atoms and none is its only CA" + where + "keep one atom a residue");
    write("a.pdb", atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "GLY", 'B', 1, 1));
    EXPECT_EQ(refusal(with_pdb_), "`a.pdb` holds chains A and B" + where + "keep one chain a file");
    write("a.pdb", atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "HOH", 'A', 2, 1));
    EXPECT_EQ(refusal(with_pdb_),
              "`HOH` is no residue of calvados2 (s.yaml: chains[0].pdb, bead 2, line 1): rename or remove it in the file");
    write("a.pdb", atom(1, "CA", "GLY", 'A', 1, 0).substr(0, 40) + "\n");
    EXPECT_EQ(refusal(with_pdb_), "the atom's line is cut short (a.pdb: line 1): give coordinates in columns 31 to 54");
}

TEST_F(SceneFiles, positions_and_conformation_from_a_pdb_file) {
    write("a.pdb", atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "GLY", 'B', 1, 4));
    for (char const* const key : {"positions: a.pdb", "conformation: {pdb: a.pdb}"}) {
        BeadArrays const beads =
            read(std::string("chains: [{sequence: WW, model: calvados2, links: as_given, ") + key + "}]").chains.at(0).beads;
        EXPECT_DOUBLE_EQ(beads.position[1][0], 0.4);
        EXPECT_DOUBLE_EQ(beads.length[1], 0.4);
    }
    EXPECT_EQ(refusal("units: si\nchains: [{generator: {freely_jointed: {beads: 2, length: 1}}, positions: a.pdb}]"),
              "positions in a PDB file are in angstrom, the scene is in SI units (s.yaml: chains[0].positions, line 2): give a table x,y,z "
              "in metres");
}

class SystemFiles : public SceneFiles {
  protected:
    SystemFiles() {
        write("system.xml", "<System/>");
        write("topology.pdb", "END\n");
    }
    std::string scene(std::string const& openmm) const {
        return "chains: [{name: a, sequence: GAS, model: calvados2}]\nforces: {openmm: {system: system.xml, " + openmm + "}}";
    }
};

TEST_F(SystemFiles, paths_are_relative_to_the_scene) {
    Scene const s = read(scene("topology: topology.pdb"));
    EXPECT_EQ(s.forces.openmm->system, (folder_ / "system.xml").string());
    EXPECT_EQ(s.forces.openmm->topology, (folder_ / "topology.pdb").string());
    EXPECT_TRUE(s.forces.openmm->builder.empty());
}

TEST_F(SystemFiles, map_of_chains) {
    auto const map = read(scene("map: {a: [4, 6]}")).forces.openmm->map;
    ASSERT_EQ(map.size(), 1u);
    EXPECT_EQ(map[0].first, "a");
    EXPECT_EQ(map[0].second, (std::pair<std::int64_t, std::int64_t>{4, 6}));
    EXPECT_EQ(refusal(scene("map: {b: [0, 2]}")), "no chain is named `b` (s.yaml: forces.openmm.map.b, line 2): use the chains' names");
    EXPECT_EQ(refusal(scene("map: {a: [0, 3]}")),
              "4 particles for the 3 beads of chain `a` (s.yaml: forces.openmm.map.a, line 2): give [first, last], both included");
    EXPECT_EQ(refusal(scene("map: {a: [3, 0]}")),
              "the last particle 0 comes before the first 3 (s.yaml: forces.openmm.map.a, line 2): give [first, last] with particles "
              "counted from 0");
    EXPECT_EQ(refusal(scene("map: {a: 3}")),
              "`3` is not a pair of particles (s.yaml: forces.openmm.map.a, line 2): give [first, last] with particles counted from 0");
    EXPECT_EQ(refusal(scene("map: {a: [-1, 1]}")), "a -1 is below 0 (s.yaml: forces.openmm.map.a[0], line 2): give 0 or more");
}

TEST_F(SystemFiles, what_a_system_says_itself) {
    EXPECT_EQ(refusal(scene("ionic_strength: 0.1, topology: topology.pdb")),
              "key `ionic_strength` means nothing for a finished system (s.yaml: forces.openmm.ionic_strength, line 2): leave it out: the "
              "system says it");
    EXPECT_EQ(refusal(scene("threads: 1")),
              "nothing tells which particles are which chain (s.yaml: forces.openmm, line 2): add `topology: topology.pdb`, or `map: "
              "{chain: [first, last]}`");
    EXPECT_EQ(
        refusal("forces: {openmm: {system: system.xml, map: {a: [0, 2]}}}"),
        "the scene has no `chains`, the system no topology (s.yaml: forces.openmm, line 1): add `topology: topology.pdb`, or `chains`");
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
        pdb += atom(static_cast<int>(k) + 1, "CA", find_calvados2(letters[k])->name, 'A', static_cast<int>(k) + 1, 10 * p[0].get<double>(),
                    ' ', 10 * p[1].get<double>(), 10 * p[2].get<double>());
    }
    write("topology.pdb", pdb + "END\n");
    Scene const s = read("forces: {openmm: {system: " CATENA_TEST_DATA "/reference/calvados2-asyn-system.xml, topology: topology.pdb}}");
    ASSERT_EQ(s.chains.size(), 1u);
    BeadArrays const& beads = s.chains[0].beads;
    ASSERT_EQ(beads.size(), 140u);
    EXPECT_EQ(beads.residue[0], "MET");
    EXPECT_NEAR(beads.mass[139], 71.07 + 16, 1e-12);
    for (std::size_t k = 1; k < beads.size(); ++k) EXPECT_NEAR(norm(beads.position[k] - beads.position[k - 1]), 0.38, 1e-14);
    EXPECT_FALSE(s.box.has_value());
}

TEST_F(SystemFiles, content_decides_the_hash) {
    std::string const before = read(scene("topology: topology.pdb")).hash;
    EXPECT_EQ(read(scene("topology: topology.pdb, platform: Reference, threads: 2")).hash, before);
    write("copy.pdb", "END\n");
    EXPECT_EQ(read(scene("topology: copy.pdb")).hash, before);
    write("system.xml", "<System />");
    EXPECT_NE(read(scene("topology: topology.pdb")).hash, before);
}

}  // namespace
}  // namespace catena::test
