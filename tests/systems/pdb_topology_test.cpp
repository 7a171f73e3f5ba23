#include "systems/pdb_topology.hpp"
#include "structure/mmcif_file.hpp"

#include <set>

#include "tests/force/beads.hpp"

namespace catena::testing {
namespace {

std::string atom(int serial, std::string const& residue, char chain, double x) {
    char line[100];
    std::snprintf(line, sizeof line,
                  "ATOM  %5d  CA  %3s %c%4d    %8.3f%8.3f%8.3f  1.00  0.00           C\n", serial,
                  residue.c_str(), chain, serial, x, -1.5, 20.25);
    return line;
}

std::vector<PdbChain> read(std::string const& text) {
    return read_pdb_topology(scratch_file("topology.pdb", text), "scene.yaml: topology");
}

TEST(PdbTopology, ChainsEndAtTerAndWhereTheIdentifierChanges) {
    auto const chains =
        read("REMARK x\n" + atom(1, "MET", 'A', 1) + atom(2, "ALA", 'A', 2) + "TER\n" +
             atom(3, "GLY", 'A', 3) + atom(4, "LYS", 'B', 4) + atom(5, "TRP", ' ', 5) + "END\n");
    ASSERT_EQ(chains.size(), 4u);
    EXPECT_EQ(chains[0].name, "A");
    EXPECT_EQ(chains[0].residue, (std::vector<std::string>{"MET", "ALA"}));
    EXPECT_EQ(chains[1].name, "A-2");
    EXPECT_EQ(chains[2].residue, std::vector<std::string>{"LYS"});
    EXPECT_EQ(chains[3].name, "4");
    EXPECT_NEAR(chains[0].position[1][0], 0.2, 1e-15);
    EXPECT_NEAR(chains[0].position[1][1], -0.15, 1e-15);
    EXPECT_NEAR(chains[0].position[1][2], 2.025, 1e-15);
}

TEST(PdbTopology, NamesAreUniqueHoweverManyChains) {
    std::string text;
    for (int k = 0; k < 200; ++k)
        text += atom(k, "GLY", static_cast<char>('A' + k % 26), k) + "TER\n";
    auto const chains = read(text);
    ASSERT_EQ(chains.size(), 200u);
    std::set<std::string> names;
    for (auto const& chain : chains) names.insert(chain.name);
    EXPECT_EQ(names.size(), 200u);
    EXPECT_EQ(chains[26].name, "A-2");
    EXPECT_EQ(chains[199].name, "R-8");
}

TEST(PdbTopology, SegmentsTellChainsApart) {
    auto const in_segment = [](int serial, std::string const& segment) {
        std::string line = atom(serial, "GLY", ' ', serial);
        return line.substr(0, 66) + "      " + segment + "\n";
    };
    auto const chains = read(in_segment(1, "PROA") + in_segment(2, "PROA") + in_segment(3, "PROB"));
    ASSERT_EQ(chains.size(), 2u);
    EXPECT_EQ(chains[0].name, "PROA");
    EXPECT_EQ(chains[0].size(), 2u);
    EXPECT_EQ(chains[1].name, "PROB");
}

TEST(PdbTopology, TheFirstModelAloneAndLinesOfOtherSystems) {
    auto const chains = read("MODEL 1\r\n" + atom(1, "GLY", 'A', 1) + "TER\r\n" +
                             atom(2, "GLY", 'A', 2) + "ENDMDL\n" + atom(3, "GLY", 'A', 3));
    ASSERT_EQ(chains.size(), 2u);
    EXPECT_EQ(chains[1].size(), 1u);
}

TEST(PdbTopology, SerialAndResidueNumbersAreNotRead) {
    std::string text;
    for (char const* const serial : {"99999", "A0000", "*****", "186a0"})
        text += atom(1, "GLY", 'A', 1).replace(6, 5, serial);
    text += atom(1, "GLY", 'A', 1).replace(22, 4, "****");
    EXPECT_EQ(read(text).at(0).size(), 5u);
}

TEST(PdbTopology, ModelsAreNoted) {
    std::vector<std::string> notes;
    std::string const model = "MODEL\n" + atom(1, "GLY", 'A', 1) + "ENDMDL\n";
    std::string const file = scratch_file("topology.pdb", model + model + model);
    EXPECT_EQ(read_pdb_topology(file, "scene.yaml: topology", &notes).size(), 1u);
    EXPECT_EQ(notes, std::vector<std::string>{"`" + file + "`: 3 models, the first is taken"});
}

/// OpenMM's mmCIF names chains A to Z and then A again. A build without gemmi says so.
TEST(PdbTopology, MmcifIsRead) {
    std::string text =
        "data_x\n#\nloop_\n_atom_site.label_comp_id\n_atom_site.label_asym_id\n_atom_site.Cartn_x\n"
        "_atom_site.Cartn_y\n_atom_site.Cartn_z\n";
    for (int chain = 0; chain < 27; ++chain)
        text += std::string("GLY ") + static_cast<char>('A' + chain % 26) + " 10 20 30\n";
    if (scene::gemmi_version() == "none") {
        EXPECT_NE(complaint([&] { read(text); }).find("built without gemmi"), std::string::npos);
        return;
    }
    auto const chains = read(text);
    ASSERT_EQ(chains.size(), 27u);
    EXPECT_EQ(chains[26].name, "A-2");
    EXPECT_EQ(chains[0].residue, std::vector<std::string>{"GLY"});
    EXPECT_DOUBLE_EQ(chains[0].position[0][2], 3);
}

TEST(PdbTopology, Messages) {
    EXPECT_EQ(complaint([] { read_pdb_topology("/nowhere/a.pdb", "scene.yaml: topology"); }),
              "cannot open /nowhere/a.pdb (scene.yaml: topology): name a PDB or mmCIF file that "
              "can be read");
    EXPECT_NE(
        complaint([] { read("END\n"); }).find("holds no ATOM record (scene.yaml: topology): "),
        std::string::npos);
    std::string broken = atom(1, "GLY", 'A', 1);
    broken.replace(30, 8, "   1.x  ");
    EXPECT_NE(complaint([&] { read("TER\n" + broken); }).find("`1.x` is not a number ("),
              std::string::npos);
    EXPECT_NE(complaint([&] { read("TER\n" + broken); }).find("topology.pdb: line 2): "),
              std::string::npos);
    EXPECT_NE(
        complaint([&] { read(broken.substr(0, 30) + "\n"); }).find("the atom's line is cut short"),
        std::string::npos);
}

}  // namespace
}  // namespace catena::testing
