// Rigid bodies and beads on links, and rigid domains of proteins.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "error.hpp"
#include "reader/load_scene.hpp"
#include "scene/freedom.hpp"
#include "tests/io/temporary_folder.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

double constexpr eps = 2.3e-16;

ChainSpec chain_of(std::string const& yaml) { return parse_scene(yaml, "s.yaml").chains.at(0); }

Vec3 point(LinkedArrays const& l, std::size_t k, Vec3 const& in_body) {
    auto const& q = l.orientation[k];
    return l.position[k] + to_matrix(Quat{q[0], q[1], q[2], q[3]}) * in_body;
}

void expect_closed_links(ChainSpec const& chain) {
    LinkedArrays const& l = chain.linked;
    for (std::size_t k = chain.base == Base::fixed ? 0 : 1; k < l.size(); ++k) {
        Vec3 const from = k == 0 ? l.anchor : point(l, k - 1, l.outboard[k - 1]),
                   to = point(l, k, l.inboard[k]);
        EXPECT_NEAR(norm(to - from), l.length[k], 64 * eps * (1 + norm(to)) + 1e-9 * l.length[k])
            << k;
    }
}

/// A link that is long by design has no length that a nearest image would fit better.
TEST(Linked, the_first_of_long_links_is_left_and_noted) {
    Scene const scene = parse_scene(
        "box: {periodic: [3, 3, 3]}\n"
        "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], position: [0, 0, 1.7], "
        "joint: {type: link}},\n"
        "{mass: 1, position: [0.3, 0, 1.7], joint: {type: link}}]}]\n",
        "scene.yaml");
    EXPECT_EQ(scene.chains[0].linked.length[0], 1.7);
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].find(
                  "the link to body 1 is 1.7 long, more than half an edge of the periodic box"),
              std::string::npos);
}

/// Right: the bodies are 1 apart across the side of the box, as rods that the side cuts.
TEST(Linked, bodies_that_the_box_cuts_are_made_whole) {
    std::string const chain =
        "chains: [{bodies: [{mass: 1, inertia: [1, 1, 1], position: [9.5, 5, 5]}, {mass: 1, "
        "position: [0.5, 5, 5], joint: {type: link}}, "
        "{mass: 1, inertia: [1, 1, 1], position: [0.5, 9.75, 5], joint: {type: link}}]}]";
    EXPECT_TRUE(parse_scene(chain, "s.yaml").notes.empty());
    Scene const scene = parse_scene("box: {periodic: [10, 10, 10]}\n" + chain, "s.yaml");
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].find("1 link of chain `chain-1` is cut by the sides of the periodic "
                                  "box, the first that of body 2"),
              std::string::npos)
        << scene.notes[0];
    LinkedArrays const& l = scene.chains.at(0).linked;
    EXPECT_EQ(l.length, (std::vector<double>{0, 1, 4.75}));
    EXPECT_EQ(l.position[1][0], 10.5);
    EXPECT_EQ(l.position[2][0], 10.5);
    EXPECT_EQ(l.position[2][1], 9.75);
    expect_closed_links(scene.chains.at(0));
}

TEST(Linked, a_given_length_says_which_image_is_meant) {
    auto const chain = [](std::string const& length) {
        return parse_scene(
            "box: {periodic: [10, 10, 10]}\nchains: [{bodies: [{mass: 1, inertia: [1, 1, 1], "
            "position: [9.5, 5, 5]}, {mass: 1, "
            "position: [0.5, 5, 5], joint: {type: link, length: " +
                length + "}}]}]",
            "s.yaml");
    };
    EXPECT_EQ(chain("1").chains[0].linked.position[1][0], 10.5);
    EXPECT_EQ(chain("9").chains[0].linked.position[1][0], 0.5);
    EXPECT_TRUE(chain("9").notes.empty());
    EXPECT_THROW(chain("3"), InputError);
}

/// Of a fixed ground any image is as good: the nearest one to the chain's end.
TEST(Tip, takes_the_nearest_image_of_its_anchor) {
    std::string const text =
        "box: {periodic: [10, 10, 10]}\nchains: [{bodies: [{mass: 1, position: [8.5, 5, 5]}, "
        "{mass: 1, position: [9.5, 5, 5], joint: "
        "{type: link}}], tip: {joint: {type: link, anchor: [0.5, 5, 5]}}}]";
    Scene const scene = parse_scene(text, "s.yaml");
    EXPECT_EQ(scene.chains[0].tip_joint.length, 1);
    EXPECT_EQ((*scene.chains[0].tip_joint.anchor)[0], 10.5);
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].find("the nearest image of the anchor is used, [10.5, 5, 5]"),
              std::string::npos)
        << scene.notes[0];
}

TEST(Tip, of_a_ring_that_winds_through_the_box_is_refused) {
    std::string bodies;
    for (int k = 0; k < 10; ++k)
        bodies += std::string(k ? ", " : "") + "{mass: 1, position: [" + std::to_string(k + 0.5) +
                  ", 5, 5]" + (k ? ", joint: {type: link}" : "") + "}";
    std::string const chain = "chains: [{tip: ring, bodies: [" + bodies + "]}]";
    std::string const message =
        message_of([&] { parse_scene("box: {periodic: [10, 10, 10]}\n" + chain, "s.yaml"); });
    EXPECT_NE(message.find("the ring winds through the periodic box: its last body is 9 from the "
                           "first and 1 from an image of it"),
              std::string::npos)
        << message;
}

TEST(Linked, everything_that_a_body_can_say) {
    ChainSpec const chain = chain_of(
        "chains: [{base: fixed, anchor: [0, 0, 1], bodies: ["
        "{mass: 2, inertia: [1, 2, 2.5], com: [0, 0, 1], position: [0, 0, 3], quaternion: [0, 1, "
        "0, 0], velocity: [1, 2, 3], omega: [4, 5, "
        "6], beads: [{residue: ALA, position: [1, 0, 1]}], joint: {type: link}},"
        "{mass: 3, position: [0, 4, 3], residue: GLY, velocity: [0, 0, 7], joint: {type: link, "
        "translation: [0, -1, 0], length: 3}},"
        "{mass: 1, inertia: [1, 1, 1], position: [0, 4, 4], joint: {type: link}}]}]");
    LinkedArrays const& l = chain.linked;
    ASSERT_TRUE(chain.is_linked());
    ASSERT_EQ(l.size(), 3u);
    EXPECT_EQ(chain.velocities, StartVelocities::given);
    EXPECT_NEAR(l.position[0][2], 2, 4 * eps);  // half a turn about x takes +z to -z
    EXPECT_EQ(l.inboard[0][2], -1);
    EXPECT_EQ(l.outboard[0][1], -1);
    EXPECT_EQ(l.outboard[0][2], -1);
    EXPECT_EQ(l.velocity[0][1], 2);
    EXPECT_EQ(l.omega[0][0], 4);
    EXPECT_EQ(l.length[0], 2);
    EXPECT_EQ(l.length[1], 3);
    EXPECT_EQ(l.length[2], 1);
    EXPECT_EQ(l.anchor[2], 1);
    EXPECT_FALSE(l.is_bead(0));
    EXPECT_TRUE(l.is_bead(1));
    EXPECT_EQ(l.carried.offset, (std::vector<std::int64_t>{0, 1, 2, 2}));
    EXPECT_EQ(l.carried.residue, (std::vector<std::string>{"ALA", "GLY"}));
    EXPECT_EQ(l.carried.position[0][2], 0);  // from the centre of mass
    EXPECT_EQ(l.carried.position[0][0], 1);
    EXPECT_EQ(l.carried.mass[1], 3);
    EXPECT_EQ(scene::degrees_of_freedom(chain), 6 + 3 + 6 - 3);
    EXPECT_EQ(scene::handle_kind(chain), scene::HandleKind::link);
    expect_closed_links(chain);
}

TEST(Linked, a_tip_starts_at_its_translation) {
    std::string const chain =
        "chains: [{bodies: [{mass: 1, position: [0, 0, 0], joint: {type: link}}, {mass: 1, "
        "inertia: [1, 1, 1], com: [1, 0, 0], position: "
        "[1, 0, "
        "0], joint: {type: link}}], tip: {joint: {type: link, anchor: [3, 4, 0]";
    EXPECT_EQ(chain_of(chain + ", translation: [2, 0, 0]}}}]").tip_joint.length, 4);
    EXPECT_EQ(chain_of(chain + ", translation: [2, 0, 0]}}}]").linked.outboard[1][0], 1);
    EXPECT_DOUBLE_EQ(chain_of(chain + "}}}]").tip_joint.length,
                     std::sqrt(20.0));  // from the body's origin
}

TEST(Linked, random_mixture) {
    for (std::string const base : {"free", "fixed"}) {
        ChainSpec const chain =
            chain_of("chains: [{base: " + base +
                     ", generator: {random: {bodies: 1000, joint: link, rigid: 0.3, seed: 3}}}]");
        LinkedArrays const& l = chain.linked;
        expect_closed_links(chain);
        int rigid = 0;
        for (std::size_t k = 0; k < l.size(); ++k) rigid += !l.is_bead(k);
        EXPECT_NEAR(rigid, 300, 4 * std::sqrt(210));
        EXPECT_EQ(l.carried.size(), 1000u - static_cast<std::size_t>(rigid));
        auto const velocity = [&](std::size_t k, Vec3 const& r) {
            auto const& q = l.orientation[k];
            return l.velocity[k] + to_matrix(Quat{q[0], q[1], q[2], q[3]}) * cross(l.omega[k], r);
        };
        for (std::size_t k = 1; k < l.size(); ++k) {
            Vec3 const link = point(l, k, l.inboard[k]) - point(l, k - 1, l.outboard[k - 1]);
            EXPECT_NEAR(dot(link, velocity(k, l.inboard[k]) - velocity(k - 1, l.outboard[k - 1])),
                        0, 1e-12);
        }
        EXPECT_EQ(scene::degrees_of_freedom(chain),
                  3 * 1000 + 3 * rigid - (base == "free" ? 999 : 1000));
    }
}

class Domains : public testing::Test {
  protected:
    Domains() {
        std::ofstream table(file());
        for (int k = 0; k < 12; ++k)
            table << fmt::format("{},{},{}\n", 0.22 * k, 0.19 * std::sin(2.0 * k),
                                 0.19 * std::cos(2.0 * k));
    }
    ~Domains() override { std::filesystem::remove(file()); }
    /// Of this test alone: others may run at the same time.
    static std::string file() {
        return std::string("domains_") +
               testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv";
    }
    static std::string yaml(std::string const& rigid, std::string const& more = "") {
        return "chains: [{sequence: GASTGGASTGGA, model: calvados2, positions: " + file() +
               ", rigid: " + rigid + more + "}]";
    }
};

TEST_F(Domains, become_bodies_that_carry_their_beads) {
    BeadArrays const beads =
        chain_of(
            "chains: [{sequence: GASTGGASTGGA, model: calvados2, links: as_given, positions: " +
            file() + "}]")
            .beads;
    ChainSpec const chain = chain_of(yaml("[[8, 11], [2, 5]]", ", links: as_given"));
    LinkedArrays const& l = chain.linked;
    ASSERT_EQ(l.size(), 6u);  // 1, 2-5, 6, 7, 8-11, 12
    EXPECT_FALSE(chain.is_beads());
    expect_closed_links(chain);
    EXPECT_EQ(l.carried.offset, (std::vector<std::int64_t>{0, 1, 5, 6, 7, 11, 12}));
    ASSERT_EQ(l.carried.size(), 12u);
    for (std::size_t k = 0; k < l.size(); ++k)
        for (auto b = static_cast<std::size_t>(l.carried.offset[k]);
             b < static_cast<std::size_t>(l.carried.offset[k + 1]); ++b) {
            EXPECT_NEAR(norm(point(l, k, l.carried.position[b]) - beads.position[b]), 0, 1e-14);
            EXPECT_EQ(l.carried.mass[b], beads.mass[b]);
            EXPECT_EQ(l.carried.residue[b], beads.residue[b]);
        }
    EXPECT_DOUBLE_EQ(l.mass[1], beads.mass[1] + beads.mass[2] + beads.mass[3] + beads.mass[4]);
    Vec3 first = Vec3::zero();  // moment of the beads about the centre of mass
    double trace = 0;
    for (std::size_t b = 1; b < 5; ++b) {
        first = plus_scaled(first, beads.mass[b], l.carried.position[b]);
        trace += 2 * beads.mass[b] * dot(l.carried.position[b], l.carried.position[b]);
    }
    EXPECT_NEAR(norm(first), 0, 1e-12);
    EXPECT_NEAR(l.inertia[1](0, 0) + l.inertia[1](1, 1) + l.inertia[1](2, 2), trace, 1e-12 * trace);
    EXPECT_EQ(l.inertia[1](1, 0), 0);
    EXPECT_NEAR(norm(l.inboard[1] - l.carried.position[1]), 0, 1e-15);
    EXPECT_NEAR(norm(l.outboard[1] - l.carried.position[4]), 0, 1e-15);
    EXPECT_EQ(l.length[2], beads.length[5]);
    EXPECT_EQ(scene::degrees_of_freedom(chain), 2 * 6 + 4 * 3 - 5);
}

TEST_F(Domains, keep_their_shape_while_the_linkers_take_the_models_lengths) {
    LinkedArrays const given = chain_of(yaml("[[2, 5], [8, 11]]", ", links: as_given")).linked;
    ChainSpec const chain = chain_of(yaml("[[2, 5], [8, 11]]"));
    expect_closed_links(chain);
    for (std::size_t k : {1, 2, 3, 4, 5}) EXPECT_EQ(chain.linked.length[k], 0.38);
    for (std::size_t k : {1, 4})
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(chain.linked.inertia[k](i, i), given.inertia[k](i, i), 1e-10);
}

TEST_F(Domains, refusals) {
    std::string const give = "give [first, last] with residues from 1 to 12, both included",
                      place = " (s.yaml: chains[0].rigid[0], line 1): ";
    EXPECT_EQ(refusal_of(yaml("[]")),
              "the list of rigid domains is empty (s.yaml: chains[0].rigid, line 1): leave the key "
              "out or " +
                  give);
    EXPECT_EQ(refusal_of(yaml("[\"A:2-5\"]")),
              "chain A is named, and the residues of this entry are counted from 1" + place +
                  "leave the chain out, or give the structure as `pdb`, whose chains and residue "
                  "numbers count");
    EXPECT_EQ(refusal_of(yaml("[3]")), "`3` is not a range of residues" + place +
                                           "write \"FIRST-LAST\", such as \"1-95\", or [1, 95]");
    EXPECT_EQ(refusal_of(yaml("[[9, 13]]")), "residue 13 of a chain of 12" + place + give);
    EXPECT_EQ(refusal_of(yaml("[[2, 3]]")),
              "residues 2 to 3 do not form a rigid body, which needs three residues that do not "
              "lie on one line" +
                  place + give);
    EXPECT_EQ(refusal_of(yaml("[[2, 5], [5, 9]]")),
              "residues 5 to 9 overlap the domain 2 to 5 (s.yaml: chains[0].rigid[1], line 1): "
              "assign each residue to one domain");
    EXPECT_EQ(refusal_of("chains: [{sequence: GGGG, model: calvados2, rigid: [[1, 3]]}]"),
              "rigid domains in a chain without positions (s.yaml: chains[0].rigid, line 1): give "
              "`pdb` or `positions`: they define the shape of the domains");
    EXPECT_EQ(refusal_of("chains: [{generator: {pendulum: {links: 3}}, rigid: [[1, 3]]}]"),
              "key `rigid` does not apply to generator `pendulum` (s.yaml: chains[0].rigid, line "
              "1): leave it out");
    std::ofstream line("line_test.csv");
    line << "0,0,0\n0.38,0,0\n0.76,0,0\n1.14,0,0\n";
    line.close();
    EXPECT_EQ(refusal_of("chains: [{sequence: GGGG, model: calvados2, positions: line_test.csv, "
                         "rigid: [[1, 3]]}]"),
              "the beads of residues 1 to 3 lie on one line and form a thin rod (s.yaml: "
              "chains[0].rigid, line 1): include a residue next to it, or leave the domain out");
    std::filesystem::remove("line_test.csv");
}

}  // namespace
}  // namespace catena::test
