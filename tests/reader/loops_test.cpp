// Loops in scenes: what they mean, how many degrees of freedom they take, and what is refused.
#include "scene/loops.hpp"
#include "joints/joint_models.hpp"
#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

/// Four bars of length 1 along the sides of a square, the fourth from [0, 1, 0] to the ground.
std::string square(std::string const& keys, std::string const& base = "fixed",
                   std::string const& type = "revolute, axis: [0, 0, 1]") {
    auto const bar = [&](std::string const& at, std::string const& com) {
        return "{mass: 1, com: " + com + ", inertia: [1, 1, 1], joint: {type: " + type +
               ", translation: " + at + "}}";
    };
    return "units: si\nchains: [{base: " + base + ", bodies: [" +
           (base == "free" ? "{mass: 1, com: [0.5, 0, 0], inertia: [1, 1, 1]}"
                           : bar("[0, 0, 0]", "[0.5, 0, 0]")) +
           ", " + bar("[1, 0, 0]", "[0, 0.5, 0]") + ", " + bar("[0, 1, 0]", "[-0.5, 0, 0]") + ", " +
           bar("[-1, 0, 0]", "[0, -0.5, 0]") + "]" + (keys.empty() ? "" : ", " + keys) + "}]";
}

bool notes(Scene const& scene, std::string const& text) {
    for (std::string const& note : scene.notes)
        if (note.find(text) != std::string::npos) return true;
    return false;
}

std::string const to_ground =
    "loops: [{bodies: [4, 0], joint: {type: revolute, axis: [0, 0, 1], translation: [0, -1, 0]}";

TEST(LoopsOfAScene, CountBodiesFromOneAndFixTheirFramesAtTheStart) {
    ChainSpec const chain = parse_scene(square("loops: [{bodies: [4, 2], joint: {type: spherical, "
                                               "translation: [0, -1, 0]}}]"),
                                        "s.yaml")
                                .chains.at(0);
    ASSERT_EQ(chain.loops.size(), 1U);
    LoopClosure const& loop = chain.loops[0];
    EXPECT_EQ(loop.inboard, 3);
    EXPECT_EQ(loop.outboard, 1);
    EXPECT_NEAR(norm(loop.end_translation - Vec3{{-1, 0, 0}}), 0, 1e-15);
    EXPECT_TRUE(chain.is_closed());
    EXPECT_EQ(chain.redundant_directions, 1);
    EXPECT_EQ(scene::degrees_of_freedom(chain), 4 - 2);
}

/// Two bars whose end is held where they are stretched out, and where they are bent.
TEST(LoopsOfAScene, AtADeadCentreHaveANote) {
    auto const held = [](std::string const& q) {
        std::string const bar =
            "{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, axis: [0, "
            "0, 1], translation: ";
        return parse_scene("units: si\nchains: [{base: fixed, bodies: [" + bar + "[0, 0, 0]}}, " +
                               bar + "[1, 0, 0], q: " + q +
                               "}}], loops: [{bodies: [2, 0], joint: {type: spherical, "
                               "translation: [1, 0, 0]}}]}]",
                           "s.yaml");
    };
    Scene const straight = held("0"), bent = held("0.5");
    EXPECT_EQ(straight.chains[0].redundant_directions, 2);
    EXPECT_TRUE(notes(straight, "2 are redundant at the start, and 1 nearby"));
    EXPECT_EQ(bent.chains[0].redundant_directions, 1);
    EXPECT_FALSE(notes(bent, "redundant at the start"));
}

TEST(LoopsOfAScene, TakeAsManyDegreesOfFreedomAsTheirJacobianHas) {
    auto const freedom = [](std::string const& text) {
        return scene::degrees_of_freedom(parse_scene(text, "s.yaml").chains.at(0));
    };
    EXPECT_EQ(freedom(square(to_ground + "}]")), 2);
    EXPECT_EQ(freedom(square(to_ground + "}]", "free")), 9 - 5);
    EXPECT_EQ(freedom(square("loops: [{bodies: [4, 1], joint: {type: revolute, axis: [0, 0, 1], "
                             "translation: [0, -1, 0]}}]",
                             "free")),
              6 + 1);
    EXPECT_EQ(freedom(square("loops: [{bodies: [4, 1], joint: {type: spherical, translation: "
                             "[0, -1, 0]}}]",
                             "free", "spherical")),
              6 + 9 - 3);
    EXPECT_EQ(freedom(square("loops: [{bodies: [0, 4], joint: {type: weld}}]")), 1);
}

TEST(LoopsOfAScene, ThatLeaveNoMotionAreNoted) {
    Scene const scene = parse_scene(
        square("loops: [{bodies: [4, 0], joint: {type: weld}}, {bodies: [2, 0], joint: {type: "
               "weld}}]"),
        "s.yaml");
    EXPECT_EQ(scene::degrees_of_freedom(scene.chains[0]), 0);
    EXPECT_TRUE(notes(scene, "leave no degree of freedom at the start: nothing can move"));
}

TEST(LoopsOfAScene, MustBeClosedAtTheirEnd) {
    EXPECT_EQ(refusal_of(square(to_ground + ", end: [0, 0, 0]}]")), "accepted");
    std::string const open = refusal_of(square(to_ground + ", end: [0.1, 0, 0]}]"));
    EXPECT_NE(open.find("the loop is open at the start: its joint is 0.1 from `end`"),
              std::string::npos)
        << open;
    Scene const nearly = parse_scene(square(to_ground + ", end: [1e-5, 0, 0]}]"), "s.yaml");
    EXPECT_TRUE(notes(nearly, "the smallest change of the joints closes it"));
    EXPECT_EQ(nearly.chains[0].loops[0].end_translation[0], 1e-5);
}

TEST(LoopsOfAScene, AreRefusedWhereTheyHaveNoMeaning) {
    auto const expect = [](std::string const& keys, std::string const& message,
                           std::string const& rest = "") {
        std::string const found = refusal_of(square(keys) + rest);
        EXPECT_NE(found.find(message), std::string::npos) << keys << ": " << found;
    };
    std::string const ball = ", joint: {type: spherical}}]";
    expect("loops: [{bodies: [1, 5]" + ball, "a loop ends at body 5 of 4");
    expect("loops: [{bodies: [-1, 2]" + ball, "a loop ends at body -1 of 4");
    expect("loops: [{bodies: [2, 2]" + ball, "a loop joins body 2 to itself");
    expect("loops: [{bodies: [0, 0]" + ball, "a loop joins the ground to itself");
    expect("loops: [{bodies: [1]" + ball, "is not a list of two numbers");
    expect("loops: [{bodies: [1, 3]}]", "joint");
    expect("loops: [{bodies: [1, 3], joint: {type: free}}]", "a free joint closes no loop");
    expect("loops: [{bodies: [1, 3], joint: {type: link}}]", "a link closes no loop");
    expect("loops: [{bodies: [1, 3], joint: {type: planar, axis: [0, 0, 1]}}]",
           "write `type: revolute`");
    expect("loops: [{bodies: [1, 3], joint: {type: spherical, stiffness: 1}}]", "stiffness");
    expect("tip: fixed, loops: [{bodies: [1, 3]" + ball, "`bodies: [4, 0]`");
    expect("loops: [{bodies: [4, 1]" + ball, "works in absolute coordinates",
           "\ndynamics: {integrator: rattle, step: 1e-3, steps: 1}");
    EXPECT_NE(refusal_of("chains: [{bodies: [{mass: 1, position: [0, 0, 0]}, {mass: 1, position: "
                         "[1, 0, 0], joint: {type: link}}], loops: [{bodies: [2, 1]" +
                         ball + "}]")
                  .find("write `crosslinks`"),
              std::string::npos);
}

TEST(LoopsOfAScene, TurnWithTheirCopies) {
    Scene const scene =
        parse_scene("units: si\nchains: [{count: 2, " +
                        square(to_ground + ", end: [0, 0, 0]}]").substr(square("").find("base")),
                    "s.yaml");
    ASSERT_EQ(scene.chains.size(), 2U);
    for (ChainSpec const& chain : scene.chains) {
        auto const poses = scene::start_poses(chain);
        EXPECT_LE(
            norm(scene::held_frame(poses, chain.loops[0]).origin - chain.loops[0].end_translation),
            1e-12);
    }
}

}  // namespace
}  // namespace catena::test
