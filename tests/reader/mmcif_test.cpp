// mmCIF files: each structure gives the same scene as its PDB form.
#include <zlib.h>

#include "tests/reader/scene_files.hpp"
#include "tests/reader/structure_text.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

using Words = std::vector<std::string>;

std::string replaced(std::string text, std::string const& from, std::string const& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

class Mmcif : public SceneFiles {
  protected:
    std::string scene_of(std::string const& file, std::string const& keys = "") const {
        return "chains: [{pdb: " + file + ", model: calvados2" + (keys.empty() ? "" : ", " + keys) +
               "}]";
    }
    /// Writes both forms and returns the scene, which must be the same.
    Scene both(std::vector<AtomLine> const& atoms, std::string const& keys = "") const {
        write("a.pdb", pdb_text(atoms));
        write("a.cif", cif_text(atoms));
        Scene const pdb = read(scene_of("a.pdb", keys));
        Scene cif = read(scene_of("a.cif", keys));
        EXPECT_EQ(pdb.hash, cif.hash);
        EXPECT_EQ(pdb.chains.size(), cif.chains.size());
        for (std::size_t c = 0; c < pdb.chains.size(); ++c) {
            EXPECT_EQ(pdb.chains[c].name, cif.chains[c].name);
            EXPECT_TRUE(
                test::same_bits(pdb.chains[c].beads.position, cif.chains[c].beads.position));
            EXPECT_EQ(pdb.chains[c].beads.residue, cif.chains[c].beads.residue);
        }
        Words notes = notes_of(cif);
        for (std::string& note : notes) note = replaced(note, "a.cif", "a.pdb");
        EXPECT_EQ(notes_of(pdb), notes);
        return cif;
    }
    /// Both forms must be refused alike; returns the message.
    std::string both_refused(std::vector<AtomLine> const& atoms,
                             std::string const& keys = "") const {
        write("a.pdb", pdb_text(atoms));
        write("a.cif", cif_text(atoms));
        std::string const pdb = refusal(scene_of("a.pdb", keys)),
                          cif = replaced(refusal(scene_of("a.cif", keys)), "a.cif", "a.pdb");
        EXPECT_EQ(pdb, cif);
        return pdb;
    }

    Words const gas_ = {"GLY", "ALA", "SER"};
};

TEST_F(Mmcif, insertion_codes_and_negative_numbers) {
    std::vector<AtomLine> atoms = strand(gas_, "A", -1, 0);
    atoms[2].number = 0;
    atoms[2].insertion = 'A';
    EXPECT_EQ(both(atoms).chains.at(0).beads.residue, gas_);
}

TEST_F(Mmcif, a_modified_residue_in_the_middle_and_what_is_left_out) {
    std::vector<AtomLine> atoms = strand({"GLY", "MSE", "SER"}, "A", 1, 0);
    atoms[1].het = true;
    atoms[2].ends_chain = true;
    atoms.push_back({"O", "HOH", "A", 101, 50, 0, 0, ' ', ' ', 1, true, "O"});
    atoms.push_back({"CA", "CA", "A", 102, 60, 0, 0, ' ', ' ', 1, true, "CA"});
    Scene const s = both(atoms);
    EXPECT_EQ(s.chains.at(0).beads.residue, (Words{"GLY", "MET", "SER"}));
    EXPECT_EQ(s.notes.size(), 3u);  // an ion, a water, a modified residue
}

TEST_F(Mmcif, alternate_locations_and_microheterogeneity) {
    std::vector<AtomLine> atoms = strand({"GLY", "SER", "SER"}, "A", 1, 0);
    atoms[1].alternate = 'A';
    atoms[1].occupancy = 0.3;
    AtomLine other = atoms[1];
    other.residue = "THR";
    other.alternate = 'B';
    other.occupancy = 0.7;
    atoms.insert(atoms.begin() + 2, other);
    Scene const s = both(atoms);
    EXPECT_EQ(s.chains.at(0).beads.residue, (Words{"GLY", "THR", "SER"}));
    EXPECT_NE(s.notes.at(0).find("THR 2 of chain A is taken, not SER"), std::string::npos);
}

TEST_F(Mmcif, chains_of_one_letter_are_told_apart) {
    std::vector<AtomLine> atoms = strand(gas_, "A", 1, 0);
    atoms.back().ends_chain = true;
    atoms = atoms + strand(gas_, "A", 1, 0, 20);
    EXPECT_NE(both_refused(atoms).find("holds 2 chains: A (residues 1 to 3), A"),
              std::string::npos);
    EXPECT_EQ(both(atoms, "chain: all").chains.size(), 2u);
}

TEST_F(Mmcif, models_gaps_and_a_wrapped_start) {
    std::vector<AtomLine> atoms = strand(gas_, "A", 1, 0), second = atoms;
    for (AtomLine& atom : second) atom.model = 7, atom.y = 3;
    EXPECT_EQ(both(atoms + second).notes.size(), 1u);
    EXPECT_DOUBLE_EQ(both(atoms + second, "conformer: 7").chains[0].beads.position[0][1], 0.3);
    EXPECT_NE(both_refused(strand(gas_, "A", 1, 0) + strand(gas_, "A", 7, 20))
                  .find("residues SER 3 and GLY 7 of `a.pdb` stand 1.240 nm apart"),
              std::string::npos);
    std::string const cell =
        "data_x\n_cell.length_a 30\n_cell.length_b 40\n_cell.length_c 50.0(2)\n"
        "_cell.angle_alpha 90\n_cell.angle_beta 90.0\n_cell.angle_gamma 90\n";
    std::string const text = cif_text(strand({"GLY"}, "A", 1, 1) + strand({"ALA"}, "A", 2, 27.2));
    write("a.cif", replaced(text, "data_TEST\n", cell));
    EXPECT_NE(refusal(scene_of("a.cif")).find("write `box: {periodic: [3, 4, 5]}`"),
              std::string::npos);
}

TEST_F(Mmcif, a_chain_may_be_named_by_its_label) {
    // Authors' chains X and Y bear the labels P and Q.
    write("a.cif", cif_text(strand(gas_, "X", 1, 0) + strand({"LYS", "LYS"}, "Y", 1, 0, 20)));
    EXPECT_EQ(read(scene_of("a.cif", "chain: Q")).chains.at(0).beads.residue.size(), 2u);
    EXPECT_EQ(read(scene_of("a.cif", "chain: X")).chains.at(0).beads.residue.size(), 3u);
    EXPECT_EQ(refusal(scene_of("a.cif", "chain: Z")),
              "`a.cif` holds no chain Z (s.yaml: chains[0].pdb, line 1): take one of X, Y");
    // The authors' chain Q bears the label P, and their chain R the label Q.
    write("a.cif", cif_text(strand(gas_, "Q", 1, 0) + strand({"LYS", "LYS"}, "R", 1, 0, 20)));
    Scene const s = read(scene_of("a.cif", "chain: Q"));
    EXPECT_EQ(s.chains.at(0).beads.residue, gas_);
    EXPECT_EQ(notes_of(s),
              Words{"`a.cif`: Q means the chain that the authors call so, not R, whose "
                    "label is Q"});
}

TEST_F(Mmcif, the_sequence_of_the_entity_says_what_is_missing) {
    write("a.cif", cif_text(strand(gas_, "A", 1, 0) + strand(gas_, "A", 6, 15),
                            {"GLY", "ALA", "SER", "LYS", "GLU", "GLY", "ALA", "SER"}));
    Scene const s = read(scene_of("a.cif", "gaps: model"));
    EXPECT_EQ(s.chains.at(0).beads.residue,
              (Words{"GLY", "ALA", "SER", "LYS", "GLU", "GLY", "ALA", "SER"}));
}

TEST_F(Mmcif, compressed_files_of_both_formats) {
    std::vector<AtomLine> const atoms = strand(gas_, "A", 1, 0);
    for (auto const& [name, text] :
         {std::pair{"a.pdb.gz", pdb_text(atoms)}, {"a.cif.gz", cif_text(atoms)}}) {
        gzFile const file = gzopen((folder_ / name).c_str(), "wb");
        gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
        gzclose(file);
        EXPECT_EQ(read(scene_of(name)).chains.at(0).beads.residue, gas_) << name;
    }
    write("a.cif.gz", "\x1F\x8B\x08");
    EXPECT_EQ(refusal(scene_of("a.cif.gz")),
              "the compressed file ends too early (a.cif.gz): fetch the file again");
}

TEST_F(Mmcif, damaged_files_are_refused_with_their_line) {
    std::string const text = cif_text(strand(gas_, "A", 1, 0));
    auto const refused = [&](std::string const& damaged) {
        write("a.cif", damaged);
        return refusal(scene_of("a.cif"));
    };
    EXPECT_NE(refused(text + "7\n").find("the file is not valid mmCIF (line "), std::string::npos);
    EXPECT_NE(refused("loop_\n_atom_site.id\n").find("the file is not valid mmCIF (line "),
              std::string::npos);
    EXPECT_EQ(refused(replaced(text, "3.800", "3.8x")),
              "`3.8x` is not a number (a.cif: row 2 of _atom_site): give Cartn_x, Cartn_y and "
              "Cartn_z in angstrom");
    EXPECT_EQ(refused(replaced(text, "_atom_site.Cartn_y", "_atom_site.other")),
              "`_atom_site` lacks Cartn_y (a.cif): write an mmCIF file with coordinates");
    EXPECT_NE(refused("data_x\n_entry.id x\n").find("no atoms in `a.cif`"), std::string::npos);
    EXPECT_NE(refused(replaced(text, "_atom_site.occupancy", "_atom_site.Cartn_x"))
                  .find("duplicate tag _atom_site.Cartn_x"),
              std::string::npos);
}

TEST_F(Mmcif, blocks_may_share_a_name) {
    std::string const text = cif_text(strand(gas_, "A", 1, 0));
    write("a.cif", text);
    Scene const once = read(scene_of("a.cif"));
    write("a.cif", text + text);
    EXPECT_TRUE(test::same_bits(once.chains.at(0).beads.position,
                                read(scene_of("a.cif")).chains.at(0).beads.position));
}

/// One row would make a million residues of each chain.
TEST_F(Mmcif, few_rows_cannot_ask_for_much_memory) {
    std::vector<AtomLine> atoms;
    for (char chain = 'A'; chain < 'A' + 11; ++chain)
        atoms = atoms + strand(gas_, {chain}, 1, 0, 10 * (chain - 'A'));
    write("a.cif", replaced(cif_text(atoms, {"GLY"}), "1 1 GLY", "1 1000000 GLY"));
    EXPECT_EQ(
        refusal(scene_of("a.cif", "chain: A")),
        "`_entity_poly_seq` lists more than 10000000 residues for the chains (a.cif): correct "
        "its numbers, or leave chains out");
}

TEST_F(Mmcif, positions_may_come_from_mmcif) {
    write("a.cif", cif_text(strand(gas_, "A", 1, 0)));
    Scene const s = read("chains: [{sequence: GAS, model: calvados2, positions: a.cif}]");
    EXPECT_DOUBLE_EQ(s.chains.at(0).beads.position[2][0], 0.76);
}

TEST_F(Mmcif, a_chain_whose_name_looks_like_a_range_is_a_chain) {
    std::vector<std::string> const six{"GLY", "ALA", "SER", "GLY", "ALA", "SER"};
    auto const bent = [&](std::string const& chain) {
        std::vector<AtomLine> atoms = strand(six, chain, 1, 0);
        for (std::size_t k = 0; k < atoms.size(); ++k) atoms[k].y = k % 2 == 0 ? 0 : 1;
        return cif_text(atoms);
    };
    write("a.cif", bent("1-2"));
    write("b.cif", bent("A"));
    std::string const range = "\"1-2:1-4\"";
    for (std::string const& rigid : {range, "[" + range + "]"}) {
        Scene const scene = read(scene_of("a.cif", "rigid: [" + rigid + "]"));
        EXPECT_EQ(scene.chains.at(0).carried().residue.size(), 6U);
    }
    EXPECT_NE(refusal(scene_of("a.cif", "rigid: [\"1-2:1-3, 4-6\"]"))
                  .find("write each in quotes of its own: \"1-2:1-3\", \"1-2:4-6\";"),
              std::string::npos)
        << refusal(scene_of("a.cif", "rigid: [\"1-2:1-3, 4-6\"]"));
    EXPECT_NE(refusal(scene_of("a.cif", "rigid: {1-2: 1-4}"))
                  .find("write [\"1-2:1-4\"], in quotes and without a blank"),
              std::string::npos)
        << refusal(scene_of("a.cif", "rigid: {1-2: 1-4}"));
    EXPECT_NE(refusal(scene_of("b.cif", "rigid: [\"1-2:1-4\"]")).find("holds 2 ranges"),
              std::string::npos);
}

}  // namespace
}  // namespace catena::test
