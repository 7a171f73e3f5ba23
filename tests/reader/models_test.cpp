// Models of chains of residues: tables of the program and of files, their ends, links and forces.
#include <algorithm>

#include "systems/charges.hpp"
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

std::string const columns = "one,three,MW,lambdas,sigmas,q,bondlength\n";
std::string const glycol = "J,PEG,44.05,0.2,0.4,0,0.33\n";
std::string const serines =
    "S,SER,87.08,0.4625,0.518,0,0.38\nB,SEP,165.04,0.0925,0.601,-1.9687,0.42\n";
std::string const forces = "\nforces: {openmm: {builder: calvados2}}";

/// The scene of one chain with the table t.csv.
std::string with_table(std::string const& chain) {
    return "chains: [{" + chain + ", model: {residues: t.csv}}]" + forces;
}

class Models : public SceneFiles {};

TEST_F(Models, of_files_give_masses_names_and_links) {
    write("t.csv", columns + serines);
    Scene const s = read(with_table("sequence: SBSS"));
    BeadArrays const& beads = s.chains[0].beads;
    EXPECT_EQ(beads.mass, (std::vector<double>{87.08 + 2, 165.04, 87.08, 87.08 + 16}));
    EXPECT_EQ(beads.residue, (std::vector<std::string>{"SER", "SEP", "SER", "SER"}));
    EXPECT_EQ(beads.length[1], (0.38 + 0.42) / 2);
    EXPECT_EQ(beads.length[2], (0.42 + 0.38) / 2);
    EXPECT_EQ(beads.length[3], 0.38);
    for (std::size_t k = 1; k < 4; ++k)
        EXPECT_NEAR(norm(beads.position[k] - beads.position[k - 1]), beads.length[k], 1e-14);
    // The forces know what differs from the builder's own table.
    EXPECT_EQ(ForceResidues(*s.forces.openmm).find("SEP")->charge, -1.9687);
    EXPECT_TRUE(s.notes.empty());
}

/// Beads written one by one keep their masses and lengths; the table gives their forces.
TEST_F(Models, of_files_hold_for_beads_one_by_one) {
    write("t.csv", columns + glycol);
    auto const beads = [](std::string const& last) {
        return with_table(
            "bodies: [{mass: 7, residue: PEG, position: [0, 0, 0]}, {mass: 7, residue: PEG, "
            "position: [0.5, 0, 0], joint: {type: link}}, {mass: 7, position: [0, 0.6, 0], "
            "parent: 1, joint: {type: link}" +
            last + "}]");
    };
    Scene const s = read(beads(", residue: PEG"));
    EXPECT_EQ(s.chains[0].beads.mass, (std::vector<double>{7, 7, 7}));
    EXPECT_EQ(s.chains[0].beads.length, (std::vector<double>{0, 0.5, 0.6}));
    EXPECT_EQ(s.chains[0].parent, (std::vector<std::int64_t>{-1, 0, 0}));
    EXPECT_EQ(ForceResidues(*s.forces.openmm).find("PEG")->sigma, 0.4);
    EXPECT_NE(refusal(beads("")).find("residue `UNK` is not in "), std::string::npos);
}

TEST_F(Models, of_files_decide_the_motion) {
    write("t.csv", columns + serines);
    std::string const before = read(with_table("sequence: SBSS")).hash;
    write("t.csv", columns +
                       "S,SER,87.08,0.4625,0.518,0,0.38\n"
                       "B,SEP,165.04,0.0925,0.601,-1.9,0.42\n");
    EXPECT_NE(read(with_table("sequence: SBSS")).hash, before);
}

TEST_F(Models, of_a_file_like_the_programs_are_the_programs) {
    std::string const calvados2 = CATENA_SOURCE_DIR "/inputs/residues_CALVADOS2.csv";
    std::string const rest = "sequence: GASHKEWWRYH";
    Scene const own =
                    read("chains: [{" + rest + ", model: {residues: " + calvados2 + "}}]" + forces),
                built_in = read("chains: [{" + rest + ", model: calvados2}]" + forces);
    EXPECT_EQ(own.hash, built_in.hash);
    EXPECT_EQ(own.forces.openmm->topology, "");
}

TEST_F(Models, of_files_hold_for_a_chain_on_an_anchor) {
    write("t.csv", columns + serines);
    Scene const s =
        read("chains: [{sequence: BSS, model: {residues: t.csv}, base: fixed, anchor: [1, 2, 3]}]");
    BeadArrays const& beads = s.chains[0].beads;
    EXPECT_EQ(beads.length[0], 0.42);
    EXPECT_EQ(beads.length[2], 0.38);
    EXPECT_NEAR(norm(beads.position[0] - beads.anchor), 0.42, 1e-14);
    EXPECT_NEAR(norm(beads.position[2] - beads.position[1]), 0.38, 1e-14);
}

TEST_F(Models, of_files_read_modified_residues_of_a_structure) {
    write("t.csv", columns + serines);
    write("a.pdb", atom(1, "CA", "SER", 'A', 1, 0) + atom(2, "CA", "SEP", 'A', 2, 3.8) + "END\n");
    Scene const s = read(with_table("pdb: a.pdb, links: as_given"));
    EXPECT_EQ(s.chains[0].beads.residue[1], "SEP");
    EXPECT_EQ(
        refusal("chains: [{pdb: a.pdb, model: calvados2}]"),
        "`SEP 2` has another charge than SER, and calvados2 has no parameters for it (s.yaml: "
        "chains[0].pdb, bead 2, line 1): write SER in the file if that charge may be lost, "
        "or name a table that has it: `model: {residues: FILE.csv}`");
}

TEST_F(Models, of_files_have_their_own_letters) {
    write("t.csv", columns + "r,RNA,126.3,1.18,0.6238,0,0.54\n" + serines);
    Scene const s = read(with_table("sequence: rSrs"));
    EXPECT_EQ(s.chains[0].beads.residue, (std::vector<std::string>{"RNA", "SER", "RNA", "SER"}));
    ASSERT_FALSE(s.notes.empty());
    EXPECT_EQ(s.notes[0],
              "`chains[0].sequence`: 1 of 4 letters are lower case and are read as capitals");
    EXPECT_EQ(refusal(with_table("sequence: SGS")),
              "`G` at position 2 of the sequence is not a residue of t.csv"
              " (s.yaml: chains[0].sequence, line 1): use the one-letter codes rSB");
}

TEST_F(Models, of_the_program_name_no_residue_by_ambiguous_letters) {
    EXPECT_EQ(refusal("chains: [{sequence: GBS, model: calvados3}]"),
              "`B` at position 2 of the sequence is not a residue of calvados3 (s.yaml: "
              "chains[0].sequence, line 1): use the one-letter codes ARNDCQEGHILKMFPSTWYV, or name "
              "a table with this code: `model: {residues: FILE.csv}`");
}

TEST_F(Models, and_faulty_files_are_refused_with_their_line) {
    write("t.csv", columns + "S,SER,87.08,0.4625,-0.518,0,0.38\n");
    EXPECT_EQ(refusal(with_table("sequence: SS")),
              "`sigmas` of residue `SER` is -0.518 nm (t.csv: line 2): give nanometres above 0, at "
              "most 1.78");
    EXPECT_EQ(refusal("chains: [{sequence: SS, model: {residues: no.csv}}]"),
              "no such file: `no.csv` (s.yaml: chains[0].model.residues, line 1): check the path");
    EXPECT_EQ(refusal("chains: [{sequence: SS, model: t.csv}]"),
              "`t.csv` is not a model (s.yaml: chains[0].model, line 1): name a table as `model: "
              "{residues: FILE.csv}`");
    EXPECT_EQ(refusal("chains: [{sequence: SS, model: calvados2}]\nforces: {openmm: {builder: "
                      "calvados2, residues: t.csv}}"),
              "residue tables belong to the chains (s.yaml: forces.openmm.residues, line 2): write "
              "`model: {residues: FILE.csv}` in the chain");
}

TEST_F(Models, of_chains_and_forces_are_the_same) {
    EXPECT_EQ(refusal("chains: [{sequence: SS, model: calvados3}]" + forces),
              "the chain has model calvados3, the forces have builder calvados2 (s.yaml: "
              "chains[0].model, line 1): write the same model in both");
    Scene const s = read(
        "chains: [{sequence: SS, model: calvados3}]\n"
        "forces: {openmm: {builder: calvados3}}");
    EXPECT_EQ(s.forces.openmm->builder, "calvados3");
    EXPECT_EQ(s.forces.openmm->topology, "");
}

TEST_F(Models, of_several_chains_agree_on_a_residue) {
    write("t.csv", columns + serines);
    write("u.csv", columns + "S,SER,87.08,0.462541681161,0.518,0,0.38\n" + glycol);
    std::string const u = (folder_ / "u.csv").string(), remedy = "take one table for both chains";
    auto const scene = [&](std::string const& a, std::string const& b) {
        return "chains: [{name: a, sequence: " + a + "}, {name: b, sequence: " + b +
               ", charge_termini: none}]" + forces;
    };
    EXPECT_EQ(refusal(scene("SBS, model: {residues: t.csv}", "SS, model: {residues: u.csv}")),
              "residue SER of u.csv has other parameters in t.csv, the table of another chain, or "
              "is not in it (s.yaml: chains[1], bead 1, line 1): " +
                  remedy);
    EXPECT_EQ(refusal(scene("SS, model: {residues: u.csv}", "SBS, model: {residues: t.csv}")),
              "residue SER of u.csv has other parameters in t.csv, the table of another chain, or "
              "is not in it (s.yaml: chains[0], bead 1, line 1): " +
                  remedy);
    EXPECT_EQ(refusal(scene("SBS, model: {residues: t.csv}", "GS, model: calvados2")),
              "residue SER of calvados2 has other parameters in t.csv, the table of another "
              "chain, or is not in it (s.yaml: chains[1], bead 2, line 1): " +
                  remedy);
    EXPECT_EQ(refusal(scene("SBS, model: {residues: t.csv}", "JJ, model: {residues: u.csv}")),
              "residue PEG of u.csv has other parameters in t.csv, the table of another chain, or "
              "is not in it (s.yaml: chains[1], bead 1, line 1): " +
                  remedy);
    Scene const s = read(scene("GS, model: calvados2", "SJJ, model: {residues: u.csv}"));
    EXPECT_EQ(s.forces.openmm->topology, u);
    EXPECT_EQ(s.chains[1].beads.length[2], 0.33);
}

TEST_F(Models, without_amino_acids_at_their_ends_have_no_termini) {
    write("t.csv", columns + glycol + serines);
    Scene const s = read(with_table("name: p, count: 2, sequence: JJJ"));
    EXPECT_EQ(s.chains[0].beads.mass[0], 44.05);
    EXPECT_EQ(s.chains[1].beads.mass[2], 44.05);
    EXPECT_EQ(assumed_charges(s), "p-1 and p-2 0.000 e each; together 0.000 e");
    ASSERT_EQ(s.notes.size(), 1U);
    EXPECT_EQ(
        s.notes[0],
        "chain `p`: PEG at its ends is not an amino acid and carries no charge of a terminus: "
        "write `charge_termini: none` or `both`");
    EXPECT_EQ(assumed_charges(read(with_table("name: p, sequence: SJJ"))), "p 1.000 e");
    EXPECT_EQ(assumed_charges(read(with_table("name: p, sequence: JJB, charge_termini: N"))),
              "p -0.969 e");
    EXPECT_TRUE(read(with_table("sequence: JJJ, charge_termini: none")).notes.empty());
}

TEST_F(Models, note_phosphates_of_another_ph) {
    write("t.csv", columns + serines);
    std::string const chain = "chains: [{sequence: SBS, model: {residues: t.csv}}]\n";
    auto const notes = [&](std::string const& ph) {
        return notes_of(read(chain + "forces: {openmm: {builder: calvados2, ph: " + ph + "}}"));
    };
    EXPECT_TRUE(notes("7.5").empty());
    ASSERT_EQ(notes("6").size(), 1U);
    EXPECT_EQ(notes("6")[0],
              "`t.csv` gives SEP the charge -1.969 e, at `ph` 6 it has -1.494 e (pKa 6.01): "
              "correct the table unless its charge is meant");
}

/// Charges of alpha-synuclein and of histatin 5, with and without a pH.
TEST_F(Models, give_net_charges) {
    auto const charge = [&](std::string const& sequence, std::string const& openmm) {
        return assumed_charges(read("chains: [{name: a, sequence: " + sequence +
                                    ", model: calvados2}]\nforces: {openmm: {builder: calvados2" +
                                    openmm + "}}"));
    };
    std::string const synuclein =
        "MDVFMKGLSKAKEGVVAAAEKTKQGVAEAAGKTKEGVLYVGSKTKEGVVHGVATVAEKTKEQVTNVGGAVVTGVTAVAQKTVEGAGSIAA"
        "A"
        "TGFVKKDQLGKNEEGAPQEGILEDMPVDPDNEAYEMPSEEGYQDYEPEA";
    EXPECT_EQ(charge(synuclein, ""), "a -9.000 e; histidine neutral (no ph given), 1 of them");
    EXPECT_EQ(charge(synuclein, ", ph: 7.5"), "a -8.969 e; histidine 0.0307 e (pH 7.5), 1 of them");
    EXPECT_EQ(charge("DSHAKRHHGYKRKFHEKHHSHRGY", ", ph: 7.5"),
              "a 5.215 e; histidine 0.0307 e (pH 7.5), 7 of them");
    EXPECT_EQ(charge("DSHAKRHHGYKRKFHEKHHSHRGY", ", ph: 5"),
              "a 11.364 e; histidine 0.909 e (pH 5), 7 of them");
    EXPECT_EQ(charge("GG", ", charge_termini: C"), "a -1.000 e");
    EXPECT_EQ(assumed_charges(read("chains: [{sequence: GG, model: calvados2}]")), "");
}

}  // namespace
}  // namespace catena::test
