// Scenes with rigid bodies across chains.
#include <fmt/format.h>

#include "structure/calvados2.hpp"
#include "structure/member_names.hpp"
#include "tests/domains/helix.hpp"
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

using Words = std::vector<std::string>;

class Complexes : public SceneFiles {
  protected:
    Complexes() { write("a.pdb", pdb_text(helix(12, "A") + helix(10, "B", 1, 12))); }
    static std::string scene_of(std::string const& rigid, std::string const& more = "") {
        return "chains: [{pdb: a.pdb, model: calvados2, chain: all, rigid: " + rigid + more + "}]";
    }
    static std::string const builder_;
};

std::string const Complexes::builder_ =
    "\nforces: {openmm: {builder: calvados2}}\ndynamics: {integrator: g-baoab, step: 0.01, "
    "temperature: 300}";

TEST_F(Complexes, are_one_chain_whose_body_carries_beads_of_both) {
    Scene const s = read(scene_of("[[\"A:5-12\", \"B:1-6\"]]"));
    ASSERT_EQ(s.chains.size(), 1u);
    EXPECT_EQ(s.chains[0].name, "A+B");
    LinkedArrays const& l = s.chains[0].linked;
    EXPECT_EQ(l.carried.offset, (std::vector<std::int64_t>{0, 1, 2, 3, 4, 18, 19, 20, 21, 22}));
    EXPECT_EQ(
        notes_of(s),
        Words{"chains A and B share a rigid body and are simulated as one chain, `A+B`, whose "
              "22 beads have the order of residues A 1 to 12, B 1 to 10"});
    // The body has the mass of its beads, and both inner ends are termini.
    double const gly = find_calvados2('G')->mass;
    EXPECT_NEAR(l.mass[4], 14 * gly + 2 + 16, 1e-9);
    EXPECT_NEAR(l.mass[0], gly + 2, 1e-9);
    EXPECT_NEAR(l.mass[8], gly + 16, 1e-9);
    // Links join the chains where they leave the body.
    auto const from = [&](std::size_t body, std::size_t bead) {
        return l.carried.position[static_cast<std::size_t>(l.carried.offset[body]) + bead];
    };
    EXPECT_NEAR(norm(l.inboard[4] - from(4, 0)), 0, 1e-12);
    EXPECT_NEAR(norm(l.outboard[4] - from(4, 13)), 0, 1e-12);
    for (std::size_t k = 1; k < l.size(); ++k) EXPECT_NEAR(l.length[k], 0.38, 1e-9) << k;
}

TEST_F(Complexes, keep_all_distances_of_the_structure) {
    Scene const apart =
        read("chains: [{pdb: a.pdb, model: calvados2, chain: all, links: as_given}]");
    LinkedArrays const l = read(scene_of("[[\"A:5-12\", \"B:1-6\"]]")).chains.at(0).linked;
    std::vector<Vec3> expected(apart.chains[0].beads.position.begin() + 4,
                               apart.chains[0].beads.position.end());
    expected.insert(expected.end(), apart.chains[1].beads.position.begin(),
                    apart.chains[1].beads.position.begin() + 6);
    ASSERT_EQ(expected.size(), 14u);
    for (std::size_t i = 0; i < expected.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_NEAR(norm(l.carried.position[4 + i] - l.carried.position[4 + j]),
                        norm(expected[i] - expected[j]), 1e-12);
}

TEST_F(Complexes, have_the_charges_of_all_termini) {
    auto const map = read(scene_of("[[\"A:5-12\", \"B:1-6\"]]") + builder_).forces.openmm->map;
    calvados2::ChainEnds const ends([&] {
        OpenMmSpec spec;
        spec.builder = "calvados2";
        spec.map = map;
        return spec;
    }());
    EXPECT_EQ(ends.of("A+B"), (calvados2::ChargedTermini{false, false}));
    std::vector<std::pair<std::int64_t, bool>> found;
    for (auto const& [bead, charged] : ends.inside("A+B")) {
        EXPECT_NE(charged.n, charged.c);
        found.emplace_back(bead, charged.n);
    }
    EXPECT_EQ(found, (std::vector<std::pair<std::int64_t, bool>>{
                         {0, true}, {11, false}, {12, true}, {21, false}}));
    auto const none =
        read(scene_of("[[\"A:5-12\", \"B:1-6\"]]", ", charge_termini: none") + builder_);
    for (auto const& entry : none.forces.openmm->map) EXPECT_LT(entry.second.first, 2);
}

/// The serial chain of 22 beads begins in A and ends in B, whose residues are no amino acids.
TEST_F(Complexes, charge_the_termini_of_each_member_by_its_own_ends) {
    std::vector<AtomLine> other = helix(10, "B", 1, 12);
    for (AtomLine& atom : other) atom.residue = "PEG";
    write("a.pdb", pdb_text(helix(12, "A") + other));
    write("t.csv",
          "one,three,MW,lambdas,sigmas,q,bondlength\nG,GLY,57.05,0.7,0.45,0,0.38\n"
          "J,PEG,44.05,0.2,0.4,0,0.38\n");
    auto const scene = [&](std::string const& more) {
        return read(
            "chains: [{pdb: a.pdb, model: {residues: t.csv}, chain: all, rigid: "
            "[[\"A:5-12\", \"B:1-6\"]]" +
            more + "}]" + builder_);
    };
    auto const charged = [](Scene const& s) {
        std::vector<std::pair<std::int64_t, bool>> found;
        calvados2::ChainEnds const all(*s.forces.openmm);
        for (auto const& [bead, ends] : all.inside("A+B")) found.emplace_back(bead, ends.n);
        return found;
    };
    using Ends = std::vector<std::pair<std::int64_t, bool>>;
    Scene const s = scene("");
    EXPECT_EQ(charged(s), (Ends{{0, true}, {11, false}}));
    EXPECT_NEAR(s.chains[0].linked.mass[0], 57.05 + 2, 1e-9);
    EXPECT_NEAR(s.chains[0].linked.mass[8], 44.05, 1e-9);
    EXPECT_EQ(notes_of(s).back(),
              "chain `A+B`: each of PEG at bead 13 and PEG at bead 22 is not an amino acid and "
              "carries no charge of a terminus: write `charge_termini: none` or `both`");
    EXPECT_EQ(charged(scene(", charge_termini: both")),
              (Ends{{0, true}, {11, false}, {12, true}, {21, false}}));
}

/// The start's changes name the chain as the scene does.
TEST_F(Complexes, have_one_name_in_all_lines) {
    write("a.pdb", pdb_text(helix(12, "A") + helix(10, "B", 1, 12.2)));
    Scene const s = read(scene_of("[[\"A:5-12\", \"B:1-6\"]]"));
    EXPECT_EQ(s.start.link_at.substr(0, 12), "chain `A+B`,") << s.start.link_at;
}

TEST_F(Complexes, may_run_backwards_along_a_chain) {
    Scene const s = read(scene_of("[[\"A:5-12\", \"B:4-10\"]]", ", name: pair"));
    EXPECT_EQ(s.chains.at(0).name, "pair");
    EXPECT_EQ(
        notes_of(s),
        Words{"chains A and B share a rigid body and are simulated as one chain, `pair`, whose "
              "22 beads have the order of residues A 1 to 12, B 5 to 10, B 4 down to 1"});
}

TEST_F(Complexes, have_copies) {
    Scene const s = read(scene_of("[[\"A:5-12\", \"B:1-6\"]]", ", count: 3, name: pair"));
    ASSERT_EQ(s.chains.size(), 3u);
    EXPECT_EQ(s.chains[2].name, "pair-3");
    EXPECT_EQ(s.chains[2].bead_count(), 22u);
}

TEST_F(Complexes, of_rigid_partners_alone_are_one_body) {
    Scene const s = read(scene_of("[[\"A:1-12\", \"B:1-10\"]]"));
    ASSERT_EQ(s.chains.size(), 1u);
    EXPECT_EQ(s.chains[0].linked.size(), 1u);
}

TEST_F(Complexes, that_no_serial_chain_can_hold_are_refused) {
    std::string const at = " (s.yaml: chains[0].rigid[0], line 1): ";
    EXPECT_EQ(
        refusal(scene_of("[[\"A:5-8\", \"B:3-10\"]]")),
        "3 flexible parts would hang on the rigid body of residues 5 to 8 of chain A and "
        "residues 3 to 10 of chain B, and a serial chain has two: residues 1 to 4 of chain A, "
        "residues 9 to 12 of chain A, residues 1 to 2 of chain B" +
            at +
            "include flexible ends in the body's ranges until two are left, or give each "
            "chain bodies of its own");
    EXPECT_EQ(
        refusal(scene_of("[[\"A:1-4\", \"A:8-12\"], [\"B:1-6\"]]")),
        "residues 5 to 7 of chain A would be a flexible loop between two parts of one rigid "
        "body, which a serial chain cannot hold" +
            at +
            "write \"A:1-12\" to make the loop rigid, too (with `domains` or `pae`: "
            "`longest_loop: 3`), or make two bodies of the parts: rigid: [\"A:1-4\", \"A:8-12\"]");
    EXPECT_EQ(refusal(scene_of("[\"A:5-8\", [\"A:8-12\", \"B:1-6\"]]")),
              "residues 8 to 12 of chain A overlap the domain 5 to 8 of chain A (s.yaml: "
              "chains[0].rigid[1], line 1): assign each residue to one domain");
    EXPECT_EQ(refusal(scene_of("[[\"A:5-12\", \"B:1-6\"]]", ", base: fixed")),
              "key `base` for chains that share a rigid body (s.yaml: chains[0].base, line 1): "
              "leave it out");
}

/// A domain with a gap in the file is one body of two pieces of the chain.
TEST_F(Complexes, join_the_pieces_of_a_chain_with_a_gap) {
    write("a.pdb", pdb_text(helix(12, "A") + helix(10, "A", 20, 0, 32)));
    std::string const start =
        "chains: [{pdb: a.pdb, model: calvados2, gaps: split, name: p, rigid: ";
    Scene const s = read(start + "[[\"A:5-12\", \"A:20-25\"]]}]");
    ASSERT_EQ(s.chains.size(), 1u);
    EXPECT_EQ(s.chains[0].name, "p");
    EXPECT_EQ(s.chains[0].linked.size(), 9u);
    EXPECT_EQ(notes_of(s).back(),
              "pieces of chain A share a rigid body and are simulated as one chain, `p`, whose 22 "
              "beads have the order of residues A 1 to 12, A 20 to 29");
    // Ends at the gap are no termini.
    EXPECT_NEAR(s.chains[0].linked.mass[4], 14 * find_calvados2('G')->mass, 1e-9);
    EXPECT_EQ(refusal(start + "[\"A:5-25\"]}]"),
              "residues 5 to 25 of chain A do not lie in one chain (s.yaml: chains[0].rigid[0], "
              "line 1): end the domain where its chain ends; for one body of both parts write a "
              "list of ranges, [\"5-12\", ...]");
}

TEST_F(Complexes, ranges_of_one_chain_that_touch_are_one) {
    Scene const s = read(scene_of("[[\"A:2-5\", [6, 10], \"A:11-11\"]]", "")
                             .replace(scene_of("").find("chain: all"), 10, "chain: A"));
    EXPECT_EQ(s.chains.at(0).linked.size(), 3u);
    EXPECT_EQ(s.chains.at(0).linked.carried.offset, (std::vector<std::int64_t>{0, 1, 11, 12}));
}

/// Members of a chain as text: identifier, first bead, first and last number, insertion codes.
std::string text_of(Members const& members) {
    std::string text;
    for (ResidueRun const& run : members.runs)
        text += fmt::format("{}{} {} {}-{}{}", text.empty() ? "" : ", ",
                            members.identifiers[run.member], run.first, run.number,
                            run.number + run.step * (run.count - 1),
                            run.insertion == ' ' ? "" : std::string(1, run.insertion));
    return text;
}

TEST_F(Complexes, name_their_members_as_the_file) {
    write("a.pdb", pdb_text(helix(12, "A", 5) + helix(10, "B", -2, 12)));
    Scene const s = read(scene_of("[[\"A:9-16\", \"B:-2-3\"]]"));
    ASSERT_EQ(s.chains.size(), 1u);
    EXPECT_EQ(text_of(s.chains[0].members), "A 0 5-16, B 12 -2-7");
}

TEST_F(Complexes, name_residues_in_the_order_of_their_beads) {
    // Both tails are C-terminal: the path begins at the end of A.
    Scene const s = read(scene_of("[[\"A:1-8\", \"B:1-6\"]]"));
    ASSERT_EQ(s.chains.size(), 1u);
    EXPECT_EQ(text_of(s.chains[0].members), "A 0 12-8, A 5 1-7, B 12 1-10");
    EXPECT_EQ(s.chains[0].members.runs[0].place, 11);
    EXPECT_EQ(s.chains[0].members.runs[0].step, -1);
}

TEST_F(Complexes, of_pieces_of_one_chain_are_one_member_with_a_gap) {
    write("a.pdb", pdb_text(helix(6, "A") + helix(6, "A", 11, 0, 15)));
    Scene const s = read(
        "chains: [{pdb: a.pdb, model: calvados2, gaps: split, rigid: [[\"A:1-6\", \"A:11-16\"]]}]");
    ASSERT_EQ(s.chains.size(), 1u);
    EXPECT_EQ(text_of(s.chains[0].members), "A 0 1-6, A 6 11-16");
    EXPECT_EQ(s.chains[0].members.runs[1].place, 7);
}

TEST_F(Complexes, and_single_chains_keep_the_numbers_of_the_file) {
    Scene const s = read("chains: [{pdb: a.pdb, model: calvados2, chain: all}]");
    ASSERT_EQ(s.chains.size(), 2u);
    EXPECT_EQ(text_of(s.chains[0].members), "A 0 1-12");
    EXPECT_EQ(text_of(s.chains[1].members), "B 0 1-10");
    EXPECT_TRUE(read("chains: [{sequence: GGG, model: calvados2}]").chains[0].members.empty());
}

TEST_F(Complexes, number_residues_from_1_where_numbers_repeat) {
    scene::PdbSites one{"a.pdb", {}};
    for (std::int64_t const number : {7, 8, 8}) {
        scene::PdbSite site;
        site.number = number;
        site.label = std::to_string(number);
        one.sites.push_back(site);
    }
    one.chains = {{"C", "C", 0, 3}};
    EXPECT_EQ(text_of(scene::members_of(one)), "C 0 1-3");
    one.sites[2].label = "8A";
    EXPECT_EQ(text_of(scene::members_of(one)), "C 0 7-8, C 2 8-8A");
}

}  // namespace
}  // namespace catena::test
