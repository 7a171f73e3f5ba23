// PDB files, good and bad.
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

TEST_F(SceneFiles, alpha_carbons_of_a_pdb_file) {
    write("a.pdb", "HEADER\n" + atom(1, "N", "GLY", 'A', 1, 0) + atom(2, "CA", "GLY", 'A', 1, 1) +
                       atom(3, "CA", "ALA", 'A', 2, 4.8) + "ENDMDL\n" +
                       atom(5, "CA", "SER", 'A', 3, 9));
    Scene const s = read(with_pdb_);
    BeadArrays const& beads = s.chains.at(0).beads;
    EXPECT_EQ(beads.residue, (std::vector<std::string>{"GLY", "ALA"}));
    EXPECT_DOUBLE_EQ(beads.position[0][0], 0.1);
    EXPECT_DOUBLE_EQ(beads.position[0][2], -0.025);
    EXPECT_DOUBLE_EQ(beads.length[1], 0.38);
    EXPECT_EQ(notes_of(s), std::vector<std::string>{"`a.pdb`: 2 models, the first is taken"});
}

TEST_F(SceneFiles, bad_pdb_files) {
    std::string const where = " (s.yaml: chains[0].pdb, line 1): ",
                      own = " (a.pdb): write a PDB or mmCIF file";
    auto const refused = [&](std::string const& text, std::string const& message) {
        write("a.pdb", text);
        EXPECT_EQ(refusal(with_pdb_), message);
    };
    refused("HEADER\n", "no atoms in `a.pdb`" + where + "give ATOM records");
    refused(atom(1, "N", "GLY", 'A', 1, 0) + atom(2, "C", "GLY", 'A', 1, 1),
            "residue GLY 1 of chain A of `a.pdb` has several atoms and none is its only CA" +
                where + "keep one atom per residue");
    std::string const rna =
        "name a chain of amino acids by `chain`, or take nucleic acids out of the file; RNA takes "
        "its `sequence` and `model: calvados_rna`";
    refused(atom(1, "P", "A", 'A', 1, 0) + atom(2, "C1'", "A", 'A', 1, 3),
            "residue A 1 of chain A of `a.pdb` has several atoms and none is its only CA" + where +
                rna);
    refused(atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "P", "DG5", 'A', 2, 1),
            "residue DG5 2 of chain A of `a.pdb` has no CA atom (line 2)" + where + rna);
    refused(atom(1, "CA", "U", 'A', 1, 0),
            "`U 1` is not a residue of calvados2 (s.yaml: chains[0].pdb, bead 1, line 1): " + rna);
    refused(atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "GLY", 'B', 1, 1),
            "`a.pdb` holds 2 chains: A (residue 1), B (residue 1)" + where +
                "choose one, such as `chain: A`, or write `chain: all`");
    refused(atom(1, "CA", "GLY", 'A', 1, 0) + "TER\n" + atom(2, "CA", "GLY", 'A', 2, 3.8) +
                atom(3, "CA", "GLY", 'A', 3, 7.6),
            "`a.pdb` holds 2 chains: A (residue 1), A (residues 2 to 3)" + where +
                "choose one, such as `chain: A`, or write `chain: all`");
    refused(atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "XYZ", 'A', 2, 1),
            "`XYZ 2` is not a residue of calvados2 (s.yaml: chains[0].pdb, bead 2, line 1): rename "
            "or remove it in the file");
    refused(atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "SEP", 'A', 2, 1),
            "`SEP 2` has another charge than SER, and calvados2 has no parameters for it (s.yaml: "
            "chains[0].pdb, bead 2, line 1): write SER "
            "in the file if that charge may be lost, or name a table that has it: `model: "
            "{residues: FILE.csv}`");
    refused(atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "N", "ALA", 'A', 2, 1),
            "residue ALA 2 of chain A of `a.pdb` has no CA atom (line 2)" + where +
                "add it, or take the residue out of the file");
    refused(atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "GLY", 'A', 1, 0),
            "residue GLY 1 of chain A of `a.pdb` has atom CA twice (lines 1 and 2)" + where +
                "keep one of them");
    refused(atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "ALA", 'A', 1, 3.8),
            "residue GLY 1 of chain A of `a.pdb` comes again as ALA (line 2)" + where +
                "give each residue its own number or insertion code");
    refused(atom(1, "CA", "GLY", 'A', 2, 0) + atom(2, "CA", "ALA", 'A', 1, 3.8),
            "residue ALA 1 follows GLY 2 in `a.pdb`" + where +
                "sort the residues by their numbers, number them along the chain, or keep one "
                "chain per file");
    refused(" \n", "the file is empty" + own);
    refused("<!DOCTYPE html>\n", "the file holds HTML or XML" + own);
    refused(std::string("ATOM\0", 5), "the file is not a text file" + own);
    refused(">p\nGAS\n", "the file holds sequences (FASTA)" + own + ", or give it as `fasta`");
}

TEST_F(SceneFiles, pdb_files_with_wrong_columns) {
    std::string const where =
        " (a.pdb: line 1): give x, y and z in angstrom, with a decimal point, in columns 31-38, "
        "39-46 and 47-54";
    std::string const good = atom(1, "CA", "GLY", 'A', 1, 1.234, ' ', 30.5, 20.25);
    auto const refused = [&](std::string const& text, std::string const& what) {
        write("a.pdb", text);
        EXPECT_EQ(refusal(with_pdb_), what + where);
    };
    refused(good.substr(0, 40) + "\n", "the atom's line is cut short");
    refused("ATOM 1 CA GLY A 1 1.234 30.500 20.250 1.00 0.00 some more of it\n",
            "the coordinates begin before column 31");
    refused(std::string(good).replace(30, 24, "       1.234      30.500"),
            "`1` is cut out of its column");
    write("a.pdb", std::string(good).replace(30, 24, "       1      30      20"));
    EXPECT_EQ(refusal(with_pdb_), "accepted");
    refused(std::string(good).insert(6, "1"), "`1.23` is cut out of its column");
    refused(std::string(good).replace(29, 1, "1"), "the coordinates begin before column 31");
}

TEST_F(SceneFiles, a_pdb_file_may_have_six_digits_of_serials_and_long_residue_names) {
    write("a.pdb", std::string(atom(1, "CA", "HSD", 'A', 1, 0)).replace(4, 7, " 100000") +
                       std::string(atom(2, "CA", "HIS", 'A', 2, 3.8)).replace(17, 4, "HISE") +
                       std::string(atom(3, "CA", "GLY", 'A', 3, 7.6)).replace(4, 7, "  *****"));
    EXPECT_EQ(read(with_pdb_).chains.at(0).beads.residue,
              (std::vector<std::string>{"HIS", "HIS", "GLY"}));
}

TEST_F(SceneFiles, residues_at_ends_as_amber_names_them) {
    write("a.pdb", std::string(atom(1, "CA", "GLY", 'A', 1, 0)).replace(17, 4, "NMET") +
                       atom(2, "CA", "GLY", 'A', 2, 3.8) +
                       std::string(atom(3, "CA", "GLY", 'A', 3, 7.6)).replace(17, 4, "CHIE"));
    Scene const s = read("chains: [{pdb: a.pdb, model: calvados2}]");
    EXPECT_EQ(s.chains.at(0).beads.residue, (std::vector<std::string>{"MET", "GLY", "HIS"}));
    EXPECT_EQ(
        notes_of(s),
        std::vector<std::string>{
            "`a.pdb`: residues take the parameters and charge of their parents (1 CHIE as HIS, "
            "1 NMET as MET)"});
}

TEST_F(SceneFiles, a_long_chain_as_catena_writes_it) {
    std::string text;
    for (int k = 0; k < 20500; ++k)
        text += atom(k, "CA", "GLY", 'A', (k + 1) % 10000, 3.29 * (k % 20), ' ', k % 2, 0.3 * k);
    write("a.pdb", text + "TER\nEND\n");
    Scene const s = read("chains: [{pdb: a.pdb, model: calvados2, links: as_given}]");
    EXPECT_EQ(s.chains.at(0).beads.size(), 20500u);
}

TEST_F(SceneFiles, residue_numbers_of_openmm_beyond_their_columns) {
    auto const numbered = [](char const* number, double x) {
        return atom(1, "CA", "GLY", 'A', 1, x).replace(22, 4, number);
    };
    write("a.pdb", numbered("9999", 0) + numbered("A000", 3.8) + numbered("A001", 7.6));
    EXPECT_TRUE(read("chains: [{pdb: a.pdb, model: calvados2}]").notes.empty());
    write("a.pdb", numbered("A00F", 0) + numbered("A010", 3.8) + numbered("A011", 7.6));
    EXPECT_TRUE(read("chains: [{pdb: a.pdb, model: calvados2}]").notes.empty());
    write("a.pdb", numbered("A00F", 0) + numbered("A00G", 3.8) + numbered("A00H", 7.6));
    EXPECT_TRUE(read("chains: [{pdb: a.pdb, model: calvados2}]").notes.empty());
    write("a.pdb", numbered("A00F", 0) + numbered("A012", 3.8));
    EXPECT_EQ(read("chains: [{pdb: a.pdb, model: calvados2}]").notes.size(), 1u);
}

TEST_F(SceneFiles, residue_numbers_beyond_their_columns) {
    write("a.pdb", atom(1, "CA", "GLY", 'A', 9999, 0) + atom(2, "CA", "GLY", 'A', 0, 3.8) +
                       std::string(atom(3, "CA", "ALA", 'A', 1, 7.6)).replace(22, 4, "A000") +
                       std::string(atom(4, "CA", "ALA", 'A', 1, 11.4)).replace(22, 4, "****") +
                       std::string(atom(5, "CA", "ALA", 'A', 1, 15.2)).replace(22, 4, "****"));
    EXPECT_EQ(read("chains: [{pdb: a.pdb, model: calvados2}]").chains.at(0).beads.size(), 5u);
}

TEST_F(SceneFiles, rigid_domains_of_a_pdb_file_bear_its_residue_numbers) {
    write("a.pdb", atom(1, "CA", "GLY", 'A', 10, 0) + atom(2, "CA", "GLY", 'A', 11, 3.8) +
                       atom(3, "CA", "ALA", 'A', 12, 3.8, ' ', 4.3) +
                       std::string(atom(4, "CA", "ALA", 'A', 12, 0, ' ', 4.3)).replace(26, 1, "A"));
    auto const with = [](std::string const& rigid) {
        return "chains: [{pdb: a.pdb, model: calvados2, rigid: " + rigid + "}]";
    };
    Scene const s = read(with("[[11, 12A]]"));
    EXPECT_EQ(s.chains.at(0).linked.mass.size(), 2u);
    EXPECT_EQ(
        notes_of(s),
        std::vector<std::string>{
            "`rigid` means the residue numbers of `a.pdb`: residues 11 to 12A are beads 2 to 4"});
    std::string const where = " (s.yaml: chains[0].rigid[0], line 1): ";
    EXPECT_EQ(
        refusal(with("[[1, 3]]")),
        "residue 1 is not in the file" + where +
            "give [first, last] with the file's residue numbers, here 10 to 12A, both included");
    EXPECT_EQ(
        refusal(with("[[10, 11]]")),
        "residues 10 to 11 do not form a rigid body, which needs three residues that do not lie on "
        "one line" +
            where +
            "give [first, last] with the file's residue numbers, here 10 to 12A, both included");
    EXPECT_EQ(refusal(with("[[10, 12], [12, 12A]]")).substr(0, 25), "residues 12 to 12A do not");
}

TEST_F(SceneFiles, rigid_domains_of_a_sequence_are_counted_from_one) {
    write("a.pdb", atom(1, "CA", "GLY", 'A', 10, 0) + atom(2, "CA", "GLY", 'A', 11, 3.8) +
                       atom(3, "CA", "GLY", 'A', 12, 3.8, ' ', 4.3) +
                       atom(4, "CA", "GLY", 'A', 13, 0, ' ', 4.3));
    Scene const s =
        read("chains: [{sequence: GGGG, model: calvados2, positions: a.pdb, rigid: [[1, 3]]}]");
    EXPECT_EQ(s.chains.at(0).linked.size(), 2u);
    EXPECT_EQ(notes_of(s).back(),
              "`rigid` counts the residues of the sequence from 1, not by their numbers in `a.pdb` "
              "(10 to 13)");
}

TEST_F(SceneFiles, positions_and_conformation_from_a_pdb_file) {
    write("a.pdb", atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "GLY", 'B', 1, 4));
    for (char const* const key : {"positions: a.pdb", "conformation: {pdb: a.pdb}"}) {
        Scene const s =
            read(std::string("chains: [{sequence: GW, model: calvados2, links: as_given, ") + key +
                 "}]");
        BeadArrays const& beads = s.chains.at(0).beads;
        EXPECT_EQ(notes_of(s),
                  std::vector<std::string>{"`a.pdb` names other residues than the sequence in 1 of "
                                           "2 places: its positions are used all the same"});
        EXPECT_DOUBLE_EQ(beads.position[1][0], 0.4);
        EXPECT_DOUBLE_EQ(beads.length[1], 0.4);
    }
    EXPECT_EQ(refusal("units: si\nchains: [{generator: {freely_jointed: {beads: 2, length: 1}}, "
                      "positions: a.pdb}]"),
              "positions in a structure file are in angstrom, the scene is in SI units (s.yaml: "
              "chains[0].positions, line 2): give a table x,y,z "
              "in metres");
}

/// All beads are within a link of each other: the search for overlaps is not to look at all pairs.
TEST_F(SceneFiles, a_long_table_in_another_unit_is_refused_at_once) {
    std::size_t constexpr beads = 100000;
    std::string table;
    for (std::size_t k = 0; k < beads; ++k) table += std::to_string(k) + "e-7,0,0\n";
    write("start.csv", table);
    std::string const message = refusal("chains: [{sequence: " + std::string(beads, 'G') +
                                        ", model: calvados2, positions: start.csv}]");
    EXPECT_NE(message.find("and 99998 other links would change by more than 30 %; beads "),
              std::string::npos)
        << message;
    EXPECT_NE(message.find(" overlap: 2e-07 nm apart"), std::string::npos) << message;
}

/// A fusion bears the numbers of its parts. The atoms of the peptide bond tell it from residues in
/// disorder.
TEST_F(SceneFiles, numbers_may_fall_across_a_peptide_bond) {
    std::string const one = atom(1, "CA", "GLY", 'A', 1003, 0),
                      two = atom(3, "CA", "GLY", 'A', 263, 3.8);
    write("a.pdb", one + atom(2, "C", "GLY", 'A', 1003, 1.3, ' ', 1) +
                       atom(4, "N", "GLY", 'A', 263, 2.6, ' ', 1) + two);
    Scene const s = read("chains: [{pdb: a.pdb, model: calvados2}]");
    EXPECT_EQ(s.chains.at(0).beads.size(), 2u);
    EXPECT_EQ(
        notes_of(s),
        std::vector<std::string>{
            "`a.pdb`: residue numbers skip once between neighbours at a link's distance (first: "
            "1003 to 263): no residue is missing there"});
    write("a.pdb", one + two);
    EXPECT_EQ(refusal("chains: [{pdb: a.pdb, model: calvados2}]")
                  .rfind("residue GLY 263 follows GLY 1003 in `a.pdb`", 0),
              0u);
}

TEST_F(SceneFiles, what_is_no_chain_is_left_out_of_a_pdb_file) {
    auto const het = [](std::string const& name, std::string const& residue, int number) {
        return "HETATM" + atom(1, name, residue, 'A', number, 50).substr(6);
    };
    write("a.pdb", atom(1, "CH3", "ACE", 'A', 0, -2) + atom(1, "CA", "GLY", 'A', 1, 0) +
                       atom(2, "CA", "ALA", 'A', 2, 3.8) + atom(3, "N", "NME", 'A', 3, 6) +
                       atom(4, "SOD", "SOD", 'A', 4, 9) + het("O", "HOH", 5) + het("O", "HOH", 6) +
                       het("FE", "HEM", 7) + het("NA", "HEM", 7) + het("MG", "CLA", 8) +
                       het("C1", "CLA", 8) + het("XE", "XE", 9));
    Scene const s = read(with_pdb_);
    EXPECT_EQ(s.chains.at(0).beads.residue, (std::vector<std::string>{"GLY", "ALA"}));
    EXPECT_EQ(notes_of(s), (std::vector<std::string>{"`a.pdb`: 2 caps left out (1 ACE, 1 NME)",
                                                     "`a.pdb`: 2 ions left out (1 SOD, 1 XE)",
                                                     "`a.pdb`: 2 ligands left out (1 CLA, 1 HEM)",
                                                     "`a.pdb`: 2 waters left out (2 HOH)"}));
}

TEST_F(SceneFiles, solvent_may_be_numbered_from_one_again) {
    write("a.pdb", atom(1, "CA", "GLY", ' ', 1, 0) + atom(2, "CA", "ALA", ' ', 2, 3.8) +
                       atom(3, "OW", "SOL", ' ', 1, 9) + atom(3, "HW1", "SOL", ' ', 1, 9) +
                       atom(3, "OW", "SOL", ' ', 2, 9) + atom(3, "NA", "NA", ' ', 1, 9));
    Scene const s = read(with_pdb_);
    EXPECT_EQ(s.chains.at(0).beads.size(), 2u);
    EXPECT_EQ(notes_of(s), (std::vector<std::string>{"`a.pdb`: 1 ion left out (1 NA)",
                                                     "`a.pdb`: 2 waters left out (2 SOL)"}));
}

/// One-letter names are residues of somebody's model, not potassium.
TEST_F(SceneFiles, a_lysine_called_k_is_no_ion) {
    write("a.pdb", atom(1, "CA", "K", 'A', 1, 0) + atom(2, "CA", "GLY", 'A', 2, 3.8));
    EXPECT_EQ(refusal(with_pdb_),
              "`K 1` is not a residue of calvados2 (s.yaml: chains[0].pdb, bead 1, line 1): rename "
              "or remove it in the file");
}

TEST_F(SceneFiles, alternate_locations_in_blocks_and_of_two_residues) {
    auto const occupied = [](std::string line, char const* occupancy) {
        return line.replace(56, 4, occupancy);
    };
    write("a.pdb", occupied(atom(1, "CA", "GLY", 'A', 1, 9, 'A'), "0.30") +
                       occupied(atom(2, "CA", "SER", 'A', 2, 9, 'A'), "0.30") +
                       occupied(atom(3, "CA", "GLY", 'A', 1, 0, 'B'), "0.70") +
                       occupied(atom(4, "CA", "THR", 'A', 2, 3.8, 'B'), "0.70"));
    Scene const s = read("chains: [{pdb: a.pdb, model: calvados2}]");
    EXPECT_EQ(s.chains.at(0).beads.residue, (std::vector<std::string>{"GLY", "THR"}));
    EXPECT_EQ(notes_of(s), std::vector<std::string>{"`a.pdb`: alternate locations in 2 residues: "
                                                    "the one of largest occupancy is taken; THR 2 "
                                                    "of chain A is taken, not SER"});
}

TEST_F(SceneFiles, an_alternate_location_without_its_alpha_carbon) {
    auto const file = [&](char const* first, char const* second) {
        write("a.pdb", atom(1, "CB", "GLY", 'A', 1, 0, 'A').replace(56, 4, first) +
                           atom(2, "CA", "GLY", 'A', 1, 0, 'B').replace(56, 4, second) +
                           atom(3, "CA", "ALA", 'A', 2, 3.8));
    };
    file("0.60", "0.40");
    EXPECT_EQ(refusal(with_pdb_),
              "residue GLY 1 of chain A of `a.pdb` has no CA atom in alternate location A (line 1) "
              "(s.yaml: chains[0].pdb, "
              "line 1): add it, or take the location out of the file");
    file("0.40", "0.60");
    EXPECT_EQ(refusal(with_pdb_), "accepted");
}

TEST_F(SceneFiles, residues_that_seqres_lists_and_the_file_lacks) {
    write("a.pdb", "SEQRES   1 A    4  GLY ALA SER GLY\n" + atom(1, "CA", "GLY", 'A', 1, 0) +
                       atom(2, "CA", "ALA", 'A', 2, 3.8));
    EXPECT_EQ(notes_of(read(with_pdb_)),
              std::vector<std::string>{"`a.pdb`: the chain's sequence has 4 residues, but only 2 "
                                       "have positions and become beads"});
}

TEST_F(SceneFiles, pdb_files_that_may_be_cut_are_noted) {
    std::string const begin = atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "ALA", 'A', 2, 3.8),
                      last = atom(3, "CA", "SER", 'A', 3, 7.6);
    auto const notes = [&](std::string const& text) {
        write("a.pdb", text);
        return notes_of(read(with_pdb_));
    };
    auto const noted = [](std::string const& sign) {
        return std::vector<std::string>{"`a.pdb`: " + sign +
                                        ": the file may be cut, and atoms or chains lost; get it "
                                        "anew, or end it by END if it is whole"};
    };
    auto const columns = std::to_string(begin.find('\n'));
    EXPECT_EQ(
        notes(begin + last.substr(0, 54)),
        noted("the last line is an atom's of 54 columns, all others have " + columns + " or more"));
    EXPECT_EQ(notes(begin + "AT"), noted("the last line is `AT`, the beginning of ATOM"));
    EXPECT_EQ(notes("MODEL        1\n" + begin), noted("the last model has no ENDMDL"));
    for (std::string const& whole :
         {begin + last, begin + last.substr(0, 54) + "\nEND\n", begin + "TER",
          "MODEL        1\n" + begin + "ENDMDL\n", "MODEL        1\n" + begin + "END"})
        EXPECT_TRUE(notes(whole).empty()) << whole;
}

TEST_F(SceneFiles, gaps_of_a_pdb_file) {
    std::string const
        where = " (s.yaml: chains[0].pdb, line 1): ",
        ways =
            "write `gaps: split` for two chains, `gaps: model` to grow what is missing, or `links: "
            "as_given` to keep the distance";
    auto const pair = [&](int number, double x) {
        write("a.pdb", atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "CA", "ALA", 'A', number, x));
    };
    std::string const scene = "chains: [{pdb: a.pdb, model: calvados2}]";
    for (double const x : {2.9, 3.8, 4.2}) {  // cis, trans, a frame of springs
        pair(2, x);
        EXPECT_EQ(refusal(scene), "accepted") << x;
    }
    pair(2, 5);
    EXPECT_EQ(refusal(scene),
              "residues GLY 1 and ALA 2 of `a.pdb` stand 0.500 nm apart: the chain has a gap" +
                  where + ways);
    pair(2, 96.2);
    std::string const wrapped =
        "residues GLY 1 and ALA 2 of `a.pdb` stand 9.620 nm apart: the chain has a gap" + where +
        ways;
    EXPECT_EQ(refusal(scene), wrapped + " (if the chain is wrapped into a box, give `box`)");
    EXPECT_EQ(refusal(scene + "\nbox: {periodic: [30, 30, 30]}"), wrapped);
    EXPECT_EQ(refusal(scene + "\nbox: {periodic: [10, 10, 10]}"), "accepted");
    pair(3, 4.4);
    EXPECT_EQ(refusal(scene),
              "residues GLY 1 and ALA 3 of `a.pdb` stand 0.440 nm apart: the chain has a gap" +
                  where + ways);
    pair(2, 0.38);
    EXPECT_EQ(
        refusal(scene),
        "residues GLY 1 and ALA 2 of `a.pdb` stand 0.038 nm apart, nearer than neighbours can" +
            where + "correct the file (its unit is angstrom), or write `links: as_given`");
    write("a.pdb", atom(1, "CA", "GLY", 'A', 1, 0) + atom(2, "C", "GLY", 'A', 1, -1) +
                       atom(3, "N", "ALA", 'A', 2, 4.5) + atom(4, "CA", "ALA", 'A', 2, 3.8));
    EXPECT_EQ(refusal(scene),
              "residues GLY 1 and ALA 2 of `a.pdb` stand 0.380 nm apart, the peptide bond between "
              "them is 0.550 nm long: the chain has a gap" +
                  where + ways);
    write("a.pdb", "CRYST1   30.000   40.000   50.000  90.00  90.00  90.00 P 1           1\n" +
                       atom(1, "CA", "GLY", 'A', 1, 1) + atom(2, "CA", "ALA", 'A', 2, 27.2));
    EXPECT_EQ(refusal(scene),
              "residues GLY 1 and ALA 2 of `a.pdb` stand 2.620 nm apart: the file is wrapped into "
              "its cell (CRYST1)" +
                  where + "write `box: {periodic: [3, 4, 5]}`, or make the chain whole");
}

}  // namespace
}  // namespace catena::test
