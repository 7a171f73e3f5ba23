// Chains start where `place` puts them, without overlap, or are refused with what would do.
#include <gtest/gtest.h>

#include <fstream>
#include <regex>

#include "tests/io/temporary_folder.hpp"
#include "tests/place/beads_of_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

double constexpr excluded = 0.56;

std::string const peptide = "sequence: GSKEELRKALEDAGQYFKPSTWNHGMIVCD, model: calvados2";

/// `count` chains of 30 residues in a slab across z.
std::string slab(int count, double thickness, std::string const& box = "[8, 8, 60]") {
    return "chains: [{name: p, count: " + std::to_string(count) + ", " + peptide +
           "}]\nbox: {periodic: " + box +
           "}\nplace: {slab: {axis: z, thickness: " + std::to_string(thickness) + "}}\n";
}

Scene read(std::string const& yaml) { return parse_scene(yaml, "s.yaml"); }

void expect_apart(Scene const& scene) { EXPECT_GE(nearest_chains(scene), excluded - 1e-9); }

/// No bead stands out of the slab, and chains meet no other chain's image across its faces.
TEST(Place, a_slab_holds_all_beads_in_the_middle_of_the_box) {
    for (double const thickness : {6.0, 10.0, 59.5}) {
        Scene const scene = read(slab(20, thickness));
        ASSERT_EQ(scene.chains.size(), 20u);
        expect_between(scene, 0, 20, 2, 30 - 0.5 * thickness, 30 + 0.5 * thickness);
        expect_links(scene);
        expect_apart(scene);
    }
}

TEST(Place, a_slab_may_lie_across_any_axis) {
    Scene const scene = read("chains: [{count: 5, " + peptide +
                             "}]\nbox: {periodic: [60, 8, 8]}\nplace: {slab: {axis: x, thickness: "
                             "6}}\n");
    expect_between(scene, 0, 5, 0, 27, 33);
    expect_apart(scene);
}

TEST(Place, the_same_scene_and_seed_give_the_same_bits) {
    Scene const one = read(slab(10, 6)), same = read(slab(10, 6));
    Scene const other =
        parse_scene(slab(10, 6), "s.yaml", {"dynamics={integrator: rattle, step: 0.01, seed: 2}"});
    EXPECT_EQ(one.hash, same.hash);
    EXPECT_NE(one.chains[0].beads.position[0][0], other.chains[0].beads.position[0][0]);
}

TEST(Place, a_region_is_bounded_along_each_axis_that_it_does_not_fill) {
    Scene const scene = read("chains: [{count: 4, " + peptide +
                             "}]\nbox: {periodic: [20, 20, 20]}\nplace: {region: {from: [2, 0, 5], "
                             "to: [9, 20, 11]}}\n");
    expect_between(scene, 0, 4, 0, 2, 9);
    expect_between(scene, 0, 4, 2, 5, 11);
    expect_apart(scene);
}

/// A chain's own place takes precedence; chains with positions stay, and the others keep clear of
/// them.
TEST(Place, components_have_places_of_their_own) {
    TemporaryFolder const folder;
    std::ofstream table(folder / "rod.csv");
    for (int k = 0; k < 14; ++k) table << 1 + 0.38 * k << ",4,30\n";
    table.close();
    Scene const scene = parse_scene(
        "chains:\n  - {name: rod, sequence: GGGGGGGGGGGGGG, model: calvados2, positions: "
        "rod.csv}\n  - {name: p, count: 15, " +
            peptide + "}\n  - {name: client, count: 6, sequence: EEEEEEEEEE, model: calvados2, " +
            "place: {region: {from: [0, 0, 50], to: [8, 8, 60]}}}\n  - {name: single, " + peptide +
            "}\nbox: {periodic: [8, 8, 60]}\nplace: {slab: {thickness: 8}}\n",
        folder / "s.yaml");
    ASSERT_EQ(scene.chains.size(), 23u);
    expect_between(scene, 0, 1, 2, 30, 30);
    expect_between(scene, 1, 16, 2, 26, 34);
    expect_between(scene, 16, 22, 2, 50, 60);
    expect_between(scene, 22, 23, 2, 26, 34);
    expect_apart(scene);
    expect_links(scene);
}

/// A zig-zag of 30 residues is 9.5 nm long: in a slab of 4 nm it lies, and keeps its shape.
TEST(Place, chains_that_keep_their_shape_are_turned_and_shifted_as_wholes) {
    Scene const scene =
        read("chains: [{name: z, count: 6, conformation: extended, " + peptide +
             "}, {name: p, count: " + "4, " + peptide +
             "}]\nbox: {periodic: [14, 14, 40]}\nplace: {slab: {axis: z, thickness: 4}}\n");
    expect_between(scene, 0, 10, 2, 18, 22);
    expect_apart(scene);
    expect_links(scene);
    auto const ends = [&](std::size_t c) {
        auto const& at = scene.chains[c].beads.position;
        return at.back() - at.front();
    };
    for (std::size_t c = 1; c < 6; ++c) {
        EXPECT_NEAR(norm(ends(c)), norm(ends(0)), 1e-9);
        EXPECT_GT(norm(ends(c) - ends(0)), 1e-3) << "two chains have one orientation";
    }
}

TEST(Place, rigid_domains_find_places) {
    Scene const scene = parse_scene(
        "chains: [{name: d, count: 5, sequence: "
        "GGGGGGGGGGGGGGGGGGGG, model: calvados2, positions: s.csv, rigid: [[1, 8], [12, 20]]}]\n"
        "box: {periodic: [10, 10, 40]}\nplace: {slab: {thickness: 8}}\n",
        [] {
            static TemporaryFolder const folder;
            std::ofstream table(folder / "s.csv");
            for (int k = 0; k < 20; ++k)
                table << 0.23 * std::cos(1.745 * k) << "," << 0.23 * std::sin(1.745 * k) << ","
                      << 0.15 * k << "\n";
            return folder / "s.yaml";
        }());
    ASSERT_EQ(scene.chains.size(), 5u);
    EXPECT_TRUE(scene.chains[0].is_linked());
    expect_between(scene, 0, 5, 2, 16, 24);
    expect_apart(scene);
}

/// `fill` lets ends stand out. In a box that is hardly longer than its region they may meet.
TEST(Place, ends_that_fill_lets_meet_across_the_box_are_refused) {
    std::string refusal = "accepted";
    for (int seed = 1; seed < 20 && refusal == "accepted"; ++seed)
        refusal = refusal_of("chains: [{count: 60, " + peptide +
                             "}]\nbox: {periodic: [8, 8, 9], fill: [8, 8, 8.3]}\ndynamics: "
                             "{integrator: rattle, step: 0.01, seed: " +
                             std::to_string(seed) + "}\n");
    EXPECT_NE(refusal.find("meet across the box"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("write `place: {region: ...}`"), std::string::npos) << refusal;
}

std::string advised(std::string const& message) {
    std::smatch found;
    return std::regex_search(message, found, std::regex("`thickness: ([0-9.]+)`")) ? found[1].str()
                                                                                   : "none";
}

/// The thickness that the message names is taken at its word.
TEST(Place, a_slab_that_is_too_thin_is_refused_with_one_that_does) {
    for (std::string const shape : {"", "conformation: extended, "}) {
        int const count = shape.empty() ? 60 : 40;
        auto const scene = [&](std::string const& thickness) {
            return "chains: [{name: p, count: " + std::to_string(count) + ", " + shape + peptide +
                   "}]\nbox: {periodic: [11, 11, 60]}\nplace: {slab: {thickness: " + thickness +
                   "}}\n";
        };
        std::string const message = refusal_of(scene(shape.empty() ? "1.2" : "3"));
        std::string const enough = advised(message);
        ASSERT_NE(enough, "none") << message;
        EXPECT_NE(message.find("the slab, z from"), std::string::npos) << message;
        EXPECT_EQ(refusal_of(scene(enough)), "accepted") << message;
    }
    std::string const never = refusal_of(slab(4000, 20));
    EXPECT_NE(never.find("give a box with an edge of"), std::string::npos) << never;
}

TEST(Place, a_full_region_is_refused_with_the_volume_that_does) {
    std::string const message =
        refusal_of("chains: [{count: 60, " + peptide +
                   "}]\nbox: {periodic: [20, 20, 20]}\nplace: {region: {from: [1, 1, 1], to: [6, "
                   "6, 6]}}\n");
    EXPECT_NE(message.find("make its volume"), std::string::npos) << message;
    EXPECT_NE(message.find("times as large"), std::string::npos) << message;
}

struct BadPlaces : public Refused {};
TEST_P(BadPlaces, are_refused) {
    std::string const message = refusal_of(GetParam().yaml);
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
}
#define CATENA_P "chains: [{sequence: GGGG, model: calvados2}]\n"
#define CATENA_BOX "box: {periodic: [9, 9, 30]}\n"
INSTANTIATE_TEST_SUITE_P(
    Place, BadPlaces,
    testing::Values(
        Refusal{"no_box", CATENA_P "place: {slab: {thickness: 5}}", "the scene has none"},
        Refusal{"too_thick", CATENA_P CATENA_BOX "place: {slab: {thickness: 31}}",
                "the slab is 31 nm thick, the box's edge along z only 30 nm"},
        Refusal{"too_thin", CATENA_P CATENA_BOX "place: {slab: {thickness: 0.3}}",
                "thinner than a bead"},
        Refusal{"both",
                CATENA_P CATENA_BOX
                "place: {slab: {thickness: 3}, region: {from: [0, 0, 0], to: [1, 1, 1]}}",
                "both `slab` and `region`"},
        Refusal{"neither", CATENA_P CATENA_BOX "place: {}", "neither `slab` nor `region`"},
        Refusal{"outside", CATENA_P CATENA_BOX "place: {region: {from: [0, 0, 0], to: [9, 10, 9]}}",
                "the region reaches from y 0 to 10, the box from 0 to 9"},
        Refusal{"reversed", CATENA_P CATENA_BOX "place: {region: {from: [5, 0, 0], to: [4, 9, 9]}}",
                "the region ends at x 4 and begins at 5"},
        Refusal{"with_fill",
                CATENA_P "box: {periodic: [9, 9, 30], fill: [9, 9, 9]}\nplace: {slab: {thickness: "
                         "3}}",
                "both `place` and `fill`"},
        Refusal{"joints",
                "chains: [{count: 2, generator: {pendulum: {links: 3}}}]\n" CATENA_BOX
                "place: {slab: {thickness: 3}}",
                "`place` moves chains of beads and of bodies on links"},
        Refusal{"nothing_moves",
                "chains: [{bodies: [{mass: 1, position: [1, 1, 1]}]}]\n" CATENA_BOX
                "place: {slab: {thickness: 3}}",
                "all have positions"},
        Refusal{"own_place_of_a_placed_chain",
                "chains: [{place: {slab: {thickness: 3}}, bodies: [{mass: 1, position: [1, 1, "
                "1]}]}]\n" CATENA_BOX,
                "stands where its positions put it"},
        Refusal{
            "si",
            "units: si\nchains: [{generator: {freely_jointed: {beads: 3, length: 1}}}]\n" CATENA_BOX
            "place: {slab: {thickness: 3}}",
            "`place` in SI units"}),
    name_of_case);

}  // namespace
}  // namespace catena::test
