// Chains of residues in boxes that are too full for whole coils side by side.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "generate/crowd.hpp"
#include "reader/load_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

double constexpr excluded = 0.56;

std::string protein(int residues) {
    return std::string(static_cast<std::size_t>(residues), 'G') + ", model: calvados2";
}

/// A scene of equal self-avoiding chains, `density` beads in a cubic length.
std::string melt(int chains, int residues, double density, int seed = 1) {
    double const edge = std::cbrt(chains * residues / density);
    return "chains: [{conformation: self_avoiding, count: " + std::to_string(chains) +
           ", sequence: " + protein(residues) + "}]\nbox: {periodic: [" + std::to_string(edge) +
           ", " + std::to_string(edge) + ", " + std::to_string(edge) +
           "]}\ndynamics: {integrator: rattle, step: 0.01, seed: " + std::to_string(seed) + "}";
}

Scene read(std::string const& yaml) { return parse_scene(yaml, "s.yaml"); }

struct Bead {
    Vec3 at;
    std::size_t chain, number;
};

std::vector<Bead> all_beads(Scene const& scene) {
    std::vector<Bead> beads;
    for (std::size_t c = 0; c < scene.chains.size(); ++c)
        for (std::size_t k = 0; k < scene.chains[c].beads.size(); ++k)
            beads.push_back({scene.chains[c].beads.position[k], c, k});
    return beads;
}

/// Distance of the nearest two points of different chains, between nearest images in a cube.
double nearest_of_chains(Scene const& scene) {
    double const edge = (*scene.box)[0];
    double nearest = 1e300;
    std::vector<Bead> const beads = all_beads(scene);
    for (Bead const& a : beads)
        for (Bead const& b : beads) {
            if (a.chain >= b.chain) continue;
            Vec3 apart = a.at - b.at;
            for (int x = 0; x < 3; ++x) apart[x] -= edge * std::round(apart[x] / edge);
            nearest = std::min(nearest, norm(apart));
        }
    return nearest;
}

/// Distance of the nearest two points that are not link neighbours, by looking at every pair and
/// all images next to the nearest.
double nearest_pair(std::vector<Bead> const& beads, Vec3 const& box) {
    double nearest = 1e300;
    for (std::size_t i = 0; i < beads.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            Vec3 apart = beads[i].at - beads[j].at;
            double square = 0;
            for (int x = 0; x < 3; ++x) {
                apart[x] -= box[x] * std::round(apart[x] / box[x]);
                square += apart[x] * apart[x];
            }
            if (square >= nearest) continue;
            bool const linked =
                beads[i].chain == beads[j].chain && beads[i].number == beads[j].number + 1;
            if (!linked) nearest = square;
        }
    return std::sqrt(nearest);
}

/// Grids beyond a box's cells along its short edge are not tried one by one.
TEST(Places, a_flat_box_without_room_is_refused_at_once) {
    for (char const* const edges : {"1e9, 1e9, 1e-3", "1e9, 1e-3, 1e9", "1e-3, 1e9, 1e9"}) {
        std::string const refusal = refusal_of(
            std::string("units: si\nbox: {periodic: [") + edges +
            "]}\nchains: [{count: 2, generator: {freely_jointed: {beads: 2, length: 0.001}}}]");
        EXPECT_NE(refusal.find("has room for 0 chains side by side"), std::string::npos) << refusal;
    }
}

TEST(Places, a_long_box_is_filled_row_by_row) {
    Scene const scene = read(
        "box: {periodic: [3.1, 3.1, 3e5]}\nchains: [{count: 20000, generator: {freely_jointed: "
        "{beads: 2, length: 1}}}]");
    ASSERT_EQ(scene.chains.size(), 20000U);
    for (std::size_t i = 0; i < scene.chains.size(); ++i) {
        auto const& at = scene.chains[i].beads.position;
        ASSERT_NEAR(0.5 * (at[0][2] + at[1][2]), 15 * (static_cast<double>(i) + 0.5), 1e-6) << i;
    }
}

void expect_links(Scene const& scene) {
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 1; k < chain.beads.size(); ++k)
            ASSERT_NEAR(
                norm(chain.beads.position[k] - chain.beads.position[k - 1]) / chain.beads.length[k],
                1, 1e-12)
                << chain.name;
}

void expect_packed(Scene const& scene) {
    expect_links(scene);
    EXPECT_GE(nearest_pair(all_beads(scene), *scene.box), excluded - 1e-12);
}

double squared_extent(BeadArrays const& beads) {
    Vec3 const ends = beads.position.back() - beads.position.front();
    return dot(ends, ends);
}

class Melts : public testing::TestWithParam<double> {};

// Beads of alpha-synuclein at 330, 660 and 1000 mg/ml: growth alone will do for the first, the last
// is left full of overlaps by it.
TEST_P(Melts, are_free_of_overlaps) {
    Scene const scene = read(melt(30, 140, GetParam()));
    ASSERT_EQ(scene.chains.size(), 30u);
    EXPECT_EQ(scene.chains[29].beads.length, read(melt(1, 140, 1e-4)).chains[0].beads.length);
    expect_packed(scene);
    double mean = 0;
    for (ChainSpec const& chain : scene.chains) mean += squared_extent(chain.beads) / 30;
    EXPECT_GT(mean, 36);  // coils, (0.38 nm)^2 times some 500, not globules
    EXPECT_LT(mean, 150);
}
INSTANTIATE_TEST_SUITE_P(Packing, Melts, testing::Values(1.924, 3.848, 5.83));

TEST(Packing, is_a_function_of_scene_and_seed) {
    Scene const one = read(melt(20, 50, 4)), same = read(melt(20, 50, 4)),
                other = read(melt(20, 50, 4, 2));
    EXPECT_EQ(one.hash, same.hash);
    for (std::size_t c = 0; c < one.chains.size(); ++c)
        for (std::size_t k = 0; k < 50; ++k)
            for (int x = 0; x < 3; ++x)
                ASSERT_EQ(one.chains[c].beads.position[k].data[x],
                          same.chains[c].beads.position[k].data[x])
                    << c << " " << k;
    EXPECT_NE(one.chains[3].beads.position[7].data[0], other.chains[3].beads.position[7].data[0]);
    Vec3 const first = one.chains[0].beads.position[49] - one.chains[0].beads.position[0];
    Vec3 const second = one.chains[1].beads.position[49] - one.chains[1].beads.position[0];
    EXPECT_NE(first.data[0], second.data[0]);
}

TEST(Packing, copies_without_a_conformation_are_grown_too) {
    Scene const scene = read("chains: [{count: 400, sequence: " + protein(12) +
                             "}]\nbox: {periodic: [11, 12, 13]}");
    expect_packed(scene);
    EXPECT_NE(squared_extent(scene.chains[0].beads), squared_extent(scene.chains[1].beads));
}

TEST(Packing, in_a_narrow_box) {
    for (char const* const box : {"[1.4, 20, 20]", "[1.5, 1.6, 40]", "[4, 4, 4]"}) {
        Scene const scene =
            read("chains: [{conformation: self_avoiding, count: 2, sequence: " + protein(60) +
                 "}]\nbox: {periodic: " + box + "}");
        expect_packed(scene);
    }
}

TEST(Packing, around_chains_that_have_a_place) {
    std::string const box = "\nbox: {periodic: [9, 10, 11]}";
    std::string const tether =
        "{name: tether, base: fixed, anchor: [4, 5, 1], sequence: " + protein(20) + "}";
    std::string const wall =
        "{name: wall, bodies: [{mass: 1, position: [1, 1, 1]}, {mass: 1, position: [1, 1.5, 1], "
        "joint: {type: link}}, "
        "{mass: 1, position: [-12, 1.5, 1], joint: {type: link}}]}";
    std::string const rod =
        "{name: rod, base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: weld, "
        "translation: [7, 7, 7]}, "
        "beads: [{position: [0, 0, 1]}, {position: [0, 0, 2]}]}]}";
    Scene const alone = read("chains: [" + tether + ", " + wall + ", " + rod + "]" + box);
    Scene const scene = read(
        "chains: [{name: a, count: 25, conformation: self_avoiding, sequence: " + protein(60) +
        "}, " + tether + ", " + wall + ", {name: b, count: 150, sequence: " + protein(4) + "}, " +
        rod + ", {name: c, conformation: self_avoiding, sequence: " + protein(300) + "}]" + box);
    ASSERT_EQ(scene.chains.size(), 179u);
    expect_links(scene);
    std::vector<Bead> beads = all_beads(scene);
    for (double const z : {0.0, 1.0, 2.0})
        beads.push_back({{{7, 7, 7 + z}}, 177, static_cast<std::size_t>(10 * z)});
    EXPECT_GE(nearest_pair(beads, *scene.box), 0.5);  // the wall's own
    beads.erase(
        std::find_if(beads.begin(), beads.end(), [](Bead const& b) { return b.chain == 26; }));
    EXPECT_GE(nearest_pair(beads, *scene.box), excluded - 1e-12);
    for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t k = 0; k < alone.chains[c].beads.size(); ++k)
            EXPECT_EQ(
                norm(scene.chains[25 + c].beads.position[k] - alone.chains[c].beads.position[k]),
                0);
}

/// Chains that keep their shape are placed side by side, as if they were alone, and the others grow
/// around them.
TEST(Packing, around_chains_that_keep_their_shape) {
    std::string const straight =
        "{name: straight, count: 8, conformation: extended, sequence: " + protein(8) + "}";
    std::string const box = "\nbox: {periodic: [10, 10, 10]}";
    Scene const alone = read("chains: [" + straight + "]" + box);
    Scene const scene = read("chains: [" + straight +
                             ", {name: a, count: 30, sequence: " + protein(60) + "}]" + box);
    expect_packed(scene);
    for (std::size_t c = 0; c < 8; ++c)
        EXPECT_EQ(norm(scene.chains[c].beads.position[7] - alone.chains[c].beads.position[7]), 0)
            << c;
}

/// Stars keep their shape, and a lattice of their spheres has room for one of 20.
std::string stars(int count) {
    return "chains: [{count: " + std::to_string(count) +
           ", generator: {star: {arms: 4, arm_length: 8, length: 1}}}]\n"
           "box: {periodic: [20, 20, 20]}";
}

TEST(Places, branched_chains_without_room_side_by_side_are_inserted) {
    Scene const scene = read(stars(20));
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].find("20 chains that keep their shape do not fit side by side into "
                                  "the box: they start at random places"),
              std::string::npos)
        << scene.notes[0];
    EXPECT_GE(nearest_of_chains(scene), 1 - 1e-6);
    for (ChainSpec const& chain : scene.chains)
        for (std::size_t k = 1; k < chain.size(); ++k)
            EXPECT_NEAR(norm(chain.beads.position[k] -
                             chain.beads.position[static_cast<std::size_t>(chain.parent[k])]),
                        1, 1e-12);
    Scene const again = read(stars(20));
    for (std::size_t c = 0; c < scene.chains.size(); ++c)
        EXPECT_EQ(norm(scene.chains[c].beads.position[0] - again.chains[c].beads.position[0]), 0);
}

TEST(Places, branched_chains_that_fit_nowhere_are_refused_with_the_number_that_did) {
    std::string const message = refusal_of(stars(400));
    EXPECT_TRUE(std::regex_match(
        message, std::regex("the box 20 x 20 x 20 has room for [0-9] chains? side by side, each "
                            "within a sphere [0-9.]+ wide, not for 400; at random places [0-9]+ "
                            "found room \\(s.yaml: chains\\[0\\], line 1\\): enlarge the box or "
                            "lower `count`.*")))
        << message;
}

/// Chains of centimetres in a box of metres: 0.56 nm says nothing in SI units.
TEST(Places, in_si_units_have_no_distance_but_the_links) {
    std::string const text =
        "units: si\nbox: {periodic: [0.2, 0.2, 0.2]}\nchains: [{count: 40, generator: "
        "{freely_jointed: {beads: 12, length: 0.01, mass: 1}}}]\n";
    Scene const scene = read(text);
    ASSERT_EQ(scene.notes.size(), 1U);
    EXPECT_NE(scene.notes[0].find("40 chains that keep their shape do not fit side by side"),
              std::string::npos);
    EXPECT_GE(nearest_of_chains(scene), 0.01 * (1 - 1e-6));
}

TEST(Places, of_single_beads_are_apart_in_any_si_box) {
    for (double const edge : {0.2, 2e-8, 3e3}) {
        Scene const scene =
            read("units: si\nbox: {periodic: [" + fmt::format("{0}, {0}, {0}", edge) +
                 "]}\nchains: [{count: 30, bodies: [{mass: 1, position: [0, 0, 0], "
                 "velocity: [0, 0, 0]}]}]\n");
        EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
        EXPECT_GT(nearest_pair(all_beads(scene), Vec3{{edge, edge, edge}}), 0.2 * edge) << edge;
    }
}

TEST(Packing, that_finds_no_place_says_how_far_it_got) {
    std::string beads;
    for (int i = 0; i < 64; ++i) {
        int const z = i / 16, row = i / 4 % 4, y = z % 2 ? 3 - row : row,
                  x = (i / 4) % 2 ? 3 - i % 4 : i % 4;
        beads += (i ? ", {mass: 1, joint: {type: link}, position: [" : "{mass: 1, position: [") +
                 std::to_string(0.5 * x) + ", " + std::to_string(0.5 * y) + ", " +
                 std::to_string(0.5 * z) + "]}";
    }
    std::string const message =
        refusal_of("chains: [{name: wall, bodies: [" + beads +
                   "]}, {count: 2, sequence: GG, model: calvados2}]\nbox: {periodic: [2, 2, 2]}");
    EXPECT_TRUE(std::regex_match(
        message,
        std::regex("packing 2 chains into the box 2 x 2 x 2 left [0-9]+ pairs of beads closer than "
                   "0.56 nm, the closest at 0\\.[0-9]+ nm, after 2000 steps \\(s.yaml: "
                   "chains\\[1\\], line 1\\): enlarge the box or lower `count`")))
        << message;
}

/// Chains on top of each other come apart, and links keep their lengths however different these
/// are.
TEST(Relaxation, parts_chains_that_coincide) {
    scene::Crowd crowd;
    crowd.box = {{8, 8, 8}};
    crowd.excluded = excluded;
    crowd.first = {0};
    for (std::size_t c = 0; c < 12; ++c) {
        for (std::size_t k = 0; k < 20 + c; ++k) {
            crowd.length.push_back(k == 0 ? 0 : 0.3 + 0.01 * static_cast<double>((7 * k) % 11));
            double const along = k == 0 ? 0 : crowd.at.back()[0] + crowd.length.back();
            crowd.at.push_back({{along, 0, 0}});
        }
        for (std::size_t i = crowd.first.back(); i < crowd.at.size(); ++i)
            for (int axis : {1, 2})
                crowd.at[i][axis] =
                    1e-3 * static_cast<double>((7 * i + 3 * c) % (axis == 1 ? 11 : 13));
        crowd.first.push_back(crowd.at.size());
    }
    scene::Relaxed const relaxed = scene::relax(crowd, 2000);
    EXPECT_EQ(relaxed.overlaps, 0);
    EXPECT_GT(relaxed.steps, 0);
    std::vector<Bead> beads;
    for (std::size_t c = 0; c < crowd.chains(); ++c)
        for (std::size_t i = crowd.first[c]; i < crowd.first[c + 1]; ++i) {
            beads.push_back({crowd.at[i], c, i});
            if (i == crowd.first[c]) continue;
            EXPECT_NEAR(norm(crowd.at[i] - crowd.at[i - 1]) / crowd.length[i], 1, 1e-12);
        }
    EXPECT_GE(nearest_pair(beads, crowd.box), excluded - 1e-12);
}

}  // namespace
}  // namespace catena::test
