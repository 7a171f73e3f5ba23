// Joints of every type, tips, drag and carried beads, as the arrays hold them.
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "scene/pose.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

std::string const body = "mass: 1, inertia: [1, 1, 1]";

std::string list_of(std::vector<std::string> const& joints, std::string const& chain = "") {
    std::string text;
    for (std::string const& joint : joints)
        text += (text.empty() ? "{" : ", {") + body + ", joint: " + joint + "}";
    return "chains: [{base: fixed, bodies: [" + text + "]" + (chain.empty() ? "" : ", " + chain) +
           "}]";
}
ChainSpec chain_of(std::string const& yaml) { return parse_scene(yaml, "s.yaml").chains.at(0); }

TEST(Joints, every_type) {
    BodyArrays const b =
        chain_of(list_of({"{type: universal, axes: [[2, 0, 0], [0, 0, 3]], q: [0.1, 0.2], qd: [1, "
                          "2], torque: [3, 4], "
                          "stiffness: 5, damping: [6, 7], rest: [0.3, 0.4]}",
                          "{type: weld, translation: [1, 0, 0]}",
                          "{type: prismatic, axis: [0, 1, 0], q: 0.5, qd: 2, torque: 3, stiffness: "
                          "4, damping: 5, rest: 6}",
                          "{type: helical, axis: [0, 0, 1], pitch: -0.25, q: 2, qd: 1}"}))
            .bodies;
    EXPECT_EQ(b.joint, (std::vector<JointType>{JointType::universal, JointType::weld,
                                               JointType::prismatic, JointType::helical}));
    EXPECT_EQ(b.first_axis[0][0], 1);
    EXPECT_EQ(b.axis[0][2], 1);
    EXPECT_EQ(b.q[0], (std::array<double, 4>{0.1, 0.2, 0, 0}));
    EXPECT_EQ(b.qd[0][1], 2);
    EXPECT_EQ(b.torque[0][1], 4);
    EXPECT_EQ(b.stiffness[0][0], 5);
    EXPECT_EQ(b.stiffness[0][1], 5);
    EXPECT_EQ(b.stiffness[0][2], 0);
    EXPECT_EQ(b.damping[0][1], 7);
    EXPECT_EQ(b.rest[0], (std::array<double, 4>{0.3, 0.4, 0, 0}));
    EXPECT_EQ(b.q[1], (std::array<double, 4>{0, 0, 0, 0}));
    EXPECT_EQ(b.q[2], (std::array<double, 4>{0.5, 0, 0, 0}));
    EXPECT_EQ(b.torque[2][0], 3);
    EXPECT_EQ(b.rest[2][0], 6);
    EXPECT_EQ(b.pitch, (std::vector<double>{0, 0, 0, -0.25}));
    EXPECT_TRUE(b.driven.empty() && b.drag.empty() && b.carried.offset.empty());
}

TEST(Joints, cylindrical_and_planar3) {
    BodyArrays const b =
        chain_of(list_of({"{type: cylindrical, axis: [0, 0, 2], q: [0.1, 0.2], qd: [1, 2], torque: "
                          "[3, 4], stiffness: [5, 6], damping: [7, 8], rest: [0.3, 0.4]}",
                          "{type: planar3, axes: [[2, 0, 0], [0, 0, 3]], q: [0.1, 0.2, 0.3], qd: "
                          "[1, 2, 3], torque: [4, 5, 6], stiffness: [7, 8, 9], rest: [0.4, 0.5, "
                          "0.6]}",
                          "{type: cylindrical, axis: [1, 0, 0], motion: [{rate: 1}, {offset: 0.5, "
                          "rate: 2}]}"}))
            .bodies;
    EXPECT_EQ(b.joint, (std::vector<JointType>{JointType::cylindrical, JointType::planar3,
                                               JointType::cylindrical}));
    EXPECT_EQ(b.axis[0][2], 1);
    EXPECT_EQ(b.q[0], (std::array<double, 4>{0.1, 0.2, 0, 0}));
    EXPECT_EQ(b.rest[0], (std::array<double, 4>{0.3, 0.4, 0, 0}));
    EXPECT_TRUE(b.stiffness[0][1] == 6 && b.damping[0][1] == 8 && b.torque[0][1] == 4);
    EXPECT_TRUE(b.first_axis[1][0] == 1 && b.axis[1][2] == 1);
    EXPECT_EQ(b.q[1], (std::array<double, 4>{0.1, 0.2, 0.3, 0}));
    EXPECT_EQ(b.rest[1], (std::array<double, 4>{0.4, 0.5, 0.6, 0}));
    EXPECT_TRUE(b.qd[1][2] == 3 && b.torque[1][2] == 6 && b.stiffness[1][2] == 9);
    ASSERT_EQ(b.driven.size(), 1u);
    EXPECT_EQ(b.driven[0].course[1].rate, 2);
    EXPECT_TRUE(b.q[2][1] == 0.5 && b.qd[2][0] == 1 && b.qd[2][1] == 2);
}

/// The direction of the first translation is made perpendicular to the normal to rounding.
TEST(Joints, planes_are_level_to_rounding) {
    BodyArrays const b =
        chain_of(list_of({"{type: planar3, axes: [[1, 2, 2.0000003], [2, 1, -2]]}"})).bodies;
    EXPECT_LE(std::abs(dot(b.first_axis[0], b.axis[0])), 4e-16);
    EXPECT_NEAR(norm(b.first_axis[0]), 1, 4e-16);
    EXPECT_NEAR(b.first_axis[0][0], 1.0 / 3, 1e-6);
}

TEST(Joints, arrays_of_what_there_is_not_stay_empty) {
    BodyArrays const b =
        chain_of(list_of({"{type: spherical}", "{type: revolute, axis: [0, 0, 1]}"})).bodies;
    EXPECT_TRUE(b.first_axis.empty() && b.pitch.empty() && b.drag.empty());
}

TEST(Joints, motions) {
    BodyArrays const b =
        chain_of(
            list_of({"{type: spherical}",
                     "{type: helical, axis: [0, 0, 1], pitch: 1, motion: {offset: 0.5, rate: 2}}",
                     "{type: universal, axes: [[1, 0, 0], [0, 1, 0]], motion: [{amplitude: 3, "
                     "frequency: 0.25, phase: 0.1}, {rate: 1}]}"}))
            .bodies;
    ASSERT_EQ(b.driven.size(), 2u);
    EXPECT_EQ(b.driven[0].body, 1);
    EXPECT_EQ(b.driven[0].course[0].rate, 2);
    EXPECT_EQ(b.driven[1].body, 2);
    EXPECT_EQ(b.driven[1].course[0].amplitude, 3);
    EXPECT_EQ(b.driven[1].course[1].rate, 1);
    EXPECT_EQ(b.q[1][0], 0.5);
    EXPECT_EQ(b.qd[1][0], 2);
    EXPECT_DOUBLE_EQ(b.q[2][0], 3 * std::sin(0.1));
    EXPECT_DOUBLE_EQ(b.qd[2][0], 3 * std::cos(0.1) * std::acos(-1.0) / 2);
    double const h = 1e-5;
    PrescribedMotion const& c = b.driven[1].course[0];
    EXPECT_NEAR((scene::value_at(c, 1 + h) - scene::value_at(c, 1 - h)) / (2 * h),
                scene::rate_at(c, 1), 1e-9);
}

TEST(Joints, drag_of_a_body_goes_before_the_scenes) {
    std::string const scene =
        list_of({"{type: spherical}", "{type: spherical}, drag: {linear: 3}"}) +
        "\nforces: {drag: {linear: 1, angular: 2}}";
    Scene const s = parse_scene(scene, "s.yaml");
    EXPECT_EQ(s.forces.linear_drag, 1);
    EXPECT_EQ(s.forces.angular_drag, 2);
    auto const& drag = s.chains[0].bodies.drag;
    EXPECT_EQ(drag, (std::vector<std::array<double, 2>>{{1, 2}, {3, 0}}));
}

TEST(Joints, carried_beads) {
    CarriedBeads const c = chain_of(list_of({"{type: spherical}",
                                             "{type: spherical}, beads: [{residue: ALA, position: "
                                             "[1, 2, 3], mass: 71}, {position: [0, 0, 0]}]",
                                             "{type: spherical}"}))
                               .bodies.carried;
    EXPECT_EQ(c.offset, (std::vector<std::int64_t>{0, 0, 2, 2}));
    EXPECT_EQ(c.residue, (std::vector<std::string>{"ALA", "UNK"}));
    EXPECT_EQ(c.position[0][2], 3);
    EXPECT_EQ(c.mass, (std::vector<double>{71, 1}));
}

TEST(Joints, planar_is_revolute_with_parallel_axes) {
    std::string const turned = "rotation: [[1, 0, 0], [0, 0, -1], [0, 1, 0]]";
    ChainSpec const chain = chain_of(
        list_of({"{type: planar, axis: [0, 0, 1], " + turned + "}", "{type: weld, " + turned + "}",
                 "{type: planar, axis: [0, 1, 0]}", "{type: revolute, axis: [0, -1, 0], q: 1}"}));
    EXPECT_EQ(chain.bodies.joint[2], JointType::revolute);
    EXPECT_EQ(scene::handle_kind(chain), scene::HandleKind::full);  // the weld
    EXPECT_EQ(scene::handle_kind(chain_of(list_of(
                  {"{type: revolute, axis: [0, 0, 1]}", "{type: revolute, axis: [0, 0, -2]}"}))),
              scene::HandleKind::planar);
}

TEST(Joints, handle_kinds_and_degrees_of_freedom) {
    struct Case {
        std::vector<std::string> joints;
        std::string chain;
        scene::HandleKind kind;
        std::int64_t dof;
    };
    std::string const x = "{type: revolute, axis: [1, 0, 0], translation: [0, 0, 1]}",
                      z = "{type: revolute, axis: [0, 0, 1], translation: [1, 0, 0]}";
    std::string const ball = "{type: spherical, translation: [1, 0, 0]}",
                      cross = "{type: universal, axes: [[1, 0, 0], [0, 1, 0]]}";
    using enum scene::HandleKind;
    Case const cases[] = {
        {{x, z}, "", revolute, 2},
        {{z, z, z, z}, "", planar, 4},
        {{z, z, z, z}, "tip: {joint: {type: planar, axis: [0, 0, 1]}}", planar, 2},
        {{x, z, x, z, x, z, z}, "tip: fixed", full, 1},
        {{ball, ball}, "", spherical, 6},
        {{ball, cross}, "", universal, 5},
        {{ball, cross, "{type: prismatic, axis: [1, 0, 0]}"}, "", revolute, 6},
        {{"{type: helical, axis: [1, 0, 0], pitch: 1}"}, "", revolute, 1},
        {{ball, "{type: cylindrical, axis: [1, 0, 0]}"}, "", revolute, 5},
        {{ball, "{type: planar3, axes: [[1, 0, 0], [0, 0, 1]]}"}, "", revolute, 6},
        {{"{type: planar3, axes: [[1, 0, 0], [0, 0, 1]]}", z, z}, "", revolute, 5},
        {{"{type: planar3, axes: [[1, 0, 0], [0, 0, 1]]}", z, z},
         "tip: {joint: {type: revolute, axis: [0, 0, 1]}}",
         revolute,
         3},
        {{z, z, "{type: weld, translation: [1, 0, 0]}"},
         "tip: {joint: {type: planar3, axes: [[1, 0, 0], [0, 0, 1]]}}",
         full,
         2},
        {{z, z},
         "tip: {joint: {type: cylindrical, axis: [0, 0, 1], translation: [1, 0, 0]}}",
         revolute,
         0},
        {{ball, "{type: weld}"}, "", full, 3},
        {{ball, "{type: revolute, axis: [1, 0, 0], motion: {rate: 1}}"}, "", full, 3},
        {{ball, "{type: spherical, translation: [0, 1, 0]}"},
         "tip: {joint: {type: spherical, translation: [1, 0, 0]}}",
         spherical,
         3},
        {{ball, ball, ball}, "tip: fixed", full, 3},
        {{ball, ball, ball},
         "tip: {joint: {type: universal, axes: [[1, 0, 0], [0, 1, 0]]}}",
         universal,
         5},
    };
    for (Case const& c : cases) {
        ChainSpec const chain = chain_of(list_of(c.joints, c.chain));
        EXPECT_EQ(scene::handle_kind(chain), c.kind) << list_of(c.joints, c.chain);
        EXPECT_EQ(scene::degrees_of_freedom(chain), c.dof) << list_of(c.joints, c.chain);
    }
}

TEST(Tips, planar_loops_may_need_full_handles) {
    auto const loop = [](std::string const& last, std::string const& tip) {
        return list_of({"{type: revolute, axis: [0, 0, 1]}",
                        "{type: revolute, axis: [0, 0, 1], translation: [1, 0, 0], q: 1}",
                        "{type: revolute, axis: [0, 0, 1], translation: [1, 0, 0], q: 1}", last},
                       tip);
    };
    std::string const free = "{type: revolute, axis: [0, 0, 1], translation: [1, 0, 0], q: 1",
                      pin = "tip: {joint: {type: spherical}}";
    EXPECT_NO_THROW(parse_scene(loop(free + "}", pin), "s.yaml"));
    for (std::string const& loose :
         {loop("{type: revolute, axis: [0, 0, 1], translation: [1, 0, 0], motion: {rate: 1}}", pin),
          loop("{type: weld, translation: [1, 0, 0]}", pin), loop(free + "}", "tip: fixed"),
          loop(free + "}", pin) + "\nsolver: {handles: full}"})
        EXPECT_EQ(refusal_of(loose), "accepted");
}

TEST(Tips, anchors_are_checked_by_forward_kinematics) {
    // Two rods of length 1, turned by q1 about z, then the second by q2 about its own y; the tip
    // slides by 0.25 along x.
    double const q1 = 0.3, q2 = -0.4;
    Vec3 const along{{std::cos(q1) * std::cos(q2), std::sin(q1) * std::cos(q2), -std::sin(q2)}};
    Vec3 const end = Vec3{{std::cos(q1), std::sin(q1), 0}} + 1.25 * along;
    std::string const anchor = fmt::format("[{:.17g}, {:.17g}, {:.17g}]", end[0], end[1], end[2]);
    ChainSpec const chain =
        chain_of(list_of({"{type: revolute, axis: [0, 0, 1], q: 0.3}",
                          "{type: revolute, axis: [0, 1, 0], translation: [1, 0, 0], q: -0.4}",
                          "{type: spherical}", "{type: spherical}"},
                         "tip: {joint: {type: prismatic, axis: [1, 0, 0], translation: [1, 0, 0], "
                         "q: 0.25, anchor: " +
                             anchor + "}}"));
    EXPECT_EQ(chain.tip, Tip::jointed);
    EXPECT_EQ(chain.tip_joint.type, JointType::prismatic);
    EXPECT_EQ(chain.tip_joint.q[0], 0.25);
    EXPECT_EQ((*chain.tip_joint.anchor)[0], end[0]);
}

TEST(Tips, links) {
    std::string const beads =
        "chains: [{bodies: [{mass: 1, position: [0, 0, 0], joint: {type: link}}, {mass: 1, "
        "position: [1, 0, 0], joint: {type: link}}], ";
    ChainSpec const chain = chain_of(beads + "tip: {joint: {type: link, anchor: [1, 2, 0]}}}]");
    EXPECT_EQ(chain.tip_joint.length, 2);
    EXPECT_EQ(scene::degrees_of_freedom(chain), 4);
    EXPECT_EQ(
        chain_of(beads + "tip: {joint: {type: link, anchor: [1, 2, 0], length: 2.000000001}}}]")
            .tip_joint.length,
        2.000000001);
}

TEST(Tips, a_fixed_one_is_a_weld_where_it_is) {
    ChainSpec const chain =
        chain_of(list_of({"{type: spherical}", "{type: spherical}"}, "tip: fixed"));
    EXPECT_EQ(chain.tip_joint.type, JointType::weld);
    EXPECT_FALSE(chain.tip_joint.anchor);
}

TEST(Tips, move_with_the_copies_of_their_chain) {
    Scene const scene = parse_scene(
        "chains: [{count: 3, name: a, base: fixed, bodies: [{mass: 1, position: [1, 0, 0], joint: "
        "{type: link}}, {mass: 1, position: [1, "
        "1, 0], "
        "joint: {type: link}}], tip: {joint: {type: link, anchor: [0, 2, 0]}}}, {count: 2, name: "
        "b, generator: {random: {bodies: 20, "
        "joint: "
        "link, rigid: 0.5}}}]",
        "s.yaml");
    ASSERT_EQ(scene.chains.size(), 5u);
    for (int i = 0; i < 3; ++i) {
        ChainSpec const& chain = scene.chains[static_cast<std::size_t>(i)];
        EXPECT_NEAR(norm(*chain.tip_joint.anchor - chain.beads.position[1]), std::sqrt(2.0), 1e-12);
        EXPECT_NEAR(norm(*chain.tip_joint.anchor - chain.beads.anchor), 2, 1e-12);
    }
    EXPECT_GT(norm(scene.chains[0].beads.position[0] - scene.chains[1].beads.position[0]), 1);
    EXPECT_GT(norm(scene.chains[3].linked.position[0] - scene.chains[4].linked.position[0]), 1);
}

TEST(Hash, guards_everything_that_is_new) {
    auto const hash = [](std::string const& yaml) { return parse_scene(yaml, "s.yaml").hash; };
    std::string const second = "{type: revolute, axis: [1, 0, 0]";
    std::vector<std::string> scenes{
        list_of({"{type: spherical}", second + "}"}),
        list_of({"{type: spherical}", second + ", motion: {rate: 1}}"}),
        list_of({"{type: spherical}", second + ", motion: {rate: 1, phase: 0.1}}"}),
        list_of({"{type: spherical}", second + "}, drag: {linear: 1}"}),
        list_of({"{type: spherical}", second + "}, beads: [{position: [0, 0, 0]}]"}),
        list_of({"{type: spherical}", second + "}, beads: [{position: [0, 0, 1]}]"}),
        list_of({"{type: spherical}", second + "}"}) + "\nforces: {drag: {angular: 1}}",
        list_of({"{type: spherical}", "{type: helical, axis: [1, 0, 0], pitch: 1}"}),
        list_of({"{type: spherical}", "{type: helical, axis: [1, 0, 0], pitch: 2}"}),
        list_of({"{type: spherical}", "{type: universal, axes: [[0, 1, 0], [1, 0, 0]]}"}),
        list_of({"{type: spherical}", "{type: universal, axes: [[0, 0, 1], [1, 0, 0]]}"}),
        list_of({"{type: spherical}", "{type: spherical}"}, "tip: fixed"),
        list_of({"{type: spherical}", "{type: spherical}"},
                "tip: {joint: {type: revolute, axis: [1, 0, 0]}}"),
        "chains: [{generator: {random: {bodies: 3, joint: link, rigid: 1, seed: 1}}}]",
        "chains: [{generator: {random: {bodies: 3, joint: link, rigid: 1, seed: 2}}}]"};
    std::set<std::string> hashes;
    for (std::string const& yaml : scenes) hashes.insert(hash(yaml));
    EXPECT_EQ(hashes.size(), scenes.size());
}

TEST(Dynamics, velocity_verlet) {
    EXPECT_EQ(parse_scene(
                  list_of({"{type: weld}"}) + "\ndynamics: {integrator: velocity-verlet, step: 1}",
                  "s.yaml")
                  .dynamics.integrator,
              Integrator::velocity_verlet);
}

/// Three revolute joints about parallel axes, closed by a weld: nothing can move.
TEST(Tips, rates_that_a_loop_loses_are_noted) {
    std::string const revolute = "{type: revolute, axis: [0, 0, 1], q: 1, translation: [1, 0, 0]",
                      note = "the loop of chain `chain` has no degrees of freedom";
    auto const notes = [&](std::string const& rate, std::string const& chain) {
        std::string text;
        std::string const scene = list_of({revolute + "}", revolute + rate + "}", revolute + "}"},
                                          "name: chain, " + chain);
        for (std::string const& one : parse_scene(scene, "s.yaml").notes) text += one + "\n";
        return text;
    };
    std::string const weld = "tip: {joint: {type: weld}}",
                      turning = "tip: {joint: {type: revolute, axis: [0, 0, 1]}}";
    EXPECT_NE(notes(", qd: 2", weld).find(note), std::string::npos) << notes(", qd: 2", weld);
    EXPECT_EQ(notes("", weld).find(note), std::string::npos);
    EXPECT_EQ(notes(", qd: 2", turning).find(note), std::string::npos);
    EXPECT_EQ(notes(", qd: 2", weld + ", velocities: zero").find(note), std::string::npos);
}

}  // namespace
}  // namespace catena::test
