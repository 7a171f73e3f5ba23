// What is wrong with joints, tips, motions, drag, links between bodies, distributions. Every
// message whole.
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

/// A scene whose second body has the joint `joint`, and with more keys of the chain.
std::string arm(std::string const& joint, std::string const& more = "") {
    return "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, "
           "axis: [0, 0, 1]}}, {mass: 1, inertia: "
           "[1, "
           "1, 1], joint: " +
           joint + "}]" + more + "}]";
}

struct BadJoint {
    char const* name;
    char const* joint;
    char const* what;
    char const* key;  // below the joint
    char const* remedy;
};
std::ostream& operator<<(std::ostream& stream, BadJoint const& bad) { return stream << bad.joint; }

class BadJoints : public testing::TestWithParam<BadJoint> {};

TEST_P(BadJoints, in_one_line) {
    BadJoint const& bad = GetParam();
    EXPECT_EQ(refusal_of(arm(bad.joint)), std::string(bad.what) +
                                              " (s.yaml: chains[0].bodies[1].joint" + bad.key +
                                              ", body 2, line 1): " + bad.remedy);
}

BadJoint const joints[] = {
    {"axes_missing", "{type: universal}", "key `axes` is missing", "",
     "add `axes: [[1, 0, 0], [0, 1, 0]]`"},
    {"one_axis", "{type: universal, axes: [[1, 0, 0]]}", "a list is not two axes", ".axes",
     "give the first in the joint frame, the second in the body's frame"},
    {"parallel_axes", "{type: universal, axes: [[1, 0, 0], [-2, 0, 0]]}",
     "the two axes are parallel", ".axes",
     "give two directions, best at right angles, or use a revolute joint"},
    {"axis_of_universal", "{type: universal, axes: [[1, 0, 0], [0, 1, 0]], axis: [1, 0, 0]}",
     "key `axis` does not apply to a universal joint", ".axis", "leave it out or correct `type`"},
    {"one_angle", "{type: universal, axes: [[1, 0, 0], [0, 1, 0]], q: 1}", "`1` is not a list",
     ".q", "give 2 numbers in brackets"},
    {"three_rests", "{type: universal, axes: [[1, 0, 0], [0, 1, 0]], rest: [1, 2, 3]}",
     "the list has 3 entries, not 2", ".rest", "give 2 numbers in brackets"},
    {"negative_stiffness", "{type: universal, axes: [[1, 0, 0], [0, 1, 0]], stiffness: [1, -1]}",
     "stiffness -1 is negative", ".stiffness", "give 0 or positive numbers"},
    {"axes_of_revolute", "{type: revolute, axes: [[0, 0, 1], [1, 0, 0]]}",
     "key `axes` does not apply to a revolute joint", ".axes",
     "leave it out, or write `type: planar3` for two translations and a rotation"},
    {"q_of_weld", "{type: weld, q: 0}", "key `q` does not apply to a weld joint", ".q",
     "leave it out or correct `type`"},
    {"torque_of_weld", "{type: weld, torque: 1}", "key `torque` does not apply to a weld joint",
     ".torque", "leave it out or correct `type`"},
    {"rest_without_spring", "{type: revolute, axis: [0, 0, 1], rest: 0.5}",
     "`rest` of a joint without `stiffness`, which has no spring", ".rest",
     "give the spring's `stiffness`, or leave `rest` out"},
    {"far_angle", "{type: cylindrical, axis: [0, 0, 1], q: [1e30, 0]}",
     "a joint's position of 1e+30 is beyond the range of coordinates", ".q",
     "correct it: the largest is 1e+09"},
    {"far_angle_of_universal", "{type: universal, axes: [[1, 0, 0], [0, 1, 0]], q: [0, -2e9]}",
     "a joint's position of -2e+09 is beyond the range of coordinates", ".q",
     "correct it: the largest is 1e+09"},
    {"far_rest", "{type: helical, axis: [0, 0, 1], pitch: 1, stiffness: 1, rest: 1e10}",
     "a joint's position of 1e+10 is beyond the range of coordinates", ".rest",
     "correct it: the largest is 1e+09"},
    {"far_motion", "{type: revolute, axis: [0, 0, 1], motion: {offset: 1e12}}",
     "a joint's position of 1e+12 is beyond the range of coordinates", ".motion",
     "correct it: the largest is 1e+09"},
    {"no_axis", "{type: prismatic}", "key `axis` is missing", "", "add `axis: [0, 0, 1]`"},
    {"negative_damping", "{type: prismatic, axis: [1, 0, 0], damping: -2}",
     "damping -2 is negative", ".damping", "give 0 or a positive number"},
    {"no_pitch", "{type: helical, axis: [1, 0, 0]}", "key `pitch` is missing", "",
     "add `pitch: 0.1`"},
    {"zero_pitch", "{type: helical, axis: [1, 0, 0], pitch: 0}", "a helical joint without pitch",
     ".pitch", "give its shift per radian, or use a revolute joint"},
    {"pitch_of_prismatic", "{type: prismatic, axis: [1, 0, 0], pitch: 1}",
     "key `pitch` does not apply to a prismatic joint", ".pitch", "leave it out or correct `type`"},
    {"not_finite", "{type: helical, axis: [1, 0, 0], pitch: .nan}", "`.nan` is not finite",
     ".pitch", "give a finite decimal number such as 0.38"},
    {"motion_text", "{type: revolute, axis: [0, 0, 1], motion: sin(t)}", "`sin(t)` is not a map",
     ".motion", "give a map with keys among `offset`, `rate`, `amplitude`, `frequency`, `phase`"},
    {"empty_motion", "{type: revolute, axis: [0, 0, 1], motion: {}}",
     "the motion has no parameters", ".motion",
     "add one of `offset`, `rate`, `amplitude`, `frequency`, `phase`, or use a weld"},
    {"unknown_in_motion", "{type: revolute, axis: [0, 0, 1], motion: {ampltude: 1}}",
     "unknown key `ampltude`", ".motion.ampltude", "did you mean `amplitude`?"},
    {"motion_and_q", "{type: revolute, axis: [0, 0, 1], motion: {rate: 1}, q: 1}",
     "key `q` of a joint whose `motion` is prescribed", ".q", "keep one of them"},
    {"motion_and_torque", "{type: prismatic, axis: [0, 0, 1], motion: {rate: 1}, torque: 1}",
     "key `torque` of a joint whose `motion` is prescribed", ".torque", "keep one of them"},
    {"motion_and_damping",
     "{type: helical, pitch: 1, axis: [0, 0, 1], motion: {rate: 1}, damping: 1}",
     "key `damping` of a joint whose `motion` is prescribed", ".damping", "keep one of them"},
    {"one_motion_of_universal",
     "{type: universal, axes: [[1, 0, 0], [0, 1, 0]], motion: {rate: 1}}",
     "a map is not two motions", ".motion", "give a list of two maps, one per axis"},
    {"one_number_of_cylindrical", "{type: cylindrical, axis: [0, 0, 1], stiffness: 3}",
     "`3` is not a list", ".stiffness", "give 2 numbers in brackets"},
    {"one_rest_of_planar3", "{type: planar3, axes: [[1, 0, 0], [0, 0, 1]], rest: 0}",
     "`0` is not a list", ".rest", "give 3 numbers in brackets"},
    {"two_torques_of_planar3", "{type: planar3, axes: [[1, 0, 0], [0, 0, 1]], torque: [1, 2]}",
     "the list has 2 entries, not 3", ".torque", "give 3 numbers in brackets"},
    {"one_axis_of_planar3", "{type: planar3, axes: [[1, 0, 0]]}", "a list is not two axes", ".axes",
     "give a direction in the plane, then its normal"},
    {"oblique_plane", "{type: planar3, axes: [[1, 0, 0], [0.001, 0, 1]]}",
     "the two axes are not perpendicular", ".axes",
     "give a direction in the plane, then its normal"},
    {"axis_of_planar3", "{type: planar3, axis: [0, 0, 1]}",
     "key `axis` does not apply to a planar3 joint", ".axis", "leave it out or correct `type`"},
    {"motion_of_planar3", "{type: planar3, axes: [[1, 0, 0], [0, 0, 1]], motion: {rate: 1}}",
     "key `motion` does not apply to a planar3 joint", ".motion", "leave it out or correct `type`"},
    {"one_motion_of_cylindrical", "{type: cylindrical, axis: [0, 0, 1], motion: {rate: 1}}",
     "a map is not two motions", ".motion", "give a list of two maps, one per axis"},
    {"motion_of_spherical", "{type: spherical, motion: {rate: 1}}",
     "key `motion` does not apply to a spherical joint", ".motion",
     "leave it out or correct `type`"},
};
INSTANTIATE_TEST_SUITE_P(Joints, BadJoints, testing::ValuesIn(joints),
                         [](testing::TestParamInfo<BadJoint> const& at) {
                             return std::string(at.param.name);
                         });

TEST(BadPlanar, names_the_body) {
    EXPECT_EQ(refusal_of(arm("{type: planar, axis: [0, 0.1, 1]}")),
              "the chain has planar joints, but the revolute joint 2 is not parallel to the "
              "previous ones (s.yaml: chains[0].bodies[1], body 2, line 1): correct `axis` or "
              "`rotation`, or write `type: revolute`");
    EXPECT_EQ(refusal_of("chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: "
                         "{type: spherical}}, {mass: 1, inertia: [1, 1, "
                         "1], joint: {type: planar, axis: [0, 0, 1]}}]}]"),
              "the chain has planar joints, but the spherical joint 1 is not parallel to the "
              "previous ones (s.yaml: chains[0].bodies[0], body 1, line 1): correct `axis` or "
              "`rotation`, or write `type: revolute`");
}

TEST(BadTips, of_bodies) {
    std::string const ball = "{type: spherical, translation: [1, 0, 0]}",
                      at = " (s.yaml: chains[0].tip.joint";
    EXPECT_EQ(
        refusal_of(
            arm(ball,
                ", tip: {joint: {type: spherical, translation: [1, 0, 0], anchor: [2, 0, 1e-3]}}")),
        "the tip's joint is open at the start: its origin is at [2, 0, 0], 0.001 from the anchor" +
            at + ", line 1): move the chain or the anchor to within 0.0002, or leave `anchor` out");
    EXPECT_EQ(
        refusal_of(arm(ball, ", tip: {joint: {type: free}}")),
        "a free joint at the tip restricts nothing" + at + ".type, line 1): write `tip: free`");
    EXPECT_EQ(refusal_of(arm(ball, ", tip: {joint: {type: link, anchor: [0, 0, 0]}}")),
              "a link at the tip of a chain of other joints" + at +
                  ", line 1): use another type, such as spherical");
    EXPECT_EQ(refusal_of(arm(ball, ", tip: {joint: {type: weld, q: 1}}")),
              "key `q` does not apply to a weld joint" + at +
                  ".q, line 1): leave it out or correct `type`");
    EXPECT_EQ(refusal_of(arm(ball, ", tip: {joint: {type: revolute}}")),
              "key `axis` is missing" + at + ", line 1): add `axis: [0, 0, 1]`");
    // On the spherical joint's centre the tip leaves the last body its rotation.
    EXPECT_EQ(refusal_of(arm(ball, ", tip: {joint: {type: revolute, axis: [0, 0, 1]}}")),
              "accepted");
    EXPECT_EQ(refusal_of(arm(ball,
                             ", tip: {joint: {type: revolute, axis: [0, 1, 0], translation: "
                             "[1, 0, 0]}}")),
              "the tip's joint restricts 5 directions, the chain has 4 degrees of freedom" + at +
                  ", line 1): give the tip a joint that restricts less, or the chain more joints");
    EXPECT_EQ(refusal_of(arm(ball, ", tip: {joint: {}}")),
              "key `type` is missing" + at + ", line 1): add `type: revolute`");
    EXPECT_EQ(
        refusal_of(arm(ball, ", tip: {}")),
        "key `joint` is missing (s.yaml: chains[0].tip, line 1): add `joint: {type: spherical}`");
    EXPECT_EQ(
        refusal_of(arm(ball, ", tip: fixd")),
        "`fixd` is not a value of `tip` (s.yaml: chains[0].tip, line 1): did you mean `fixed`?");
    EXPECT_EQ(
        refusal_of("chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: "
                   "{type: spherical}}, {mass: 1, inertia: [1, 1, "
                   "1], joint: {type: spherical, translation: [1, 0, 0]}}], tip: {joint: "
                   "{type: spherical, translation: [1, 0, 0]}}}]"),
        "the bridge from ground to ground is straight: the forces in its joints are indeterminate" +
            at + ", line 1): start from a bent chain");
}

TEST(BadTips, of_rings) {
    auto const triangle = [](std::string const& chain, std::string const& last) {
        std::string const body = "{mass: 1, com: [0.5, 0, 0], inertia: [1, 1, 1], joint: ",
                          ball = "type: spherical, translation: [1, 0, 0]";
        return "chains: [{" + chain + ", bodies: [" + body + "{type: free}}, " + body + "{" + ball +
               ", q: [0.5, 0, 0, 0.8660254037844386]}}, " + body + "{" + ball +
               ", q: [0.5, 0, 0, 0.8660254037844386]}}], tip: " + last + "}]";
    };
    std::string const at = " (s.yaml: chains[0].tip", free = "base: free";
    EXPECT_EQ(refusal_of(triangle(free, "{ring: {type: spherical, translation: [1, 0, 0]}}")),
              "accepted");
    EXPECT_EQ(refusal_of(triangle(
                  free, "{ring: {type: revolute, axis: [0, 0, 1], translation: [1, 0, 0]}}")),
              "accepted");
    EXPECT_EQ(refusal_of(triangle(free, "{ring: {type: spherical, translation: [1, 0, 0.01]}}")),
              "the ring is open at the start: the first body is 0.01 and 0 rad from where the last "
              "body's joint holds it" +
                  at +
                  ".ring, line 1): move the bodies to within 0.0003 and 0.0001 rad of it, or "
                  "correct `translation` and `rotation`");
    std::string const turned =
        refusal_of(triangle(free,
                            "{ring: {type: weld, translation: [1, 0, 0], rotation: [[1, 0, 0], [0, "
                            "1, 0], [0, 0, 1]]}}"));
    EXPECT_NE(turned.find(" and 2.09 rad from where the last body's joint holds it"),
              std::string::npos)
        << turned;
    EXPECT_EQ(refusal_of(triangle(free, "{ring: {type: spherical}}")),
              "key `translation` is missing" + at +
                  ".ring, line 1): add `translation: [1, 0, 0], where the first body's origin is "
                  "in the last body`");
    EXPECT_EQ(refusal_of(triangle(
                  free, "{ring: {type: spherical, translation: [1, 0, 0], anchor: [0, 0, 0]}}")),
              "key `anchor` does not apply to the joint that closes a ring" + at +
                  ".ring.anchor, line 1): leave it out: the bodies define it");
    EXPECT_EQ(refusal_of(triangle(
                  free, "{ring: {type: spherical, translation: [1, 0, 0]}, joint: {type: weld}}")),
              "both `ring` and `joint`" + at + ".ring, line 1): keep one of them");
    EXPECT_EQ(refusal_of(triangle(free, "ring")),
              "`tip: ring` does not define the joint between the last body and the first" + at +
                  ", line 1): write `tip: {ring: {type: spherical, translation: [x, y, z]}}`");
    EXPECT_EQ(refusal_of("chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: "
                         "{type: spherical}}, {mass: 1, inertia: [1, 1, 1], "
                         "joint: {type: spherical, translation: [1, 0, 0]}}], tip: {ring: {type: "
                         "spherical, translation: [1, 0, 0]}}}]"),
              "a ring on a fixed base" + at +
                  ".ring, line 1): write `base: free`, or join the tip to the ground");
    EXPECT_EQ(refusal_of("chains: [{base: free, bodies: [{mass: 1, inertia: [1, 1, 1], joint: "
                         "{type: free}}], tip: {ring: {type: spherical, "
                         "translation: [1, 0, 0]}}}]"),
              "1 bodies do not form a ring" + at + ".ring, line 1): give it 2 or more");
}

TEST(BadTips, of_links) {
    std::string const chain =
        "chains: [{BASEbodies: [{mass: 1, position: [1, 0, 0], joint: {type: link}}, {mass: 1, "
        "position: [2, 0, 0], joint: {type: link}}], "
        "tip: ";
    std::string const free = std::regex_replace(chain, std::regex("BASE"), ""),
                      at = " (s.yaml: chains[0].tip.joint";
    EXPECT_EQ(refusal_of(free + "fixed}]"),
              "a fixed tip of a chain of beads (s.yaml: chains[0].tip, line 1): write `tip: "
              "{joint: {type: link, anchor: [x, y, z]}}`");
    EXPECT_EQ(refusal_of(free + "{joint: {type: spherical}}}]"),
              "a spherical joint at the tip of a chain of beads" + at +
                  ", line 1): write `joint: {type: link, anchor: [x, y, z]}`");
    EXPECT_EQ(refusal_of(free + "{joint: {type: link}}}]"),
              "key `anchor` is missing" + at + ", line 1): add `anchor: [0, 0, 1]`");
    EXPECT_EQ(refusal_of(free + "{joint: {type: link, anchor: [2, 0, 0]}}}]"),
              "the tip's anchor coincides with the last body: their link has no direction" + at +
                  ", line 1): move one of them");
    EXPECT_EQ(refusal_of(free + "{joint: {type: link, anchor: [4, 0, 0], length: 1}}}]"),
              "the tip's link of length 1 cannot reach its anchor: they are 2 apart at the start" +
                  at + ", line 1): leave `length` out, or move the anchor or the chain");
    EXPECT_EQ(refusal_of(free + "{joint: {type: link, anchor: [4, 0, 0], length: 3}}}]"),
              "the tip's link of length 3 is longer than from the last body to its anchor: they "
              "are 2 apart at the start" +
                  at + ", line 1): leave `length` out, or move the anchor or the chain");
    EXPECT_EQ(
        refusal_of(free + "{joint: {type: link, anchor: [4, 0, 0], translation: [0, 0, 0]}}}]"),
        "key `translation` does not apply to a point bead" + at +
            ".translation, line 1): leave it out");
    std::string const fixed = std::regex_replace(chain, std::regex("BASE"), "base: fixed, ");
    EXPECT_EQ(
        refusal_of(fixed + "{joint: {type: link, anchor: [4, 0, 0]}}}]"),
        "the bridge from ground to ground is straight: the forces in its joints are indeterminate" +
            at + ", line 1): start from a bent chain");
    EXPECT_EQ(refusal_of(fixed + "{joint: {type: link, anchor: [2, 1, 0]}}}]"), "accepted");
}

TEST(BadIntegrators, name_the_joint_and_the_remedy) {
    auto const refusal = [](std::string const& joint, std::string const& more,
                            char const* integrator, char const* forces = "") {
        return refusal_of(
            "chains: [{base: fixed, name: a, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: "
            "spherical}}, {mass: 1, inertia: "
            "[1, 1, 1], joint: " +
            joint + more + "}]\ndynamics: {integrator: " + integrator + ", step: 1}" + forces);
    };
    std::string const both = "use `integrator: rk4`, `velocity-verlet` or `dormand-prince`",
                      at = " (s.yaml: dynamics.integrator, line 2): ";
    std::string const moves =
        "integrator rattle moves chains of links or spherical joints, chain `a` has a ";
    EXPECT_EQ(refusal("{type: universal, axes: [[1, 0, 0], [0, 1, 0]]}}]", "", "rattle"),
              moves + "universal joint (joint 2)" + at + both);
    EXPECT_EQ(refusal("{type: weld}}]", "", "rattle"), moves + "weld joint (joint 2)" + at + both);
    EXPECT_EQ(refusal("{type: prismatic, axis: [1, 0, 0]}}]", "", "rattle"),
              moves + "prismatic joint (joint 2)" + at + both);
    EXPECT_EQ(refusal("{type: helical, axis: [1, 0, 0], pitch: 1}}]", "", "rattle"),
              moves + "helical joint (joint 2)" + at + both);
    EXPECT_EQ(refusal("{type: spherical}}]", ", tip: fixed", "rattle"),
              moves + "weld joint (its tip)" + at + both);
    EXPECT_EQ(refusal("{type: spherical}}]", "", "g-baoab", "\nforces: {drag: {linear: 1}}"),
              "drag with integrator g-baoab (s.yaml: forces.drag, line 3): " + both +
                  ", or leave it out (g-baoab has `friction`)");
    EXPECT_EQ(refusal("{type: spherical}, drag: {angular: 1}}]", "", "rattle"),
              "drag with integrator rattle (s.yaml: chains[0], body 2, line 1): " + both +
                  ", or leave it out (g-baoab has `friction`)");
    for (char const* const good : {"rk4", "velocity-verlet"}) {
        EXPECT_EQ(refusal("{type: weld}, drag: {angular: 1}}]", "", good), "accepted");
        EXPECT_EQ(refusal("{type: revolute, axis: [1, 0, 0], motion: {rate: 1}}}]", "", good),
                  "accepted");
    }
    EXPECT_EQ(refusal_of("chains: [{generator: {random: {bodies: 9, joint: link, rigid: 1}}, name: "
                         "a}]\ndynamics: {integrator: "
                         "velocity-verlet, step: 1}"),
              "integrator velocity-verlet works in joint coordinates, chain `a` has links" + at +
                  "use `integrator: rattle` or `g-baoab`");
    EXPECT_EQ(refusal_of("chains: [{generator: {random: {bodies: 9, joint: link, rigid: 1}}, name: "
                         "a}]\ndynamics: {integrator: rattle, step: 1}"),
              "accepted");
}

TEST(BadDrag, values_and_links) {
    std::string const chain = "chains: [{sequence: GGG, model: calvados2, name: a}]\n";
    EXPECT_EQ(refusal_of(chain + "forces: {drag: 1}"),
              "`1` is not a map (s.yaml: forces.drag, line 2): give a map with keys among "
              "`linear`, `angular`");
    EXPECT_EQ(
        refusal_of(chain + "forces: {drag: {linear: -1}}"),
        "linear -1 is negative (s.yaml: forces.drag.linear, line 2): give 0 or a positive number");
    EXPECT_EQ(refusal_of(chain + "forces: {drag: {linear: 1}}"),
              "drag on chain `a`, which has links (s.yaml: forces.drag, line 2): leave it out: "
              "g-baoab has `friction`");
    EXPECT_EQ(refusal_of(arm("{type: weld}, drag: {angular: -1}")),
              "angular -1 is negative (s.yaml: chains[0].bodies[1].drag.angular, body 2, line 1): "
              "give 0 or a positive number");
}

TEST(BadLinked, every_refusal) {
    auto const refusal = [](std::string const& second,
                            std::string const& first = "mass: 1, position: [0, 0, 0]") {
        return refusal_of("chains: [{bodies: [{" + first + "}, {" + second + "}]}]");
    };
    std::string const rigid = "mass: 1, inertia: [1, 1, 1], position: [1, 0, 0], ",
                      at = " (s.yaml: chains[0].bodies[1]";
    EXPECT_EQ(refusal(rigid + "joint: {type: link, length: 1.001}"),
              "the link's length is 1.001, its ends are 1 apart" + at +
                  ".joint.length, body 2, line 1): correct the positions, or leave "
                  "`length` out");
    EXPECT_EQ(refusal(rigid + "joint: {type: link}, wrench: {force: [1, 0, 0]}"),
              "key `wrench` does not apply to a chain of links" + at +
                  ".wrench, body 2, line 1): leave it out");
    EXPECT_EQ(refusal(rigid + "joint: {type: link}, residue: ALA"),
              "key `residue` does not apply to a rigid body" + at +
                  ".residue, body 2, line 1): give it `beads: [{residue: ALA, position: "
                  "[0, 0, 0]}]`");
    EXPECT_EQ(refusal(rigid + "joint: {type: link, translation: [1, 0, 0]}"),
              "a translation for a link that starts at bead 1, a point" + at +
                  ".joint.translation, body 2, line 1): leave it out");
    EXPECT_EQ(refusal("mass: 1, inertia: [1, 1, 1], position: [0, 0, 0], joint: {type: link}"),
              "the ends of link 2 coincide: it has no direction" + at +
                  ", body 2, line 1): move one of its bodies");
    EXPECT_EQ(refusal("mass: 1, position: [1, 0, 0], omega: [1, 0, 0], joint: {type: link}",
                      "mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]"),
              "key `omega` does not apply to a point bead on a link" + at +
                  ".omega, body 2, line 1): leave it out or give `inertia`");
    EXPECT_EQ(refusal(rigid + "joint: {type: link}",
                      "mass: 1, position: [0, 0, 0], joint: {type: link, length: 1}"),
              "a link length for body 1 of a free base, which has no link (s.yaml: "
              "chains[0].bodies[0].joint.length, body 1, line 1): leave it "
              "out or write `base: fixed`");
    EXPECT_EQ(refusal("mass: 1, inertia: [0, 1, 1], position: [1, 0, 0], joint: {type: link}"),
              "the inertia is singular: its principal moments are 0, 1, 1" + at +
                  ".inertia, body 2, line 1): give the point mass or thin rod a "
                  "bead radius r: add 0.4 m r^2 to the diagonal");
    EXPECT_EQ(
        refusal(rigid + "joint: {type: link}, beads: [{residue: ALA}]"),
        "key `position` is missing" + at + ".beads[0], body 2, line 1): add `position: [0, 0, 0]`");
    EXPECT_EQ(
        refusal(rigid + "joint: {type: link}", "mass: 1, inertia: [1, 1, 1], joint: {type: weld}"),
        "a joint of type `weld` in a chain of links (s.yaml: chains[0].bodies[0].joint, body 1, "
        "line 1): make it a link, or give every "
        "joint another type");
}

TEST(BadGenerators, distributions_and_shapes) {
    auto const refusal = [](std::string const& generator) {
        return refusal_of("chains: [{generator: {" + generator + "}}]");
    };
    auto const of_mass = [&](std::string const& mass) {
        return refusal("pendulum: {links: 3, mass: " + mass + "}");
    };
    std::string const at = " (s.yaml: chains[0].generator.pendulum.mass";
    EXPECT_EQ(of_mass("-1"), "mass -1 is not positive" + at + ", line 1): give a number above 0");
    EXPECT_EQ(
        of_mass("{}"),
        "the distribution has 0 kinds" + at +
            ", line 1): give a number or one of `uniform`, `log_uniform`, `normal`, `choice`");
    EXPECT_EQ(of_mass("{gauss: [1, 2]}"),
              "unknown key `gauss`" + at +
                  ".gauss, line 1): use one of `uniform`, `log_uniform`, `normal`, `choice`");
    EXPECT_EQ(of_mass("{uniform: [2, 1]}"), "the bounds 2 and 1 are not positive and ascending" +
                                                at +
                                                ".uniform, line 1): give [least, most] above 0");
    EXPECT_EQ(of_mass("{log_uniform: [0, 1]}"),
              "the bounds 0 and 1 are not positive and ascending" + at +
                  ".log_uniform, line 1): give [least, most] above 0");
    EXPECT_EQ(of_mass("{normal: [-1, 1]}"),
              "a normal distribution with mean -1 and standard deviation 1" + at +
                  ".normal, line 1): give a mean above 0 and a standard deviation of 0 or more: "
                  "values are redrawn until they are above 0");
    EXPECT_EQ(of_mass("{choice: []}"),
              "the list of choices is empty" + at + ".choice, line 1): give at least one number");
    EXPECT_EQ(of_mass("{choice: [1, 0]}"),
              "choice 0 is not positive" + at + ".choice[1], line 1): give a number above 0");
    EXPECT_EQ(refusal("random: {bodies: 3, joint: weld, rigid: 0.5}"),
              "a fraction of rigid bodies in a chain that has no beads (s.yaml: "
              "chains[0].generator.random.rigid, line 1): leave it out or write "
              "`joint: link`");
    EXPECT_EQ(
        refusal("random: {bodies: 3, joint: link, rigid: 1.5}"),
        "1.5 is not a fraction (s.yaml: chains[0].generator.random.rigid, line 1): give 0 to 1");
    EXPECT_EQ(refusal("dill: {bodies: 3, ratio: 2}"),
              "ratio 2 is above 1 (s.yaml: chains[0].generator.dill.ratio, line 1): give a number "
              "above 0, at most 1");
    EXPECT_EQ(refusal("worm_like: {bodies: 3, length: 1}"),
              "key `persistence` is missing (s.yaml: chains[0].generator.worm_like, line 1): add "
              "`persistence: 50`");
    EXPECT_EQ(refusal("worm_like: {bodies: 3, length: 1, persistence: 0}"),
              "persistence 0 is not positive (s.yaml: chains[0].generator.worm_like.persistence, "
              "line 1): give a number above 0");
}

}  // namespace
}  // namespace catena::test
