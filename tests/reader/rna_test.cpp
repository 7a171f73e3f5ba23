// RNA in scenes: `model: calvados_rna`, its beads, its starts, and what is refused.
#include <cmath>

#include "scene/branches.hpp"
#include "scene/freedom.hpp"
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

using Inboard = std::vector<std::int64_t>;

std::string chain(std::string const& keys) {
    return "chains: [{name: rna, model: calvados_rna, " + keys + "}]";
}

bool has_note(Scene const& scene, std::string const& part) {
    for (std::string const& note : scene.notes)
        if (note.find(part) != std::string::npos) return true;
    return false;
}

/// Largest difference of a link from its length, nm.
double largest_gap(ChainSpec const& chain) {
    double largest = 0;
    std::vector<Vec3> const& x = chain.beads.position;
    for (std::size_t k = 1; k < chain.size(); ++k)
        largest = std::max(largest, std::abs(norm(x[k] - x[scene::inboard_of(chain.parent, k)]) -
                                             chain.beads.length[k]));
    return largest;
}

/// Smallest distance of beads that no link joins, nm.
double nearest(ChainSpec const& chain) {
    double least = INFINITY;
    std::vector<Vec3> const& x = chain.beads.position;
    for (std::size_t k = 1; k < chain.size(); ++k)
        for (std::size_t j = 0; j < k; ++j)
            if (j != scene::inboard_of(chain.parent, k)) least = std::min(least, norm(x[k] - x[j]));
    return least;
}

class Rna : public SceneFiles {};

TEST_F(Rna, HasTwoBeadsANucleotide) {
    Scene const scene = read(chain("sequence: ACGUr"));
    ChainSpec const& rna = scene.chains.at(0);
    EXPECT_EQ(rna.parent, (Inboard{-1, 0, 0, 2, 2, 4, 4, 6, 6, 8}));
    EXPECT_EQ(rna.beads.residue, (std::vector<std::string>{"RBC", "A", "RBC", "C", "RBC", "G",
                                                           "RBC", "U", "RBC", "RNA"}));
    for (std::size_t k = 0; k < rna.size(); ++k) {
        bool const base = k % 2 == 1;
        EXPECT_EQ(rna.beads.mass[k], base ? 126.3 : 194.1);
        EXPECT_EQ(rna.beads.length[k], k == 0 ? 0 : base ? 0.54 : 0.59);
    }
    EXPECT_LT(largest_gap(rna), 1e-12);
    EXPECT_GT(nearest(rna), 0.58);
    EXPECT_EQ(scene::degrees_of_freedom(rna), 3 * 10 - 9);
    EXPECT_TRUE(scene.notes.empty());
}

TEST_F(Rna, OfOneNucleotideHasNoBranch) {
    ChainSpec const one = read(chain("sequence: G")).chains.at(0);
    EXPECT_EQ(one.size(), 2U);
    EXPECT_FALSE(one.is_branched());
}

/// Smallest distance of beads that no link joins over all chains and images in a box, nm.
double nearest_in_box(Scene const& scene) {
    double least = INFINITY;
    std::vector<ChainSpec> const& chains = scene.chains;
    for (std::size_t c = 0; c < chains.size(); ++c)
        for (std::size_t d = 0; d <= c; ++d)
            for (std::size_t k = 0; k < chains[c].size(); ++k)
                for (std::size_t j = 0; j < (c == d ? k : chains[d].size()); ++j) {
                    if (c == d && j == scene::inboard_of(chains[c].parent, k)) continue;
                    Vec3 apart = chains[c].beads.position[k] - chains[d].beads.position[j];
                    for (int x = 0; x < 3; ++x)
                        apart[x] -= (*scene.box)[x] * std::round(apart[x] / (*scene.box)[x]);
                    least = std::min(least, norm(apart));
                }
    return least;
}

/// Among peptides, in a box that is too full for whole chains side by side, and in a slab.
TEST_F(Rna, IsPackedIntoFullBoxesAndSlabs) {
    std::string const chains =
        "chains: [{name: rna, model: calvados_rna, count: 25, sequence: ACGUACGUACGUACGUACGUACGU}, "
        "{name: peptide, model: calvados2, count: 20, sequence: RGGRGGRGGRGGRGGRGG}]\n";
    Scene const full = read(chains + "box: {periodic: [12, 12, 12]}"),
                slab = read(chains +
                            "box: {periodic: [12, 12, 40]}\nplace: {slab: {axis: z, "
                            "thickness: 12}}");
    for (Scene const& scene : {full, slab}) {
        EXPECT_TRUE(scene.notes.empty()) << scene.notes.front();
        for (ChainSpec const& each : scene.chains) EXPECT_LT(largest_gap(each), 1e-12);
        EXPECT_GE(nearest_in_box(scene), 0.6 - 1e-12);
    }
    for (ChainSpec const& each : slab.chains)
        for (Vec3 const& x : each.beads.position) EXPECT_LE(std::abs(x[2] - 20), 6);
}

TEST_F(Rna, StartsWithoutOverlaps) {
    std::string const copies = chain(
        "count: 2, conformation: self_avoiding, sequence: ACGUACGUACGUACGUACGUACGUACGUACGUACGU");
    Scene const scene = read(copies);
    for (ChainSpec const& each : scene.chains) {
        EXPECT_LT(largest_gap(each), 1e-12);
        EXPECT_GE(nearest(each), 0.6 - 1e-12);
    }
    auto const shape = [&](std::size_t c) {
        std::vector<Vec3> const& x = scene.chains[c].beads.position;
        return norm(x.back() - x.front());
    };
    EXPECT_NE(shape(0), shape(1));
    EXPECT_EQ(read(copies).hash, scene.hash);
}

TEST_F(Rna, HangsOnTheGround) {
    ChainSpec const held = read(chain("sequence: AC, base: fixed, anchor: [1, 2, 3]")).chains.at(0);
    EXPECT_NEAR(norm(held.beads.position[0] - Vec3{{1, 2, 3}}), 0.59, 1e-12);
    EXPECT_LT(largest_gap(held), 1e-12);
}

TEST_F(Rna, StartsAtPositions) {
    write("x.csv", "0,0,0\n0,0,0.53\n0.6,0,0\n0.6,0,0.55\n");
    ChainSpec const placed = read(chain("sequence: AC, positions: x.csv")).chains.at(0);
    EXPECT_LT(largest_gap(placed), 1e-9);
    ChainSpec const as_given =
        read(chain("sequence: AC, positions: x.csv, links: as_given")).chains.at(0);
    EXPECT_NEAR(as_given.beads.length[1], 0.53, 1e-12);
    EXPECT_NEAR(as_given.beads.length[2], 0.6, 1e-12);
    EXPECT_NEAR(as_given.beads.length[3], 0.55, 1e-12);
    EXPECT_EQ(refusal(chain("sequence: ACG, positions: x.csv")),
              "`x.csv` contains 4 positions, the chain has 6 beads (s.yaml: chains[0].positions, "
              "line 1): give one position per bead");
}

TEST_F(Rna, ComesFromFastaInSmallLetters) {
    write("a.fasta", ">one\naugc\n>two\nGGG\n");
    Scene const scene = read(chain("fasta: a.fasta, record: one"));
    EXPECT_EQ(scene.chains[0].beads.residue[3], "U");
    EXPECT_TRUE(has_note(scene, "4 of 4 letters are lower case"));
}

TEST_F(Rna, RefusesWhatIsNoRna) {
    std::string const codes = "use the one-letter codes ACGUr";
    auto const refused = [&](std::string const& keys, std::string const& expected) {
        EXPECT_EQ(refusal(chain(keys)), expected) << keys;
    };
    refused("sequence: ACT",
            "`T` at position 3 of the sequence is not a residue of calvados_rna: thymine of DNA "
            "(s.yaml: chains[0].sequence, line 1): write U for RNA");
    refused("sequence: ACp",
            "`p` at position 3 of the sequence is not a residue of calvados_rna (s.yaml: "
            "chains[0].sequence, line 1): " +
                codes);
    refused("sequence: ACG, charge_termini: both",
            "key `charge_termini` does not apply to a chain of nucleotides, whose ends are as its "
            "other nucleotides (s.yaml: chains[0].charge_termini, line 1): leave it out");
    refused("sequence: ACG, rigid: [[1, 3]]",
            "rigid domains in a chain of nucleotides, whose model is of disordered RNA (s.yaml: "
            "chains[0].rigid, line 1): leave `rigid` out, or import the CALVADOS package's System "
            "of a structured RNA");
    refused("pdb: a.pdb",
            "RNA from a structure file (s.yaml: chains[0].pdb, line 1): give its `sequence`, and "
            "its beads' places by `positions` (a table x,y,z with backbone and base by turns)");
    refused("sequence: ACG, tip: ring",
            "a tip that is not free on a branched chain (s.yaml: chains[0].tip, line 1): leave "
            "`tip` out: branched chains have neither rings nor links to the ground but at bead 1");
    EXPECT_EQ(refusal("units: si\n" + chain("sequence: ACG")),
              "model calvados_rna in SI units (s.yaml: chains[0], line 2): write `units: md`: its "
              "parameters are in nm, amu and kJ/mol");
}

/// Proteins may have either builder, RNA was fitted beside one.
TEST_F(Rna, StandsBesideProteins) {
    auto const beside = [](std::string const& builder) {
        return "chains:\n  - {sequence: GKG, model: " + builder +
               "}\n  - {sequence: ACG, model: calvados_rna}\nforces: {openmm: {builder: " +
               builder + "}}\n";
    };
    Scene const two = read(beside("calvados2"));
    EXPECT_TRUE(two.chains[1].is_branched());
    EXPECT_FALSE(has_note(two, "RNA was fitted"));
    EXPECT_TRUE(has_note(read(beside("calvados3")),
                         "RNA was fitted beside CALVADOS 2, the forces have builder calvados3"));
    EXPECT_EQ(refusal(chain("sequence: ACG") + "\nforces: {openmm: {builder: calvados_rna}}"),
              "`calvados_rna` is a model of chains, not a builder (s.yaml: "
              "forces.openmm.builder, line 2): write `builder: calvados2`, which has the forces of "
              "RNA, too");
}

/// The forces of charges end at 4 nm. Without salt they would reach further.
TEST_F(Rna, IsNotedInWaterWithoutSalt) {
    auto const at = [&](std::string const& chains, std::string const& salt) {
        return read(chains + "\nforces: {openmm: {builder: calvados2, ionic_strength: " + salt +
                    "}}");
    };
    std::string const rna = chain("sequence: ACGU"), end = "forces between charges end at 4 nm",
                      key = "forces.openmm.ionic_strength is ",
                      neutral = "chains: [{sequence: GSG, model: calvados2, charge_termini: none}]";
    EXPECT_TRUE(has_note(at(rna, "0"), key + "0 mol/l: nothing screens charges, and " + end));
    EXPECT_TRUE(has_note(at(rna, "0.005"), key + "0.005 mol/l: the Debye length is 4."));
    EXPECT_FALSE(has_note(at(rna, "0.01"), end));
    EXPECT_FALSE(has_note(at(neutral, "0"), end));
}

/// Other tables must not have other parameters for the same names.
TEST_F(Rna, RefusesOtherParametersInTheTableOfAnotherChain) {
    write("t.csv", "one,three,MW,lambdas,sigmas,q,bondlength\nr,RNA,126.3,0.5,0.6238,0,0.54\n");
    std::string const both =
        "chains:\n  - {sequence: rrr, model: {residues: t.csv}}\n  - {sequence: rrr, model: "
        "calvados_rna}\nforces: {openmm: {builder: calvados2}}\n";
    EXPECT_EQ(refusal(both),
              "residue RNA of calvados_rna has other parameters in t.csv, the table of another "
              "chain, or is not in it (s.yaml: chains[1], bead 2, line 3): take one table for both "
              "chains");
    Scene const alone = read(
        "chains: [{name: a, sequence: rrr, model: {residues: t.csv}}]\nforces: {openmm: "
        "{builder: calvados2}}\n");
    EXPECT_FALSE(alone.chains[0].is_branched());
    EXPECT_TRUE(has_note(alone, "chain `a` has a bead for each letter in a row"));
}

}  // namespace
}  // namespace catena::test
