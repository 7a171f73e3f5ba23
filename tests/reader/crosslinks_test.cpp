// Cross-links in scenes: what they mean, how starts are fitted to them, and what is refused.
#include <cmath>

#include "generate/start_fit.hpp"
#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

/// Four beads at the corners of a bent square; `keys` are those of the chain.
std::string square(std::string const& keys) {
    return "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, "
           "{mass: 1, position: [1, 0, 0], joint: {type: link}}, "
           "{mass: 1, position: [1, 1, 0], joint: {type: link}}, "
           "{mass: 1, position: [0, 1, 0.5], joint: {type: link}}]" +
           (keys.empty() ? "" : ", " + keys) + "}]";
}

double distance(ChainSpec const& chain, std::size_t a, std::size_t b) {
    return norm(chain.beads.position[b] - chain.beads.position[a]);
}

bool notes(Scene const& scene, std::string const& text) {
    for (std::string const& note : scene.notes)
        if (note.find(text) != std::string::npos) return true;
    return false;
}

TEST(CrossLinksOfAScene, CountBeadsFromOneAndKeepTheDistanceOfTheStart) {
    ChainSpec const chain =
        parse_scene(square("crosslinks: [[1, 4], [3, 1]]"), "s.yaml").chains.at(0);
    ASSERT_EQ(chain.crosslinks.size(), 2u);
    EXPECT_EQ(chain.crosslinks[0], (CrossLink{0, 3, distance(chain, 0, 3)}));
    EXPECT_EQ(chain.crosslinks[1], (CrossLink{0, 2, distance(chain, 0, 2)}));
    EXPECT_EQ(chain.beads.position[3][2], 0.5);
    EXPECT_FALSE(chain.is_branched());
    EXPECT_EQ(scene::degrees_of_freedom(chain), 12 - 3 - 2);
}

TEST(CrossLinksOfAScene, MoveBeadsToTheLengthThatTheyGive) {
    Scene const scene = parse_scene(square("crosslinks: [[1, 4, 1]]"), "s.yaml");
    ChainSpec const& chain = scene.chains.at(0);
    EXPECT_NEAR(distance(chain, 0, 3), 1, 1e-13);
    for (std::size_t k = 1; k < 4; ++k)
        EXPECT_NEAR(distance(chain, k - 1, k), chain.beads.length[k], 1e-13);
    EXPECT_TRUE(notes(scene, "beads are moved by up to"));
}

TEST(CrossLinksOfAScene, PullGeneratedStartsTogether) {
    Scene const scene = parse_scene(
        "chains: [{generator: {freely_jointed: {beads: 60, length: 0.5, mass: 100}}, "
        "crosslinks: [[1, 60, 0.5], [10, 40, 0.7]]}]",
        "s.yaml");
    ChainSpec const& chain = scene.chains.at(0);
    EXPECT_NEAR(distance(chain, 0, 59), 0.5, 1e-12);
    EXPECT_NEAR(distance(chain, 9, 39), 0.7, 1e-12);
    for (std::size_t k = 1; k < 60; ++k) EXPECT_NEAR(distance(chain, k - 1, k), 0.5, 1e-12);
    EXPECT_TRUE(notes(scene, "their cross-link is"));
}

/// Five beads with all ten links between them have one more than they can need.
TEST(CrossLinksOfAScene, ThatAreRedundantTakeNoFreedom) {
    Scene const scene = parse_scene(
        "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, "
        "{mass: 1, position: [1, 0, 0], joint: {type: link}}, "
        "{mass: 1, position: [1, 1, 0.2], joint: {type: link}}, "
        "{mass: 1, position: [0, 1.1, 0.5], joint: {type: link}}, "
        "{mass: 1, position: [0.3, 0.4, 1], joint: {type: link}}], "
        "crosslinks: [[1, 3], [1, 4], [1, 5], [2, 4], [2, 5], [3, 5]]}]",
        "s.yaml");
    EXPECT_EQ(scene.chains[0].redundant_links, 1);
    EXPECT_EQ(scene::degrees_of_freedom(scene.chains[0]), 6);
    EXPECT_TRUE(notes(scene, "1 of the 10 links of chain `chain-1` is redundant"));
}

TEST(CrossLinksOfAScene, OfASpecialStartAreNoted) {
    EXPECT_TRUE(notes(parse_scene("chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, "
                                  "{mass: 1, position: [1, 0, 0], joint: {type: link}}, "
                                  "{mass: 1, position: [2, 0, 0], joint: {type: link}}], "
                                  "crosslinks: [[1, 3]]}]",
                                  "s.yaml"),
                      "would not elsewhere"));
}

/// Positions of a frame or a checkpoint take back what a start's fit has said, but not what links
/// are redundant anywhere.
TEST(CrossLinksOfAScene, OtherPositionsTakeBackWhatTheFitSaid) {
    Scene moved = parse_scene(square("crosslinks: [[1, 4, 1]]"), "s.yaml");
    ASSERT_TRUE(notes(moved, "beads are moved by up to"));
    scene::forget_fits(moved);
    EXPECT_FALSE(notes(moved, "beads are moved by up to"));
    Scene special = parse_scene(
        "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, "
        "{mass: 1, position: [1, 0, 0], joint: {type: link}}, "
        "{mass: 1, position: [2, 0, 0], joint: {type: link}}], "
        "crosslinks: [[1, 3]]}]",
        "s.yaml");
    scene::forget_fits(special);
    EXPECT_FALSE(notes(special, "would not elsewhere"));
}

TEST(CrossLinksOfAScene, HaveProjectedHandlesInAdviceToo) {
    EXPECT_NE(refusal_of(square("crosslinks: [[1, 4]]") + "\nsolver: {handles: articulated}")
                  .find("use `projected`:"),
              std::string::npos);
}

TEST(CrossLinksOfAScene, TrajectoriesLeaveTheirForcesOutAndANoteSaysSo) {
    auto const is_said = [](std::string const& crosslinks, char const* output) {
        return notes(parse_scene(square(crosslinks) + output, "s.yaml"),
                     "`joint_forces` leaves out the forces of cross-links");
    };
    EXPECT_TRUE(is_said("crosslinks: [[1, 4]]", "\noutput: {joint_forces: true}"));
    EXPECT_FALSE(is_said("crosslinks: [[1, 4]]", ""));
    EXPECT_FALSE(is_said("crosslinks: []", "\noutput: {joint_forces: true}"));
}

TEST(CrossLinksOfAScene, TheFingerprintCoversThem) {
    std::string const none = parse_scene(square(""), "s.yaml").hash,
                      one = parse_scene(square("crosslinks: [[1, 4]]"), "s.yaml").hash,
                      other = parse_scene(square("crosslinks: [[1, 3]]"), "s.yaml").hash;
    EXPECT_NE(none, one);
    EXPECT_NE(one, other);
}

TEST(CrossLinksOfAScene, AreThoseOfEveryCopyAndReplica) {
    Scene const scene =
        parse_scene(square("count: 2, crosslinks: [[1, 4]]") + "\nreplicas: 2", "s.yaml");
    ASSERT_EQ(scene.chains.size(), 4u);
    for (ChainSpec const& chain : scene.chains) {
        ASSERT_EQ(chain.crosslinks.size(), 1u);
        EXPECT_NEAR(distance(chain, 0, 3), chain.crosslinks[0].length, 1e-12);
    }
}

TEST(CrossLinksOfAScene, AreRefusedInOneLine) {
    struct Case {
        std::string keys, message;
    };
    for (Case const& each :
         std::vector<Case>{{"crosslinks: [[1, 5]]", "a cross-link ends at bead 5 of 4"},
                           {"crosslinks: [[0, 4]]", "a cross-link ends at bead 0 of 4"},
                           {"crosslinks: [[1, 2]]", "beads 1 and 2 have a link already"},
                           {"crosslinks: [[3, 3]]", "a cross-link joins bead 3 to itself"},
                           {"crosslinks: [[1, 4], [4, 1]]", "beads 1 and 4 have two cross-links"},
                           {"crosslinks: [[1]]", "a cross-link is a list of two beads"},
                           {"crosslinks: [1, 4]", "a cross-link is a list of two beads"},
                           {"crosslinks: [[1, 4, 0]]", "0"},
                           {"crosslinks: [[1, 4, 0.3]]", "their cross-link is 0.3 nm long"},
                           {"tip: {ring: {type: link}}, crosslinks: [[1, 3]]",
                            "cross-links in a chain whose tip is not free"}}) {
        std::string const message = refusal_of(square(each.keys));
        EXPECT_NE(message.find(each.message), std::string::npos) << each.keys << ": " << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    }
    EXPECT_NE(refusal_of("chains: [{generator: {pendulum: {links: 8}}, crosslinks: [[1, 3]]}]")
                  .find("cross-links in a chain that has rigid bodies"),
              std::string::npos);
}

TEST(CrossLinksOfAScene, OfGeneratedStartsNeedALength) {
    for (std::string const start :
         {"sequence: GGGGGG, model: calvados2",
          "generator: {freely_jointed: {beads: 9, length: 0.38}}",
          "sequence: GGGGGG, model: calvados2, conformation: self_avoiding"}) {
        std::string const chain = "chains: [{" + start + ", crosslinks: ";
        std::string const message = refusal_of(chain + "[[1, 5]]}]");
        EXPECT_NE(message.find("the cross-link of beads 1 and 5 has no length, and the start is "
                               "generated (s.yaml: chains[0].crosslinks"),
                  std::string::npos)
            << message;
        EXPECT_NE(message.find("add it, [1, 5, LENGTH]"), std::string::npos) << message;
        EXPECT_EQ(parse_scene(chain + "[[1, 5, 0.55]]}]", "s.yaml").chains.at(0).crosslinks,
                  (std::vector<CrossLink>{{0, 4, 0.55}}));
    }
}

TEST(CrossLinksOfAScene, CloseRingsOfSequences) {
    std::string const chain = "chains: [{sequence: GGGGGG, model: calvados2, ";
    for (std::string const ring : {"tip: ring", "tip: {ring: {type: link, length: 0.38}}"}) {
        std::string const message = refusal_of(chain + ring + "}]");
        EXPECT_NE(message.find("a ring of a sequence whose start is generated"), std::string::npos)
            << message;
        EXPECT_NE(message.find("write `crosslinks: [[1, 6, 0.38]]`"), std::string::npos) << message;
    }
    std::string const closed = chain + "crosslinks: [[1, 6, 0.38]]",
                      note = "chain `chain-1` is closed, and its ends have the charges and masses";
    EXPECT_TRUE(notes(parse_scene(closed + "}]", "s.yaml"), note));
    for (std::string const ends : {", charge_termini: none", ", charge_termini: both"})
        EXPECT_FALSE(notes(parse_scene(closed + ends + "}]", "s.yaml"), note));
    EXPECT_FALSE(notes(parse_scene(chain + "crosslinks: [[1, 5, 0.38]]}]", "s.yaml"), note));
    EXPECT_FALSE(notes(parse_scene(closed + "}]\nforces: {openmm: {builder: calvados2, "
                                            "charge_termini: none}}",
                                   "s.yaml"),
                       note));
}

TEST(CrossLinksOfAScene, ThatAreRedundantHaveNoFixmanPotential) {
    EXPECT_NE(refusal_of("chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, "
                         "{mass: 1, position: [1, 0, 0], joint: {type: link}}, "
                         "{mass: 1, position: [1, 1, 0.2], joint: {type: link}}, "
                         "{mass: 1, position: [0, 1.1, 0.5], joint: {type: link}}, "
                         "{mass: 1, position: [0.3, 0.4, 1], joint: {type: link}}], "
                         "crosslinks: [[1, 3], [1, 4], [1, 5], [2, 4], [2, 5], [3, 5]]}]\n"
                         "dynamics: {integrator: g-baoab, step: 0.01, steps: 1, temperature: 300, "
                         "fixman: true}")
                  .find("1 of whose links is redundant"),
              std::string::npos);
}

}  // namespace
}  // namespace catena::test
