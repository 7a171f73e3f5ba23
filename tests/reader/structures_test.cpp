// Chains, gaps, sites and domains of structures.
#include <algorithm>
#include <cmath>

#include "tests/reader/scene_files.hpp"
#include "tests/reader/structure_text.hpp"
#include "tests/support/same_bits.hpp"

namespace catena::test {
namespace {

using Words = std::vector<std::string>;

class Structures : public SceneFiles {
  protected:
    /// Reads a.pdb with further keys of the chain.
    Scene with(std::string const& keys, std::string const& rest = "") const {
        return read(scene_of(keys) + rest);
    }
    std::string refusal_with(std::string const& keys) const { return refusal(scene_of(keys)); }
    static std::string scene_of(std::string const& keys) {
        return "chains: [{pdb: a.pdb, model: calvados2" + (keys.empty() ? "" : ", " + keys) + "}]";
    }
    static Words names_of(Scene const& scene) {
        Words names;
        for (ChainSpec const& chain : scene.chains) names.push_back(chain.name);
        return names;
    }
    static std::vector<std::size_t> sizes_of(Scene const& scene) {
        std::vector<std::size_t> sizes;
        for (ChainSpec const& chain : scene.chains) sizes.push_back(chain.bead_count());
        return sizes;
    }

    std::string const at_ = " (s.yaml: chains[0].pdb, line 1): ";
    Words const gas_ = {"GLY", "ALA", "SER"};
};

TEST_F(Structures, one_chain_is_chosen_and_the_others_are_not_looked_at) {
    write("a.pdb", pdb_text(strand(gas_, "A", 1, 0) + strand({"XYZ", "XYZ"}, "B", 1, 0, 20)));
    EXPECT_EQ(refusal_with(""), "`a.pdb` holds 2 chains: A (residues 1 to 3), B (residues 1 to 2)" +
                                    at_ + "choose one, such as `chain: A`, or write `chain: all`");
    Scene const s = with("chain: A");
    EXPECT_EQ(names_of(s), Words{"chain-1"});
    EXPECT_EQ(s.chains.at(0).beads.residue, gas_);
    EXPECT_EQ(refusal_with("chain: Q"), "`a.pdb` holds no chain Q" + at_ + "take one of A, B");
}

TEST_F(Structures, cross_links_count_beads_and_name_residues_of_other_numbers) {
    auto const noted = [&](int first) {
        write("a.pdb", pdb_text(strand({"CYS", "GLY", "ALA", "SER", "CYS"}, "A", first, 0)));
        for (std::string const& note : with("crosslinks: [[1, 5]]").notes)
            if (note.find("`crosslinks` count") != std::string::npos) return note;
        return std::string();
    };
    EXPECT_EQ(noted(1), "");
    EXPECT_EQ(noted(11),
              "`crosslinks` count the beads of chain `chain-1` from 1, not by the residue numbers "
              "of `a.pdb`: they join CYS 11 to CYS 15");
    EXPECT_NE(refusal_with("crosslinks: [[11, 15]]").find("a cross-link ends at bead 11 of 5"),
              std::string::npos);
}

TEST_F(Structures, several_chains_of_a_file_bear_its_names) {
    std::vector<AtomLine> atoms = strand(gas_, "A", 1, 0) + strand(gas_, "B", 1, 0, 20);
    atoms.back().ends_chain = true;
    write("a.pdb", pdb_text(atoms + strand(gas_, "B", 1, 0, 40)));
    EXPECT_EQ(names_of(with("chain: all")), (Words{"A", "B", "B-2"}));
    EXPECT_EQ(names_of(with("chain: all, name: p")), (Words{"p-A", "p-B", "p-B-2"}));
    EXPECT_EQ(names_of(with("chain: [B]")), (Words{"B", "B-2"}));
    EXPECT_EQ(refusal_with("chain: B"),
              "2 chains of `a.pdb` are named B: B (residues 1 to 3), B (residues 1 to 3)" + at_ +
                  "give each chain a letter of its own, or write `chain: all`");
    EXPECT_EQ(refusal_with("chain: all, count: 2"),
              "key `count` for 3 chains of one structure (s.yaml: chains[0].count, line 1): leave "
              "it out, or give each chain its own entry with `chain`");
}

TEST_F(Structures, a_model_is_chosen_by_its_number) {
    std::vector<AtomLine> second = strand(gas_, "A", 1, 5);
    for (AtomLine& atom : second) atom.model = 2;
    write("a.pdb", pdb_text(strand(gas_, "A", 1, 0) + second));
    EXPECT_DOUBLE_EQ(with("").chains.at(0).beads.position[0][0], 0);
    Scene const s = with("conformer: 2");
    EXPECT_DOUBLE_EQ(s.chains.at(0).beads.position[0][0], 0.5);
    EXPECT_TRUE(s.notes.empty());
    EXPECT_EQ(refusal_with("conformer: 3"),
              "`a.pdb` holds no model 3" + at_ + "its 2 models are 1 to 2");
}

TEST_F(Structures, a_chain_is_split_at_its_gaps) {
    write("a.pdb", pdb_text(strand(gas_, "A", 1, 0) + strand(gas_, "A", 6, 15)));
    EXPECT_EQ(refusal_with(""),
              "residues SER 3 and GLY 6 of `a.pdb` stand 0.740 nm apart: the chain has a gap" +
                  at_ +
                  "write `gaps: split` for two chains, `gaps: model` to grow what is missing, or "
                  "`links: as_given` to keep the distance");
    Scene const s = with("gaps: split, name: p",
                         "\nforces: {openmm: {builder: calvados2}}\ndynamics: {integrator: "
                         "g-baoab, step: 0.01, temperature: 300}");
    EXPECT_EQ(names_of(s), (Words{"p-1", "p-2"}));
    EXPECT_EQ(sizes_of(s), (std::vector<std::size_t>{3, 3}));
    Words const notes = notes_of(s);
    EXPECT_EQ(std::count(notes.begin(), notes.end(),
                         "`a.pdb`: the chain is split at 1 gap (first: residues SER 3 and GLY 6, "
                         "0.740 nm apart), whose ends bear no charges of termini"),
              1);
    // Only the ends of the whole chain have the mass and charge of a terminus.
    double const gly = 57.05, ser = 87.08;
    EXPECT_NEAR(s.chains[0].beads.mass[0], gly + 2, 0.01);
    EXPECT_NEAR(s.chains[0].beads.mass[2], ser, 0.01);
    EXPECT_NEAR(s.chains[1].beads.mass[0], gly, 0.01);
    EXPECT_NEAR(s.chains[1].beads.mass[2], ser + 16, 0.01);
    using Ends = std::pair<std::string, std::pair<std::int64_t, std::int64_t>>;
    auto const& map = s.forces.openmm->map;
    EXPECT_EQ(std::count(map.begin(), map.end(), Ends{"p-1", {1, 0}}), 1);
    EXPECT_EQ(std::count(map.begin(), map.end(), Ends{"p-2", {0, 1}}), 1);
}

std::string const seqres = "SEQRES   1 A    8  GLY ALA SER LYS GLU GLY ALA SER\n";

TEST_F(Structures, missing_residues_grow_as_a_self_avoiding_linker) {
    write("a.pdb", seqres + pdb_text(strand(gas_, "A", 11, 0) + strand(gas_, "A", 16, 15)));
    Scene const s = with("gaps: model, name: p");
    EXPECT_EQ(names_of(s), Words{"p"});
    BeadArrays const& beads = s.chains.at(0).beads;
    EXPECT_EQ(beads.residue, (Words{"GLY", "ALA", "SER", "LYS", "GLU", "GLY", "ALA", "SER"}));
    EXPECT_EQ(notes_of(s).at(0),
              "`a.pdb`: 2 residues missing between SER 13 and GLY 16 are grown as a self-avoiding "
              "linker (LYS GLU)");
    for (std::size_t a = 0; a < beads.size(); ++a)
        for (std::size_t b = 0; b < a; ++b) {
            double const apart = norm(beads.position[a] - beads.position[b]);
            if (a == b + 1)
                EXPECT_NEAR(apart, 0.38, 1e-9) << a;
            else
                EXPECT_GE(apart, 0.5599) << a << " " << b;
        }
    // The known residues keep their places, but for the last decimal of the links.
    EXPECT_NEAR(beads.position[5][0], 1.5, 1e-9);
    EXPECT_TRUE(
        test::same_bits(beads.position, with("gaps: model, name: p").chains[0].beads.position));
}

TEST_F(Structures, linkers_that_cannot_be_modelled) {
    std::string const gap =
        "the gap between residues SER 3 and GLY 6 of `a.pdb` cannot be modelled: ";
    auto const refused = [&](std::string const& sequence, double x) {
        write("a.pdb", sequence + pdb_text(strand(gas_, "A", 1, 0) + strand(gas_, "A", 6, x)));
        return refusal_with("gaps: model");
    };
    EXPECT_EQ(refused("", 15), gap + "the file lists no sequence of the chain" + at_ +
                                   "add its SEQRES records or `_entity_poly_seq`, or write "
                                   "`gaps: split`");
    EXPECT_EQ(refused(seqres, 30),
              gap + "2 missing residues reach 1.140 nm at most, and the ends stand 2.240 nm apart" +
                  at_ + "correct the file, or write `gaps: split`");
    EXPECT_EQ(refused("SEQRES   1 A    8  GLY ALA SER LYS GLU GLY GLY SER\n", 15),
              gap + "the residues and their numbers do not fit the file's sequence" + at_ +
                  "correct SEQRES or the numbers, or write `gaps: split`");
    EXPECT_EQ(refused("SEQRES   1 A    8  GLY ALA SER LYS GLU GLY ALA SER GLY\n"
                      "SEQRES   2 A    8  ALA SER LYS LYS GLY ALA SER\n",
                      15),
              gap + "the residues fit several places of the file's sequence" + at_ +
                  "give the file as mmCIF with `label_seq_id`, or write `gaps: split`");
}

TEST_F(Structures, residues_that_are_too_close_are_no_gap) {
    write("a.pdb", pdb_text(strand(gas_, "A", 1, 0) + strand(gas_, "A", 6, 8)));
    for (char const* const rule : {"gaps: split", "gaps: model"})
        EXPECT_NE(refusal_with(rule).find("nearer than neighbours can"), std::string::npos) << rule;
}

/// A glycine of N, CA and C with known masses.
TEST_F(Structures, beads_may_stand_at_centres_of_mass) {
    std::vector<AtomLine> atoms;
    for (int k = 0; k < 3; ++k) {
        double const x = 3.8 * k;
        atoms = atoms + std::vector<AtomLine>{{"N", "GLY", "A", k + 1, x - 1, 1, 0},
                                              {"CA", "GLY", "A", k + 1, x, 0, 0},
                                              {"C", "GLY", "A", k + 1, x + 1, 1, 0}};
        atoms[atoms.size() - 3].element = "N";
    }
    write("a.pdb", pdb_text(atoms));
    double const n = 14.007, c = 12.011, x = 0.1 * (c - n) / (n + 2 * c),
                 y = 0.1 * (c + n) / (n + 2 * c);
    std::vector<Vec3> const beads = with("sites: com, links: as_given").chains[0].beads.position;
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(beads[static_cast<std::size_t>(k)][0], 0.38 * k + x, 1e-12);
        EXPECT_NEAR(beads[static_cast<std::size_t>(k)][1], y, 1e-12);
    }
    EXPECT_NEAR(with("sites: ca, links: as_given").chains[0].beads.position[1][0], 0.38, 1e-12);
    atoms[0].element = "U";
    write("a.pdb", pdb_text(atoms));
    EXPECT_EQ(refusal_with("sites: com"),
              "atom N of residue GLY 1 of chain A of `a.pdb` has no known mass (line 1)" + at_ +
                  "give its element, or write `sites: ca`");
}

/// The CALVADOS package gives bonds of a domain's residues, and those to their neighbours, the
/// distances of the structure.
TEST_F(Structures, links_at_domains_keep_the_distances_of_centres_of_mass) {
    std::vector<AtomLine> atoms;
    for (int k = 0; k < 7; ++k) {
        double const x = 3.8 * k, side = k % 2 == 0 ? 4.0 : -4.0;
        atoms = atoms + std::vector<AtomLine>{{"CA", "GLY", "A", k + 1, x, 0, 0},
                                              {"CB", "GLY", "A", k + 1, x, 0.3 * side, side}};
    }
    write("a.pdb", pdb_text(atoms));
    LinkedArrays const com = with("sites: com, rigid: [[3, 5]]").chains.at(0).linked;
    double const apart = 0.1 * std::sqrt(3.8 * 3.8 + 4 * 4 * (1 + 0.09));
    EXPECT_NEAR(com.length[1], 0.38, 1e-12);
    EXPECT_NEAR(com.length[2], apart, 1e-12);
    EXPECT_NEAR(com.length[3], apart, 1e-12);
    EXPECT_NEAR(com.length[4], 0.38, 1e-12);
    LinkedArrays const given =
        with("sites: com, rigid: [[3, 5]], links: as_given").chains.at(0).linked;
    EXPECT_NEAR(given.length[1], apart, 1e-12);
}

TEST_F(Structures, domains_by_chain_and_residue_number) {
    auto const bent = [](std::string const& chain, int number, double y) {
        std::vector<AtomLine> atoms = strand(Words(6, "GLY"), chain, number, 0, y);
        for (std::size_t k = 0; k < atoms.size(); k += 2) {
            atoms[k].x *= 0.8;
            atoms[k].z = 2.28;  // 3.8 = |(3.04, 0, 2.28)|
        }
        for (std::size_t k = 1; k < atoms.size(); k += 2) atoms[k].x *= 0.8;
        return atoms;
    };
    write("a.pdb", pdb_text(bent("A", -2, 0) + bent("B", 1, 20)));
    Scene const s = with("chain: all, rigid: [\"B:2-5\", \"A:-1-2\"]");
    ASSERT_EQ(s.chains.size(), 2u);
    EXPECT_TRUE(s.notes.empty());
    for (ChainSpec const& chain : s.chains) {
        EXPECT_EQ(chain.linked.size(), 3u);  // bead, domain of four, bead
        EXPECT_EQ(chain.bead_count(), 6u);
    }
    std::string const at = " (s.yaml: chains[0].rigid[0], line 1): ";
    EXPECT_EQ(refusal_with("chain: all, rigid: [\"B:1-7\"]"),
              "residue 7 of chain B is not in the file" + at +
                  "write \"CHAIN:FIRST-LAST\" within \"B:1-6\"");
    EXPECT_EQ(
        refusal_with("chain: all, rigid: [[1, 3]]"),
        "2 residues of the file have the number 1" + at + "name the chain, such as \"A:1-...\"");
    EXPECT_EQ(refusal_with("chain: A, rigid: [\"A:\"]"),
              "`A:` in quotes is not a range of residues" + at +
                  "write CHAIN:FIRST-LAST, such as \"A:1-95\", or [1, 95]");
}

/// Each wrong range gets its own cause; blanks do not count.
TEST_F(Structures, wrong_ranges_of_residues_are_told_apart) {
    Words const six{"GLY", "ALA", "SER", "GLY", "ALA", "SER"};
    write("a.pdb", pdb_text(strand(six, "A", 1, 0) + strand(six, "B", 1, 0, 20)));
    std::string const at = " (s.yaml: chains[0].rigid[0], line 1): ";
    auto const all = [&](std::string const& range) {
        return refusal_with("chain: all, rigid: [" + range + "]");
    };
    EXPECT_EQ(all("\"C:1-3\""), "the file has no chain C" + at + "take one of A, B");
    EXPECT_EQ(refusal_with("chain: A, rigid: [\"B:1-3\"]"),
              "the entry does not choose chain B" + at +
                  "name it under `chain`, as in `chain: [A, B]`, or use residues of A");
    EXPECT_EQ(refusal_with("chain: A, rigid: [\"C:1-3\"]"),
              "the file has no chain C" + at + "take one of A, B");
    EXPECT_EQ(all("\"A:5-2\""),
              "residues 5 to 2 of chain A run backwards" + at + "write \"A:2-5\"");
    EXPECT_EQ(refusal_with("chain: A, rigid: [[5, 2]]"),
              "residues 5 to 2 run backwards" + at + "write [2, 5]");
    EXPECT_EQ(all("\"A:1-3-5\""), "`A:1-3-5` in quotes is not a range of residues" + at +
                                      "write \"CHAIN:FIRST-LAST\" within \"A:1-6\", \"B:1-6\"");
    EXPECT_EQ(all("\"A1-3\""),
              "`A1-3` in quotes has no colon after the chain" + at + "did you mean \"A:1-3\"?");
    for (std::string const range : {"A 1-3", "A;1-3", "A.1-3", "A - 1-3"})
        EXPECT_EQ(all("\"" + range + "\"").find("`" + range + "` in quotes"), 0U) << range;
    EXPECT_EQ(all("\"A 1-3\""),
              "`A 1-3` in quotes has no colon after the chain" + at + "did you mean \"A:1-3\"?");
    EXPECT_EQ(all("\"A;1-3\""),
              "`A;1-3` in quotes has no colon after the chain" + at + "did you mean \"A:1-3\"?");
    // A chain's name that is a number could be the first digit of a residue.
    write("a.pdb", pdb_text(strand(six, "1", 21, 0)));
    EXPECT_EQ(all("\"21 - 24\"").find("the beads of residues 21 to 24 lie on one line"), 0U);
    EXPECT_EQ(all("\"11-23\"").find("residue 11 is not in the file"), 0U);
    EXPECT_EQ(all("\"1 21-24\"").find("`1 21-24` in quotes has no colon after the chain"), 0U);
}

/// YAML makes a map of a range without quotes and with a blank.
TEST_F(Structures, ranges_in_another_form_are_told_what_was_meant) {
    Words const six{"GLY", "ALA", "SER", "GLY", "ALA", "SER"};
    write("a.pdb", pdb_text(strand(six, "A", 1, 0) + strand(six, "B", 1, 0, 20)));
    std::string const at = " (s.yaml: chains[0].rigid[0], line 1): ",
                      map = "YAML makes a map of `A: 1-3`, which is not a range of residues";
    auto const all = [&](std::string const& rigid) {
        return refusal_with("chain: all, rigid: " + rigid);
    };
    EXPECT_EQ(all("[A: 1-3]"), map + at + "write [\"A:1-3\"], in quotes and without a blank");
    EXPECT_EQ(all("{A: 1-3, B: 2-5}"),
              map +
                  " (s.yaml: chains[0].rigid, line 1): write [\"A:1-3\", \"B:2-5\"], in quotes and "
                  "without a blank");
    EXPECT_EQ(all("[[A: 1-3, B: 2-5]]").find(map), 0U);
    EXPECT_EQ(all("[{first: 1, last: 3}]"), "a map is not a range of residues" + at +
                                                "write ranges in quotes, such as \"A:1-95\"");
    for (std::string const two : {"A:1-3, A:4-6", "A:1-3;A:4-6", "A:1-3 A:4-6"})
        EXPECT_EQ(all("[\"" + two + "\"]"),
                  "`" + two + "` in quotes holds 2 ranges" + at +
                      "write each in quotes of its own: \"A:1-3\", \"A:4-6\"; rigid: [[\"A:1-3\", "
                      "\"A:4-6\"]] makes one body of them");
    EXPECT_EQ(all("[\"A:1\u20133\"]"),
              "`A:1\u20133` in quotes has a dash that is no hyphen" + at + "write \"A:1-3\"");
    for (char const* const blank : {"A:\u00a01-3", "A:1-\u00a03"})
        EXPECT_EQ(all("[\"" + std::string(blank) + "\"]"),
                  "`" + std::string(blank) + "` in quotes has a non-breaking space" + at +
                      "write \"A:1-3\"");
    EXPECT_EQ(all("[[1, null]]"),
              "an end of the range is missing (s.yaml: chains[0].rigid[0][1], line 1): write "
              "\"CHAIN:FIRST-LAST\" within \"A:1-6\", \"B:1-6\"");
    EXPECT_EQ(all("[\"\"]"), "an empty text is no range of residues" + at +
                                 "write \"CHAIN:FIRST-LAST\" within \"A:1-6\", \"B:1-6\"");
}

/// Brackets and quotes in another number than a list of ranges has.
TEST_F(Structures, ranges_in_other_brackets_are_written_as_they_should_be) {
    Words const six{"GLY", "ALA", "SER", "GLY", "ALA", "SER"};
    write("a.pdb", pdb_text(strand(six, "A", 1, 0) + strand(six, "B", 1, 0, 20)));
    std::string const at = " (s.yaml: chains[0].rigid, line 1): write rigid: ",
                      two =
                          "[\"A:1-3\", \"A:4-6\"] for a body of each, rigid: [[\"A:1-3\", "
                          "\"A:4-6\"]] for one body";
    auto const one = [&](std::string const& rigid) {
        return refusal_with("chain: A, rigid: " + rigid);
    };
    EXPECT_EQ(one("\"A:1-3\""), "`A:1-3` in quotes is not a list of ranges" + at + "[\"A:1-3\"]");
    EXPECT_EQ(one("1-3"), "`1-3` is not a list of ranges" + at + "[\"1-3\"]");
    EXPECT_EQ(one("\"A:1-3,4-6\""), "`A:1-3,4-6` in quotes is not a list of ranges" + at + two);
    EXPECT_EQ(one("[1, 3]"), "a list of numbers is not a list of ranges" + at + "[\"1-3\"]");
    EXPECT_EQ(one("all").find("`all` is not a list of ranges (s.yaml: chains[0].rigid, line 1): "
                              "write a list of ranges, such as rigid: [\"1-95\"]"),
              0U);
    EXPECT_EQ(one("{A: [1, 3]}").find("YAML makes a map of `A: [1, 3]`"), 0U) << one("{A: [1, 3]}");
    std::string const deep = "ranges stand in too many brackets (s.yaml: chains[0].rigid[0]";
    EXPECT_EQ(one("[[[\"A:1-3\"]]]").find(deep + "[0], line 1): write rigid: [\"A:1-3\"]"), 0U)
        << one("[[[\"A:1-3\"]]]");
    EXPECT_EQ(one("[[[[1, 3], [4, 6]]]]").find(deep), 0U) << one("[[[[1, 3], [4, 6]]]]");
    EXPECT_NE(one("[[[[1, 3], [4, 6]]]]").find("rigid: [\"1-3\", \"4-6\"] for a body of each"),
              std::string::npos);
}

TEST_F(Structures, ranges_in_other_words_are_told_what_was_meant) {
    Words const six{"GLY", "ALA", "SER", "GLY", "ALA", "SER"};
    write("a.pdb", pdb_text(strand(six, "A", 1, 0) + strand(six, "B", 1, 0, 20)));
    auto const one = [&](std::string const& rigid) {
        return refusal_with("chain: A, rigid: [" + rigid + "]");
    };
    EXPECT_NE(one("1-3: 4-6").find("write rigid: [\"1-3\", \"4-6\"] for a body of each"),
              std::string::npos)
        << one("1-3: 4-6");
    for (char const* const text : {"1-3:4-6", "\"A:1-3:4-6\"", "\"A:1-3,4-6\"", "\"1-3 + 4-6\""})
        EXPECT_NE(one(text).find("holds 2 ranges"), std::string::npos) << one(text);
    for (char const* const text : {"1 to 3", "1..3", "\"1:3\"", "1/3"})
        EXPECT_NE(one(text).find("did you mean \"1-3\"?"), std::string::npos) << one(text);
    for (char const* const text : {"A1-A3", "\"A:1-A:3\"", "\"A:1 to 3\"", "A1..A3"})
        EXPECT_NE(one(text).find("did you mean \"A:1-3\"?"), std::string::npos) << one(text);
}

TEST_F(Structures, insertion_codes_at_the_ends_of_ranges_get_a_hint) {
    std::vector<AtomLine> atoms = strand(Words(6, "GLY"), "A", 1, 0);
    for (std::size_t k = 0; k < atoms.size(); ++k) {
        atoms[k].x *= 0.8;
        if (k % 2 == 0) atoms[k].z = 2.28;
    }
    for (auto const& [k, code] : {std::pair{3, 'A'}, {4, 'B'}}) {
        atoms[static_cast<std::size_t>(k)].number = 3;
        atoms[static_cast<std::size_t>(k)].insertion = code;
    }
    write("a.pdb", pdb_text(atoms));  // residues 1, 2, 3, 3A, 3B, 6
    Words const notes = notes_of(with("rigid: [\"A:1-3\"]"));
    EXPECT_EQ(std::count(notes.begin(), notes.end(),
                         "the rigid residues 1 to 3 of chain A end before 3A, 3B, which share the "
                         "last number; name the last of them to include them"),
              1);
    EXPECT_EQ(with("rigid: [\"A:1-3B\"]").chains.at(0).linked.size(), 2u);
    std::string const at = " (s.yaml: chains[0].rigid[0], line 1): ";
    EXPECT_EQ(refusal_with("rigid: [\"A:1-3C\"]"),
              "residue 3C of chain A is not in the file" + at +
                  "residues of that number have other insertion codes: write one of 3, 3A, 3B");
}

TEST_F(Structures, a_domain_does_not_cross_a_gap) {
    std::vector<AtomLine> atoms = strand(gas_, "A", 1, 0) + strand(gas_, "A", 6, 15);
    write("a.pdb", pdb_text(atoms));
    EXPECT_EQ(refusal_with("gaps: split, rigid: [\"A:1-7\"]"),
              "residues 1 to 7 of chain A do not lie in one chain (s.yaml: chains[0].rigid[0], "
              "line 1): end the domain where its chain ends; for one body of both parts write a "
              "list of ranges, [\"1-3\", ...]");
}

TEST_F(Structures, keys_of_structures_mean_nothing_for_sequences) {
    for (char const* const key : {"chain: A", "gaps: split", "sites: com", "conformer: 1"})
        EXPECT_NE(refusal("chains: [{sequence: GAS, model: calvados2, " + std::string(key) + "}]")
                      .find("does not apply to a sequence"),
                  std::string::npos)
            << key;
}

}  // namespace
}  // namespace catena::test
