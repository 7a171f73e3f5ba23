// Other programs on the stability suite's chains: those that are here agree with articulated bodies
// in 113 bits, and made-up ones stop.
#include "bench/peer_answers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "bench/peer_chain.hpp"
#include "measure/growth.hpp"
#include "reader/load_scene.hpp"

namespace catena::test {
namespace {

using namespace catena::command;

StabilityCase case_of(std::string const& family, std::string const& name) {
    for (StabilityCase const& each : stability_cases(64, false))
        if (each.family == family && each.name == name) return each;
    throw std::runtime_error("no such case: " + family + ", " + name);
}

/// Five bodies: among more on ball joints Pinocchio loses every digit.
Scene random_chain(std::string const& joint, std::string const& base) {
    std::string const chain = "{name: a, base: " + base +
                              ", generator: {random: {bodies: 5, joint: " + joint + ", seed: 7}}}";
    return parse_scene("units: si\nchains: [" + chain + "]\nforces: {gravity: [1, -3, -5]}\n",
                       "random", {});
}

Scene with_springs_and_dampers(Scene scene) {
    BodyArrays& b = scene.chains[0].bodies;
    b.stiffness.assign(b.size(), Vec3{{3, 2, 1}});
    b.damping.assign(b.size(), Vec3{{0.3, 0.2, 0.1}});
    b.rest = b.q;
    std::rotate(b.rest.begin(), b.rest.begin() + 1, b.rest.end());
    if (b.joint[0] == JointType::free) b.stiffness[0] = b.damping[0] = Vec3::zero();
    return scene;
}

/// Free bodies, beads, springs, dampers, wrenches and torques go through the table and back, in a
/// process that takes them all.
TEST(PeerAnswers, ThoseThatAreHereAgree) {
    Peer::Limits limits = limits_of_suite();
    limits.memory_bytes =
        std::numeric_limits<std::int64_t>::max();  // a sanitizer takes what addresses there are
    PeerAnswers peers(peers_of_suite(), limits);
    for (std::string const& line : peers.not_run()) std::puts(line.c_str());
    if (peers.not_run().size() == peers.json().size()) GTEST_SKIP() << "NOT RUN: no peer is here";
    double const allowed = std::sqrt(
        0x1p-53);  // a mistake in the table changes more; roundings are a peer's own affair
    std::vector<Scene> scenes{random_chain("link", "free")};
    for (char const* const joint : {"revolute", "spherical"})
        for (char const* const base : {"fixed", "free"})
            scenes.insert(scenes.end(), {random_chain(joint, base),
                                         with_springs_and_dampers(random_chain(joint, base))});
    scenes.push_back(case_of("units", "molecule in SI, revolute joints").scene(1));
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        Solution found = layout_of(scenes[i]);
        ExactSolution const exact = exact_solution(scenes[i], found, 100, 1);
        for (PeerAnswer const& answer :
             peers({"any", std::to_string(i), scenes[i].bodies(), {}}, scenes[i])) {
            ASSERT_EQ(answer.acceleration.size(), exact.acceleration.size())
                << answer.name << ", " << i << ": " << answer.why_not;
            found.acceleration = answer.acceleration;
            EXPECT_LE(largest_difference(scenes[i], found, exact.acceleration), allowed)
                << answer.name << ", " << i;
        }
    }
    for (Json const& peer : peers.json())
        EXPECT_NE(peer.contains("not_run"), peer.contains("version")) << peer;
}

TEST(PeerAnswers, ChainsThatTheTableCannotHoldAreNotAskedAbout) {
    EXPECT_EQ(not_for_peers(case_of("bridge of beads", "1e-2").scene(1)), "a closed chain");
    Scene scene = case_of("spinning", "1e2").scene(1);
    EXPECT_EQ(not_for_peers(scene), "");
    scene.chains[0].bodies.joint[3] = JointType::universal;
    EXPECT_EQ(not_for_peers(scene), "joints neither revolute nor spherical");
    scene = case_of("coil", "16 bodies").scene(1);
    scene.chains[0].bodies.drag.assign(16, {0, 0.5});
    EXPECT_EQ(not_for_peers(scene), "forces that they lack (drag)");
    scene.chains[0].bodies.drag.clear();
    EXPECT_EQ(not_for_peers(scene), "");
    scene.forces.linear_drag = 1;
    EXPECT_EQ(not_for_peers(scene), "forces that they lack (drag)");
    scene.chains.push_back(scene.chains[0]);
    EXPECT_EQ(not_for_peers(scene), "not a single chain");
    scene =
        parse_scene("chains: [{generator: {freely_jointed: {beads: 9, length: 0.5}}}]", "s.yaml");
    EXPECT_EQ(not_for_peers(scene), "");
    scene.chains[0].crosslinks = {{0, 5, 1}};
    EXPECT_EQ(not_for_peers(scene), "a cross-linked chain");
    scene = parse_scene("chains: [{generator: {star: {arms: 3, arm_length: 2, length: 0.5}}}]",
                        "s.yaml");
    EXPECT_EQ(not_for_peers(scene), "a branched chain");
}

PeerProgram made_up(std::string const& name, std::string const& script) {
    return {name, {"/bin/sh", "-c", script, "sh"}, {}, ""};
}

TEST(PeerAnswers, OneThatStopsIsAskedAboutNoLongerChainOfThatFamily) {
    PeerAnswers peers(
        {made_up("full", R"(echo '{"stops": "no memory left"}')"),
         made_up(
             "empty",
             R"(: > "$2"; echo '{"version": "0"}'; while read line; do echo '{"version": "0"}'; done)"),
         {"absent", {}, {}, "it is not here"}},
        limits_of_suite());
    auto const ask = [&](std::string const& family, std::string const& name) {
        StabilityCase const which = case_of(family, name);
        std::vector<PeerAnswer> const answers = peers(which, which.scene(1));
        EXPECT_EQ(answers.size(), 2U);
        EXPECT_EQ(answers.at(1).why_not, "");
        EXPECT_TRUE(answers.at(1).acceleration.empty());
        return answers.at(0).why_not;
    };
    EXPECT_EQ(ask("coil", "16 bodies"), "no memory left");
    EXPECT_EQ(ask("coil", "64 bodies"), "at 16 bodies: no memory left");
    EXPECT_EQ(ask("dill", "16 bodies"), "no memory left");
    EXPECT_EQ(ask("springs", "1e2, each revolute joint"), "no memory left");
    EXPECT_EQ(ask("springs", "1e6, each revolute joint"),
              "no memory left");  // as long as the one before
    EXPECT_EQ(peers.not_run(), std::vector<std::string>{"NOT RUN: absent: it is not here"});
}

TEST(PeerAnswers, OneThatIsTooSlowIsNotAskedAgain) {
    PeerAnswers peers(
        {made_up("slow", "exec sleep 60")},
        {std::chrono::milliseconds(300), std::chrono::seconds(1), limits_of_suite().memory_bytes});
    StabilityCase const which = case_of("coil", "16 bodies");
    for (char const* const begins :
         {"building the chain and evaluating it once takes more than 300",
          "at 16 bodies: building"}) {
        std::string const why_not = peers(which, which.scene(1)).at(0).why_not;
        EXPECT_TRUE(why_not.starts_with(begins)) << why_not;
    }
}

/// None ends the suite, or makes it wait for ever.
TEST(PeerAnswers, NonsenseIsWhyThereIsNoAnswer) {
    // The first one has said too much long before the second question: the deaf one takes a second.
    PeerAnswers peers(
        {made_up("hasty",
                 R"(: > "$2"; echo '{"version": "0"}'; echo '{"version": "0"}'; exec sleep 60)"),
         made_up("number", R"(echo '{"stops": 3}'; sleep 60)"),
         made_up("version", R"(echo '{"version": 4}'; sleep 60)"),
         made_up("words", "echo hello; sleep 60"), made_up("deaf", "exec >&- <&-; sleep 60"),
         made_up("endless", "exec cat /dev/zero")},
        limits_of_suite());
    StabilityCase const first = case_of("coil", "16 bodies"), second = case_of("coil", "64 bodies");
    std::vector<PeerAnswer> const answers = peers(first, first.scene(1));
    ASSERT_EQ(answers.size(), 6U);
    EXPECT_EQ(answers[0].why_not, "");
    char const* const begins[] = {"unreadable answer", "unreadable answer", "unreadable answer",
                                  "it closed its output", "unterminated line"};
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_TRUE(answers[i + 1].why_not.starts_with(begins[i]))
            << answers[i + 1].name << ": " << answers[i + 1].why_not;
    std::string const why_not = peers(second, second.scene(1)).at(0).why_not;
    EXPECT_TRUE(why_not.starts_with("unexpected output")) << why_not;
}

}  // namespace
}  // namespace catena::test
