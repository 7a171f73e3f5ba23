// Branched chains in scenes: `parent`, what it decides, and what is refused.
#include <algorithm>
#include <cmath>

#include "reader/load_scene.hpp"
#include "scene/branches.hpp"
#include "scene/freedom.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

using Inboard = std::vector<std::int64_t>;

/// A Y of four beads: beads 2 and 3 hang on bead 1, bead 4 on bead 2. `last` replaces the last
/// bead's keys.
std::string tree(std::string const& last = "parent: 2") {
    return "chains: [{"
           "bodies: [{mass: 1, position: [0, 0, 0]}, "
           "{mass: 1, position: [1, 0, 0], joint: {type: link}}, "
           "{mass: 1, position: [0, 1, 0], parent: 1, joint: {type: link}}, "
           "{mass: 1, position: [1, 0, 1.1], joint: {type: link}, " +
           last + "}]}]";
}

TEST(Branches, ParentIsANumberFromOneAndTheBeadBeforeWithoutIt) {
    ChainSpec const chain = parse_scene(tree(), "s.yaml").chains.at(0);
    EXPECT_EQ(chain.parent, (Inboard{-1, 0, 0, 1}));
    EXPECT_TRUE(chain.is_branched());
    EXPECT_EQ(chain.beads.length, (std::vector<double>{0, 1, 1, 1.1}));
    EXPECT_EQ(scene::degrees_of_freedom(chain), 9);
    EXPECT_EQ(scene::ends_of(chain), 2);
    EXPECT_EQ(scene::height_of(chain), 2);
}

TEST(Branches, ARowWithParentsIsAnUnbranchedChain) {
    std::string const row =
        "chains: [{bodies: [{mass: 1, position: [0, 0, 0], parent: 0}, "
        "{mass: 1, position: [1, 0, 0], parent: 1, joint: {type: link}}, "
        "{mass: 1, position: [1, 1, 0], parent: 2, joint: {type: link}}]}]";
    EXPECT_FALSE(parse_scene(row, "s.yaml").chains[0].is_branched());
}

TEST(Branches, TheFingerprintCoversThem) {
    // Beads stand at the same places; only the last link differs.
    EXPECT_NE(parse_scene(tree("parent: 2"), "s.yaml").hash,
              parse_scene(tree("parent: 3"), "s.yaml").hash);
}

/// Links take their written lengths by the least change, along the branches.
TEST(Branches, LinksToTheParentTakeTheirLengths) {
    std::string const written =
        "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, "
        "{mass: 1, position: [1.2, 0, 0], joint: {type: link, length: 1}}, "
        "{mass: 1, position: [0, 0.9, 0], parent: 1, joint: {type: link, length: 1}}, "
        "{mass: 1, position: [0, 0, 1.1], parent: 1, joint: {type: link, length: 1}}]}]";
    Scene const scene = parse_scene(written, "s.yaml");
    std::vector<Vec3> const& x = scene.chains[0].beads.position;
    Vec3 sum = Vec3::zero();
    for (Vec3 const& each : x) sum = sum + each;
    for (std::size_t k = 1; k < 4; ++k) EXPECT_NEAR(norm(x[k] - x[0]), 1, 1e-14);
    EXPECT_NEAR(norm(sum - Vec3{{1.2, 0.9, 1.1}}), 0, 1e-14);
    EXPECT_NEAR(x[0][0], 0.1, 0.01);
    EXPECT_NE(scene.start.link_at.find("beads 1 and 2"), std::string::npos) << scene.start.link_at;
}

TEST(Branches, LinksCutByTheBoxAreMadeWholeAlongBranches) {
    std::string const wrapped =
        "box: {periodic: [5, 5, 5]}\n"
        "chains: [{bodies: [{mass: 1, position: [4.8, 1, 1]}, "
        "{mass: 1, position: [0.5, 1, 1], joint: {type: link, length: 0.7}}, "
        "{mass: 1, position: [4.8, 0.2, 1], parent: 1, joint: {type: link, length: 0.8}}, "
        "{mass: 1, position: [4.8, 4.5, 1], parent: 3, joint: {type: link, length: 0.7}}, "
        "{mass: 1, position: [1.2, 1, 1], parent: 2, joint: {type: link, length: 0.7}}]}]";
    Scene const scene = parse_scene(wrapped, "s.yaml");
    std::vector<Vec3> const& x = scene.chains[0].beads.position;
    EXPECT_NEAR(x[1][0], 5.5, 1e-12);
    EXPECT_NEAR(x[4][0], 6.2, 1e-12);
    EXPECT_NEAR(x[3][1], -0.5, 1e-12);
    EXPECT_NEAR(x[3][0], 4.8, 1e-12);
    ASSERT_FALSE(scene.notes.empty());
    EXPECT_NE(scene.notes[0].find("2 links of 1 chain are cut"), std::string::npos)
        << scene.notes[0];
}

TEST(Branches, PositionsOfAFileReplaceTheGrowth) {
    std::string const brush =
        "chains: [{generator: {star: {arms: 3, arm_length: 1, length: 1}}, positions: NONE.csv}]";
    EXPECT_NE(refusal_of(brush).find("NONE.csv"), std::string::npos);
}

// A trunk of two bodies with an arm on each; `keys` are further keys of the chain, `last` those of
// the last body.
#define BODY "{mass: 1, inertia: [1, 1, 1], joint: {type: "
#define TREE(keys, last)                                                                  \
    "chains: [{base: fixed, " keys "bodies: [" BODY "revolute, axis: [0, 0, 1]}}, " BODY  \
    "spherical, translation: [1, 0, 0]}}, " BODY                                          \
    "universal, axes: [[1, 0, 0], [0, 1, 0]], translation: [0, 1, 0]}, parent: 1}, " BODY \
    "prismatic, axis: [0, 0, 1]}, " last "}]}]\n"

TEST(Branches, BodiesHangOnEarlierOnes) {
    Scene const scene = parse_scene(TREE("", "parent: 2"), "s.yaml");
    ChainSpec const& chain = scene.chains.at(0);
    EXPECT_EQ(chain.parent, (Inboard{-1, 0, 0, 1}));
    EXPECT_EQ(scene::degrees_of_freedom(chain), 7);
    EXPECT_EQ(scene::height_of(chain), 2);
    EXPECT_EQ(scene.solver.handles, Handles::articulated);
    EXPECT_NE(parse_scene(TREE("", "parent: 2"), "s.yaml").hash,
              parse_scene(TREE("", "parent: 3"), "s.yaml").hash);
}

class BranchesRefused : public Refused {};
TEST_P(BranchesRefused, InOneLine) {
    std::string const message = refusal_of(GetParam().yaml);
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

#define BEADS(third)                                                                            \
    "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: [1, 0, 0], joint: " \
    "{type: link}}, {mass: 1, position: [0, 1, 0], joint: {type: link}, " third "}]}]"
INSTANTIATE_TEST_SUITE_P(
    Parents, BranchesRefused,
    testing::Values(
        Refusal{"after_itself", BEADS("parent: 3"), "bead 3 hangs on itself"},
        Refusal{"missing", BEADS("parent: 7"), "bead 3 hangs on bead 7 of 3"},
        Refusal{"no_number", BEADS("parent: first"), "parent"},
        Refusal{"fraction", BEADS("parent: 1.5"), "1.5"},
        Refusal{"negative", BEADS("parent: -1"),
                "bead 3 hangs on bead -1 (s.yaml: chains[0].bodies[2].parent, body 3, line 1): "
                "give the number of an earlier bead, 1 to 2"},
        Refusal{"beyond_integers", BEADS("parent: 1e20"), "bead 3 hangs on bead 1e20 of 3"},
        Refusal{"second_root", BEADS("parent: 0"), "two trees"},
        Refusal{"later",
                "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: [1, 0, 0], "
                "parent: 3, joint: {type: link}}, {mass: 1, position: [0, 1, 0], parent: 1, joint: "
                "{type: link}}]}]",
                "bead 2 hangs on bead 3, which follows it"},
        Refusal{"of_the_first",
                "chains: [{bodies: [{mass: 1, position: [0, 0, 0], parent: 2}, {mass: 1, position: "
                "[1, 0, 0], joint: {type: link}}]}]",
                "the first bead hangs on none"},
        Refusal{"coincident",
                "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: [1, 0, 0], "
                "joint: {type: link}}, {mass: 1, position: [0, 0, 0], parent: 1, joint: {type: "
                "link}}]}]",
                "bead 3 coincides with bead 1"},
        Refusal{"too_far",
                "chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: [1, 0, 0], "
                "joint: {type: link}}, {mass: 1, position: [0, 2, 0], parent: 1, joint: {type: "
                "link, length: 1}}]}]",
                "beads 1 and 3 of chain `chain-1` are 2 nm apart, their link is 1 nm long"},
        Refusal{"ring",
                "chains: [{tip: ring, bodies: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: "
                "[1, 0, 0], joint: {type: link}}, {mass: 1, position: [0, 1, 0], parent: 1, joint: "
                "{type: link}}]}]",
                "a tip that is not free on a branched chain"},
        Refusal{"tip",
                "chains: [{tip: {joint: {type: link, anchor: [0, 0, 3]}}, generator: {star: {arms: "
                "3, arm_length: 2, length: 1}}}]",
                "a tip that is not free on a branched chain"},
        Refusal{"rigid",
                "chains: [{bodies: [{mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}, {mass: 1, "
                "position: [2, 0, 0], parent: 1, joint: {type: link}}]}]",
                "a branched chain that has rigid bodies on links"},
        Refusal{"ends",
                "chains: [{generator: {star: {arms: 3, arm_length: 2, length: 1}}}]\n"
                "output: {observables: [energy, end_to_end_distance]}",
                "branched chains have no end-to-end distance"},
        Refusal{"no_arms", "chains: [{generator: {star: {arm_length: 2, length: 1}}}]", "arms"},
        Refusal{"line_of_generations",
                "chains: [{generator: {dendrimer: {generations: 4, functionality: 2, length: 1}}}]",
                "functionality"},
        Refusal{"huge", "chains: [{generator: {dendrimer: {generations: 400, length: 1}}}]",
                "make it smaller"},
        Refusal{"excluded_beyond_two_links",
                "chains: [{generator: {star: {arms: 3, arm_length: 2, length: 1, excluded: "
                "2.1}}}]",
                "beads 2.1 apart, but two links reach 2 only (s.yaml: "
                "chains[0].generator.star.excluded, line 1): give less than the length of two "
                "links"},
        Refusal{"table_without_the_residue",
                "units: md\nchains: [{model: calvados2, bodies: [{mass: 1, residue: ALA, position: "
                "[0, 0, 0]}, {mass: 1, residue: KGB, position: [1, 0, 0], joint: {type: link}}]}]",
                "residue `KGB` is not in calvados2 (s.yaml: chains[0], bead 2, line 2): give each "
                "bead a `residue` of that table"},
        Refusal{"sequence_keys",
                "chains: [{conformation: extended, generator: {brush: {backbone: 4, side_length: "
                "2, length: 1}}}]",
                "key `conformation` does not apply to generator `brush`"}),
    name_of_case);

#define RUN "dynamics: {step: 0.001, steps: 1, integrator: "
INSTANTIATE_TEST_SUITE_P(
    Bodies, BranchesRefused,
    testing::Values(
        Refusal{"later_body", TREE("", "parent: 4"), "body 4 hangs on itself"},
        Refusal{"missing_body", TREE("", "parent: 9"),
                "body 4 hangs on body 9 of 4 (s.yaml: chains[0].bodies[3].parent, body 4, line 1): "
                "count the bodies of this chain from 1"},
        Refusal{"second_root_of_bodies", TREE("", "parent: 0"), "two trees"},
        Refusal{"full_handles", TREE("", "parent: 2") "solver: {handles: full}",
                "full handles for chain `chain-1`, a branched chain of rigid bodies"},
        Refusal{"projected_handles", TREE("", "parent: 2") "solver: {handles: projected}",
                "projected handles for branched chains of rigid bodies"},
        Refusal{"rattle", TREE("", "parent: 2") RUN "rattle}",
                "integrator rattle moves no branched chains of rigid bodies"},
        Refusal{"implicit", TREE("", "parent: 2") RUN "staggered}",
                "not in this version: implicit springs and dampers of branched chains"},
        Refusal{"planar",
                "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: "
                "planar, axis: [0, 0, 1]}}, {mass: 1, inertia: [1, 1, 1], joint: {type: planar, "
                "axis: [0, 0, 1]}}, {mass: 1, inertia: [1, 1, 1], parent: 1, joint: {type: planar, "
                "axis: [0, 0, 1]}}]}]",
                "not in this version: planar joints of a branched chain"},
        Refusal{"thermal", TREE("velocities: thermal, ", "parent: 2") RUN "rk4, temperature: 300}",
                "thermal velocities for a branched chain of rigid bodies"}),
    name_of_case);

}  // namespace
}  // namespace catena::test
