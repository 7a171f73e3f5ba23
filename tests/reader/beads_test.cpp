// Chains of beads: residues, conformations, links, places, copies.
#include <algorithm>
#include <cmath>
#include <limits>

#include "reader/load_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

Scene read(std::string const& yaml) { return parse_scene(yaml, "s.yaml"); }
BeadArrays beads_of(std::string const& chain) {
    return read("chains: [{" + chain + "}]").chains.at(0).beads;
}

double nearest_pair(std::vector<Vec3> const& a, std::vector<Vec3> const& b, std::size_t apart) {
    double nearest = std::numeric_limits<double>::infinity();
    bool const same = &a == &b;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = same ? i + apart : 0; j < b.size(); ++j)
            nearest = std::min(nearest, norm(a[i] - b[j]));
    return nearest;
}

void expect_link_lengths(BeadArrays const& beads) {
    double extent = 0;
    for (Vec3 const& p : beads.position) extent = std::max(extent, norm(p));
    for (std::size_t k = 1; k < beads.size(); ++k)
        ASSERT_NEAR(norm(beads.position[k] - beads.position[k - 1]), beads.length[k],
                    4 * std::numeric_limits<double>::epsilon() * (extent + 1))
            << k;
}

TEST(Beads, masses_of_calvados2_with_their_ends) {
    BeadArrays const beads = beads_of("sequence: M AW, model: calvados2");
    EXPECT_EQ(beads.residue, (std::vector<std::string>{"MET", "ALA", "TRP"}));
    EXPECT_DOUBLE_EQ(beads.mass[0], 131.2 + 2);
    EXPECT_DOUBLE_EQ(beads.mass[1], 71.07);
    EXPECT_DOUBLE_EQ(beads.mass[2], 186.22 + 16);
    EXPECT_DOUBLE_EQ(beads_of("sequence: G, model: calvados2").mass[0], 57.05 + 18);
    EXPECT_EQ(beads.length, (std::vector<double>{0, 0.38, 0.38}));
}

TEST(Beads, extended_is_a_zig_zag) {
    BeadArrays const beads = beads_of("sequence: GGGGGGGGGGGGGGGGGGGG, model: calvados2");
    expect_link_lengths(beads);
    for (std::size_t k = 2; k < beads.size(); ++k)
        EXPECT_NEAR(norm(beads.position[k] - beads.position[k - 2]), std::sqrt(3) * 0.38, 1e-14);
}

TEST(Beads, self_avoiding_stays_apart) {
    for (int seed = 1; seed <= 20; ++seed) {
        std::string const scene =
            "chains: [{generator: {freely_jointed: {beads: 2, length: 1}}}, {conformation: "
            "self_avoiding, model: calvados2, sequence: " +
            std::string(300, 'G') +
            "}]\ndynamics: {integrator: rattle, step: 1, seed: " + std::to_string(seed) + "}";
        BeadArrays const beads = read(scene).chains[1].beads;
        expect_link_lengths(beads);
        EXPECT_GE(nearest_pair(beads.position, beads.position, 2), 0.56 - 1e-12);
        EXPECT_EQ(read(scene).chains[1].beads.position[299].data[0], beads.position[299][0]);
    }
}

/// Two links at a right angle do not feel each other: each end of one goes half of what it lacks.
TEST(Beads, links_take_their_lengths_by_the_least_change) {
    std::string const chain =
        "bodies: [{mass: 1, position: [0, 0, 0], joint: {type: link}}, {mass: 2, position: [1.2, "
        "0, 0], joint: {type: link, length: 1}}, "
        "{mass: 3, position: [1.2, 0.9, 0], joint: {type: link, length: 1}}]";
    BeadArrays const fitted = beads_of(chain), as_given = beads_of(chain + ", links: as_given");
    for (std::size_t k : {1, 2})
        EXPECT_NEAR(norm(fitted.position[k] - fitted.position[k - 1]), 1, 1e-15);
    Vec3 sum = Vec3::zero();
    for (Vec3 const& position : fitted.position) sum = sum + position;
    EXPECT_NEAR(norm(sum - Vec3{{2.4, 0.9, 0}}), 0,
                1e-15);                              // what moves one bead moves another back
    EXPECT_NEAR(fitted.position[0][0], 0.1, 0.004);  // to second order
    EXPECT_NEAR(fitted.position[2][1], 0.95, 0.004);
    EXPECT_EQ(fitted.length, (std::vector<double>{0, 1, 1}));
    EXPECT_EQ(as_given.position[2][1], 0.9);
    EXPECT_EQ(as_given.length, (std::vector<double>{0, 1.2, 0.9}));
}

TEST(Beads, a_held_anchor_moves_the_others_alone) {
    BeadArrays const beads = beads_of(
        "base: fixed, anchor: [0, 0, 1], bodies: [{mass: 1, position: [0, 0, 2.1], joint: {type: "
        "link, length: "
        "1}}]");
    EXPECT_NEAR(beads.position[0][2], 2, 1e-15);
    EXPECT_EQ(beads.anchor[2], 1);
}

TEST(Beads, explicit_ones_with_velocities_and_an_anchor) {
    Scene const scene = read(
        "chains: [{base: fixed, anchor: [0, 0, 1], bodies: [{mass: 1, position: [0, 0, 3], "
        "velocity: [1, 2, 0], residue: TRP}, "
        "{mass: 1, position: [1, 0, 3], joint: {type: link}}]}]");
    BeadArrays const& beads = scene.chains[0].beads;
    EXPECT_EQ(scene.chains[0].base, Base::fixed);
    EXPECT_EQ(scene.chains[0].velocities, StartVelocities::given);
    EXPECT_EQ(beads.length, (std::vector<double>{2, 1}));
    EXPECT_EQ(beads.anchor[2], 1);
    EXPECT_EQ(beads.velocity[0][1], 2);
    EXPECT_EQ(beads.residue, (std::vector<std::string>{"TRP", "UNK"}));
}

/// Written with lengths or without: the third bead's image at 10.6 is the one 0.8 from its
/// neighbour.
TEST(Beads, explicit_ones_are_made_whole_across_the_box) {
    for (char const* const joint : {"{type: link}", "{type: link, length: 0.8}"}) {
        Scene const scene = read(
            std::string(
                "box: {periodic: [10, 10, 10]}\nchains: [{bodies: [{mass: 1, position: [9, 5, 5]}, "
                "{mass: 1, position: [9.8, 5, 5], joint: ") +
            joint + "}, {mass: 1, position: [0.6, 5, 5], joint: " + joint + "}]}]");
        EXPECT_NEAR(scene.chains[0].beads.position[2][0], 10.6, 1e-12) << joint;
        EXPECT_NEAR(scene.chains[0].beads.length[2], 0.8, 1e-12) << joint;
        ASSERT_EQ(scene.notes.size(), 1U) << joint;
        EXPECT_NE(scene.notes[0].find("1 link of 1 chain is cut by the sides of the periodic box"),
                  std::string::npos)
            << scene.notes[0];
    }
}

TEST(Beads, a_tether_starts_at_its_anchor) {
    for (char const* const conformation : {"extended", "self_avoiding"}) {
        BeadArrays const beads = beads_of(
            std::string(
                "base: fixed, anchor: [1, 2, 3], sequence: GGG, model: calvados2, conformation: ") +
            conformation);
        ASSERT_EQ(beads.size(), 3u);
        EXPECT_NEAR(norm(beads.position[0] - Vec3{{1, 2, 3}}), 0.38, 1e-14);
        EXPECT_EQ(beads.length[0], 0.38);
        expect_link_lengths(beads);
    }
}

TEST(Beads, start_velocities) {
    std::string const chain = "chains: [{sequence: GGG, model: calvados2}]\n";
    auto const start = [&](std::string const& dynamics) {
        return read(chain + dynamics).chains[0].velocities;
    };
    EXPECT_EQ(start(""), StartVelocities::zero);
    EXPECT_EQ(start("dynamics: {integrator: rattle, step: 1}"), StartVelocities::zero);
    EXPECT_EQ(start("dynamics: {integrator: rattle, step: 1, temperature: 300}"),
              StartVelocities::thermal);
    EXPECT_EQ(start("dynamics: {integrator: g-baoab, step: 1}"), StartVelocities::thermal);
    EXPECT_EQ(start("dynamics: {integrator: g-baoab, step: 1, temperature: 0}"),
              StartVelocities::zero);
}

TEST(Places, a_lone_chain_is_centred) {
    auto const middle = [](BeadArrays const& beads, int axis) {
        auto const [low, high] =
            std::minmax_element(beads.position.begin(), beads.position.end(),
                                [&](Vec3 const& a, Vec3 const& b) { return a[axis] < b[axis]; });
        return 0.5 * ((*low)[axis] + (*high)[axis]);
    };
    std::string const chain = "chains: [{sequence: GGGGG, model: calvados2}]\n";
    EXPECT_NEAR(middle(read(chain).chains[0].beads, 0), 0, 1e-14);
    EXPECT_NEAR(middle(read(chain + "box: {periodic: [10, 20, 30]}").chains[0].beads, 2), 15,
                1e-13);
}

TEST(Places, copies_stay_clear_of_each_other_and_of_their_images) {
    Scene const scene = read(
        "chains: [{name: a, count: 30, sequence: GGGGGGGGGG, model: calvados2, conformation: "
        "self_avoiding}, "
        "{name: wall, sequence: GGGGGGGGGG, model: calvados2, base: fixed, anchor: [8, 8, "
        "8]}]\nbox: {periodic: [24, 20, 22]}");
    ASSERT_EQ(scene.chains.size(), 31u);
    EXPECT_EQ(scene.chains[0].name, "a-1");
    EXPECT_EQ(scene.chains[29].name, "a-30");
    EXPECT_EQ(scene.chains[30].beads.anchor[0], 8);
    Vec3 const edge = *scene.box;
    for (std::size_t i = 0; i < scene.chains.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            for (Vec3 const& a : scene.chains[i].beads.position)
                for (Vec3 const& b : scene.chains[j].beads.position) {
                    Vec3 d = a - b;
                    for (int x = 0; x < 3; ++x) d[x] -= edge[x] * std::round(d[x] / edge[x]);
                    ASSERT_GE(norm(d), 0.76 - 1e-12) << i << " " << j;
                }
    EXPECT_NE(
        scene.chains[0].beads.position[3].data[0] - scene.chains[0].beads.position[0].data[0],
        scene.chains[1].beads.position[3].data[0] - scene.chains[1].beads.position[0].data[0]);
}

TEST(Places, without_a_box_the_grid_grows) {
    Scene const scene = read(
        "chains: [{name: a, count: 9, sequence: GGGG, model: calvados2}, {name: b, count: 3, base: "
        "fixed, generator: {pendulum: {links: "
        "4}}}]");
    ASSERT_EQ(scene.chains.size(), 12u);
    for (std::size_t i = 0; i < 9; ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GE(
                nearest_pair(scene.chains[i].beads.position, scene.chains[j].beads.position, 0),
                0.76);
    EXPECT_GE(norm(scene.chains[9].bodies.translation[0] - scene.chains[10].bodies.translation[0]),
              4);
}

TEST(Places, memory_is_asked_for_before_it_is_taken) {
    EXPECT_EQ(refusal_of("chains: [{generator: {random: {bodies: 1e15, joint: link}}}]")
                  .rfind("the chain needs about 1.5e+08 GB of memory, and only ", 0),
              0u);
    EXPECT_EQ(refusal_of("chains: [{count: 1e15, sequence: G, model: calvados2}]")
                  .rfind("the chain needs about 3.15e+09 GB of memory, and only ", 0),
              0u);
}

}  // namespace
}  // namespace catena::test
