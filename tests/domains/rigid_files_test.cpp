// Rigid domains from domain files of the CALVADOS package and from predictions.
#include <fmt/ranges.h>

#include <algorithm>

#include "tests/domains/helix.hpp"
#include "tests/reader/scene_files.hpp"

namespace catena::test {
namespace {

using Words = std::vector<std::string>;
using Offsets = std::vector<std::int64_t>;

class RigidFiles : public SceneFiles {
  protected:
    static std::string scene_of(std::string const& rigid, std::string const& more = "") {
        return "chains: [{name: TIA1, pdb: a.pdb, model: calvados2, rigid: {" + rigid + "}" + more +
               "}]";
    }
    Offsets bodies_of(std::string const& rigid) const {
        return read(scene_of(rigid)).chains.at(0).linked.carried.offset;
    }
    /// 60 residues: confident ones up to 25 and from 36 on, with errors of 2 within each part.
    void write_prediction(double between, int residues = 60) const {
        std::vector<AtomLine> atoms = helix(60, "A", 11);
        for (int k = 0; k < 60; ++k)
            atoms[static_cast<std::size_t>(k)].b_factor = k < 25 || k >= 35 ? 91.5 : 42;
        write("a.pdb", pdb_text(atoms));
        std::string rows;
        for (int i = 0; i < residues; ++i) {
            rows += i == 0 ? "[" : ", [";
            for (int j = 0; j < residues; ++j)
                rows += fmt::format("{}{}", j == 0 ? "" : ", ",
                                    i == j                 ? 0
                                    : (i < 25) == (j < 25) ? 2
                                                           : between);
            rows += "]";
        }
        write("pae.json", "[{\"predicted_aligned_error\": [" + rows +
                              "], \"max_predicted_aligned_error\": 31.75}]");
    }
    std::string const at_domains_ = " (s.yaml: chains[0].rigid.domains, line 1): ";
    std::string const at_pae_ = " (s.yaml: chains[0].rigid.pae, line 1): ";
};

TEST_F(RigidFiles, of_the_package_name_proteins_and_count_residues_from_one) {
    write("a.pdb", pdb_text(helix(20, "A", 101)));
    write("domains.yaml", "hnRNPA1S:\n - [11,89]\nTIA1:\n - [2,5]\n - [8,12]\n");
    Scene const s = read(scene_of("domains: domains.yaml"));
    EXPECT_EQ(s.chains.at(0).linked.carried.offset,
              (Offsets{0, 1, 5, 6, 7, 12, 13, 14, 15, 16, 17, 18, 19, 20}));
    EXPECT_EQ(notes_of(s), Words{"chain `TIA1`: 2 rigid domains by `domains.yaml`, protein TIA1: "
                                 "residues 102-105 (beads 2-5), 108-112 (beads 8-12)"});
    EXPECT_EQ(refusal(scene_of("domains: domains.yaml, protein: hnRNPA1S")),
              "`domains.yaml` ends a domain of hnRNPA1S at residue 89 of a chain of 20" +
                  at_domains_ +
                  "its numbers count residues along the chain from 1: give the file and `protein` "
                  "of this chain");
    EXPECT_EQ(refusal(scene_of("domains: domains.yaml, protein: FUS")),
              "`domains.yaml` has no protein `FUS`" + at_domains_ +
                  "name one as `protein`: `hnRNPA1S`, `TIA1`");
}

TEST_F(RigidFiles, of_the_package_may_have_segments_whose_loops_become_rigid_when_asked) {
    write("a.pdb", pdb_text(helix(20, "A")));
    write("domains.yaml", "p:\n - [[2, 5], [6, 9], [13, 15]]\n");
    EXPECT_EQ(refusal(scene_of("domains: domains.yaml")),
              "residues 10 to 12 would be a flexible loop between two parts of one rigid body, "
              "which a serial chain cannot hold (s.yaml: chains[0].rigid, line 1): write \"2-15\" "
              "to make the loop rigid, too (with `domains` or `pae`: `longest_loop: 3`), or make "
              "two bodies of the parts: rigid: [\"2-9\", \"13-15\"]");
    EXPECT_EQ(bodies_of("domains: domains.yaml, longest_loop: 3"),
              (Offsets{0, 1, 15, 16, 17, 18, 19, 20}));
    // A domain within the loop is then part of the body.
    write("domains.yaml", "p:\n - [[2, 5], [13, 15]]\n - [8, 10]\n");
    EXPECT_EQ(bodies_of("domains: domains.yaml, longest_loop: 7"),
              (Offsets{0, 1, 15, 16, 17, 18, 19, 20}));
}

TEST_F(RigidFiles, of_the_package_with_other_contents) {
    write("a.pdb", pdb_text(helix(20, "A")));
    auto const refused = [&](std::string const& text) {
        write("domains.yaml", text);
        return refusal(scene_of("domains: domains.yaml"));
    };
    std::string const form =
        "write `NAME: [[first, last], ...]`, with residues counted from 1 along the chain";
    for (char const* const text : {"", "# a comment\n", "- [2, 5]\n"})
        EXPECT_EQ(refused(text), "the domain file names no protein (domains.yaml): " + form);
    EXPECT_EQ(refused("TIA1: [[0, 5]]\n"),
              "a domain has a residue 0 (domains.yaml: TIA1[0][0], line 1): " + form);
    EXPECT_EQ(refused("TIA1:\n"),
              "protein `TIA1` has no list of domains (domains.yaml: TIA1, line "
              "1): " +
                  form);
    EXPECT_EQ(
        refused("TIA1: [[5, 2]]\n"),
        "the last residue, 2, precedes the first, 5 (domains.yaml: TIA1[0], line 1): " + form);
    EXPECT_EQ(refused("TIA1: [2, 5]\n"),
              "`2` is not a pair of residues (domains.yaml: TIA1[0], line 1): " + form);
    EXPECT_EQ(refused("TIA1: [[2, 5], [5, 8]]\n"),
              "residues 5 to 8 overlap the domain 2 to 5 (s.yaml: chains[0].rigid, line 1): assign "
              "each residue to one domain");
    EXPECT_EQ(refused("TIA1: [[[2, 4], [8, 8]], [7, 9]]\n"),
              "residues 7 to 9 overlap the domain 8 (s.yaml: chains[0].rigid, line 1): assign each "
              "residue to one domain");
    // Names are shown without the bytes that a terminal would obey.
    EXPECT_EQ(refused("\"a\\e[31m\\n\": [[2, 5]]\nb: [[2, 5]]\n"),
              "`domains.yaml` has no protein `TIA1`" + at_domains_ +
                  "name one as `protein`: `a [31m `, `b`");
}

TEST_F(RigidFiles, grown_residues_are_said_or_refused) {
    write("a.pdb",
          "SEQRES   1 A   24  GLY GLY GLY GLY GLY GLY GLY GLY GLY GLY GLY GLY GLY\n"
          "SEQRES   2 A   24  GLY GLY GLY GLY GLY GLY GLY GLY GLY GLY GLY\n" +
              pdb_text(helix(12, "A") + helix(10, "A", 15, 0, 24)));
    auto const scene = [](std::string const& rigid) {
        return "chains: [{name: p, pdb: a.pdb, model: calvados2, gaps: model, rigid: " + rigid +
               "}]";
    };
    Words const notes = notes_of(read(scene("[[5, 20]]")));
    EXPECT_EQ(std::count(notes.begin(), notes.end(),
                         "2 grown residues in rigid bodies keep the random shape of the start "
                         "(first: residue 13)"),
              1)
        << fmt::format("{}", fmt::join(notes, "\n"));
    write("domains.yaml", "p: [[2, 5]]\n");
    EXPECT_EQ(refusal(scene("{domains: domains.yaml}")),
              "a domain file counts the residues of a structure without gaps, and 2 of this one "
              "are grown" +
                  at_domains_ + "write the domains as ranges of the structure's residue numbers");
}

TEST_F(RigidFiles, are_for_sequences_with_positions_too) {
    std::string table;
    for (AtomLine const& atom : helix(8, "A"))
        table += fmt::format("{},{},{}\n", 0.1 * atom.x, 0.1 * atom.y, 0.1 * atom.z);
    write("start.csv", table);
    write("domains.yaml", "only: [[2, 5]]\n");
    Scene const s = read(
        "chains: [{sequence: GGGGGGGG, model: calvados2, positions: start.csv, rigid: {domains: "
        "domains.yaml}}]");
    EXPECT_EQ(s.chains.at(0).linked.size(), 5u);
    EXPECT_EQ(
        refusal("chains: [{sequence: GGGGGGGG, model: calvados2, positions: start.csv, rigid: "
                "{pae: domains.yaml}}]")
            .substr(0, 50),
        "`pae` without a structure that holds pLDDT (s.yaml");
}

TEST_F(RigidFiles, predictions_decide_domains_by_confidence_and_error) {
    write_prediction(20);
    Scene const s = read(scene_of("pae: pae.json"));
    Offsets const offsets = s.chains.at(0).linked.carried.offset;
    ASSERT_EQ(offsets.size(), 13u);  // two domains, ten beads of the linker
    EXPECT_EQ(offsets[1], 25);
    EXPECT_EQ(offsets[12] - offsets[11], 25);
    EXPECT_EQ(notes_of(s),
              Words{"chain `TIA1`: 2 rigid domains by `pae.json`, pLDDT 70 and more, errors of 5 "
                    "angstrom at most: residues 11-35 (beads 1-25), 46-70 (beads 36-60)"});
    // A looser limit of the error joins both, with the short loop between them.
    EXPECT_EQ(bodies_of("pae: pae.json, max_pae: 20").size(), 2u);
    EXPECT_EQ(refusal(scene_of("pae: pae.json, max_pae: 20, longest_loop: 9")),
              "residues 36 to 45 would be a flexible loop between two parts of one rigid body, "
              "which a serial chain cannot hold (s.yaml: chains[0].rigid, line 1): write \"11-70\" "
              "to make the loop rigid, too (with `domains` or `pae`: `longest_loop: 10`), or make "
              "two bodies of the parts: rigid: [\"11-35\", \"46-70\"]");
    EXPECT_EQ(refusal(scene_of("pae: pae.json, plddt: 95")),
              "no 20 residues in a row have a pLDDT of 95 and more and an error of 5 angstrom at "
              "most" +
                  at_pae_ + "leave `rigid` out, or change `plddt`, `max_pae` or `min_length`");
}

TEST_F(RigidFiles, predictions_must_fit_the_structure) {
    write_prediction(20, 59);
    EXPECT_EQ(refusal(scene_of("pae: pae.json")),
              "the structure has 60 residues and `pae.json` the errors of 59" + at_pae_ +
                  "if both are of one protein, the file of errors is cut short: copy it again, or "
                  "else give the errors of this structure");
    write_prediction(20, 61);
    EXPECT_NE(refusal(scene_of("pae: pae.json")).find("the structure is cut short"),
              std::string::npos);
    write_prediction(20);
    auto const with_b_factor = [&](double value) {
        std::vector<AtomLine> atoms = helix(60, "A");
        for (AtomLine& atom : atoms) atom.b_factor = value;
        write("a.pdb", pdb_text(atoms));
        return refusal(scene_of("pae: pae.json"));
    };
    std::string const give =
        at_pae_ + "give a predicted structure as `pdb`, with pLDDT from 0 to 100 as B factors";
    EXPECT_EQ(with_b_factor(0), "all B factors are 0: they are no pLDDT" + give);
    EXPECT_EQ(with_b_factor(0.9), "no B factor exceeds 1: they are no pLDDT from 0 to 100" + give);
    EXPECT_EQ(with_b_factor(123), "the B factor 123 of residue 1 is no pLDDT" + give);
}

TEST_F(RigidFiles, thresholds_and_confidences_have_one_scale) {
    write_prediction(20);
    EXPECT_EQ(refusal(scene_of("pae: pae.json, plddt: 0.7")),
              "a pLDDT of 0.7, where those of the structure reach 91.5 (s.yaml: "
              "chains[0].rigid.plddt, line 1): give it from 0 to 100, such as 70");
    EXPECT_EQ(bodies_of("pae: pae.json, plddt: 0").size(),
              bodies_of("pae: pae.json, plddt: 30").size());
}

TEST_F(RigidFiles, predictions_come_in_several_forms) {
    write_prediction(20);
    std::ifstream file(folder_ / "pae.json");
    std::string const list(std::istreambuf_iterator<char>(file), {});
    for (char const* const key : {"predicted_aligned_error", "pae"}) {
        std::string text = list.substr(1, list.size() - 2);
        text.replace(text.find("predicted_aligned_error"), 23, key);
        write("pae.json", text);
        EXPECT_EQ(bodies_of("pae: pae.json").size(), 13u) << key;
    }
    std::string const remedy =
        at_pae_ +
        "give the file of predicted aligned errors that belongs to the structure (AlphaFold "
        "database: AF-...-predicted_aligned_error_v4.json)";
    auto const refused = [&](std::string const& text) {
        write("pae.json", text);
        return refusal(scene_of("pae: pae.json"));
    };
    EXPECT_EQ(refused("[{\"residue1\": [1], \"distance\": [0]}]"),
              "`pae.json` has no list `predicted_aligned_error` or `pae`" + remedy);
    EXPECT_EQ(refused("{\"pae\": [[0, 1], [1]]}"),
              "row 2 of `pae.json` does not have 2 numbers, as many as there are rows" + remedy);
    for (char const* const value : {"-1", "1e+300", "null", "\"a\""})
        EXPECT_EQ(
            refused(fmt::format("{{\"pae\": [[0, {}], [1, 0]]}}", value)),
            fmt::format("row 1, column 2 of `pae.json`, `{}`, is not an error in angstrom", value) +
                remedy);
    // Python's json.dump writes these.
    for (char const* const value : {"NaN", "Infinity", "-Infinity"})
        EXPECT_EQ(refused(fmt::format("{{\"pae\": [[0, {}], [1, 0]]}}", value)),
                  fmt::format("`pae.json` has {} in place of an error", value) + at_pae_ +
                      "JSON has no such number, and without that error no domains can be told: "
                      "predict the errors again");
    EXPECT_EQ(refused("{\"pae\":\n\n [[0, what]]}"),
              "`pae.json` is not well-formed JSON, line 3" + remedy);
    EXPECT_EQ(refused("{\"pae\": [[0, 1], [1,\n"),
              "`pae.json` is not well-formed JSON, line 2: the text ends too early, as in a file "
              "that was cut" +
                  remedy);
    EXPECT_EQ(refused("{\"pae\": [[" + std::string(500, ' ') + "x"),
              "`pae.json` is not well-formed JSON, line 1, character 511" + remedy);
    EXPECT_EQ(refused("{\"pae\": [[0, 1e400], [1, 0]]}"),
              "`pae.json` holds a number beyond double precision" + remedy);
    for (std::string const second : {"pae", "predicted_aligned_error"})
        EXPECT_EQ(refused("{\"pae\": [[0]], \"" + second + "\": [[1]]}"),
                  "`pae.json` has 2 matrices of errors" + at_pae_ +
                      "keep the one that belongs to the structure");
    for (std::string const beside :
         {"\"summary\": {\"pae\": 3.2}", "\"predicted_aligned_error\": 3.2"})
        EXPECT_EQ(refused("{\"pae\": [[0, 1], [1]], " + beside + "}").substr(0, 21),
                  "row 2 of `pae.json` d");
}

/// A matrix of as many rows would need 160 GB.
TEST_F(RigidFiles, predictions_need_memory_only_for_what_is_a_matrix) {
    write_prediction(20);
    std::string zeros = "{\"pae\": [0";
    for (int k = 1; k < 200000; ++k) zeros += ",0";
    write("pae.json", zeros + "]}");
    EXPECT_EQ(refusal(scene_of("pae: pae.json")).substr(0, 48),
              "row 1 of `pae.json` does not have 200000 numbers");
}

TEST_F(RigidFiles, keys_belong_to_their_source) {
    write("a.pdb", pdb_text(helix(20, "A") + helix(20, "B", 1, 12)));
    std::string const at = " (s.yaml: chains[0].rigid, line 1): ";
    EXPECT_EQ(refusal(scene_of("plddt: 70", ", chain: A")),
              "`rigid` has neither `domains` nor `pae`" + at +
                  "keep one of them, or write a list of ranges");
    EXPECT_EQ(refusal(scene_of("domains: d.yaml, plddt: 70", ", chain: A")),
              "key `plddt` does not apply to `domains` (s.yaml: chains[0].rigid.plddt, line 1): "
              "leave it out");
    EXPECT_EQ(refusal(scene_of("domains: d.yaml", ", chain: all")),
              "`domains` decides the domains of one chain, and the entry has 2" + at +
                  "give each chain its own entry with `chain`, or write a list of ranges");
}

}  // namespace
}  // namespace catena::test
