// Numbers of chains and boxes follow from concentrations.
#include <gtest/gtest.h>

#include "start/concentrations.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

/// Glycine is 57.05 amu and serine 87.08 amu in CALVADOS 2; the ends of a chain add 18 amu.
double constexpr mass_of_ten = 5 * (57.05 + 87.08) + 18;
double constexpr amu_per_nm3 = 1.66053906892;  // mg/ml

std::string scene_of(std::string const& number, std::string const& rest) {
    return "chains: [{name: g, sequence: GSGSGSGSGS, model: calvados2" + number + "}]\n" + rest;
}
Scene read(std::string const& number, std::string const& rest) {
    return parse_scene(scene_of(number, rest), "s.yaml");
}

std::string const box = "box: {periodic: [20, 20, 30]}\n";  // 12,000 nm^3

TEST(Concentration, of_a_chain_gives_its_number) {
    double const mg = 40 * mass_of_ten * amu_per_nm3 / 12000, mmol = 40 * 1e3 * amu_per_nm3 / 12000;
    for (std::string const& written :
         {std::to_string(mg) + " mg/ml", std::to_string(mg) + " g/l",
          std::to_string(mmol) + " mmol/l", std::to_string(1e3 * mmol) + " uM",
          std::to_string(1e-3 * mmol) + " mol/l"}) {
        Scene const scene = read(", concentration: " + written, box);
        EXPECT_EQ(scene.chains.size(), 40u) << written;
        EXPECT_TRUE(scene.notes.empty()) << scene.notes[0];
        std::vector<ChainConcentration> const found = concentrations_of(scene);
        ASSERT_FALSE(found.empty());
        EXPECT_EQ(found[0].count, 40);
        EXPECT_EQ(found[0].where, "the box");
        EXPECT_NEAR(found[0].mg_per_ml, mg, 1e-3 * mg);
        EXPECT_NEAR(found[0].mmol_per_l, mmol, 1e-9 * mmol);
    }
}

TEST(Concentration, of_a_placed_chain_is_that_in_its_place) {
    Scene const scene =
        read(", concentration: 50 mmol/l", box + "place: {slab: {axis: z, thickness: 10}}\n");
    EXPECT_EQ(scene.chains.size(), 120u);  // 50 mmol/l of 4,000 nm^3 are 120.4 chains
    std::vector<ChainConcentration> const found = concentrations_of(scene);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].where, "the box");
    EXPECT_NEAR(found[0].mmol_per_l, 49.816 / 3, 1e-3);
    // The outermost beads stand at most a few tenths of a nanometre from the faces.
    EXPECT_NE(found[1].text().find("120 chains (g-1 .. g-120) in z from 10."), std::string::npos)
        << found[1].text();
    EXPECT_GE(found[1].mmol_per_l, 49.816);
    EXPECT_LT(found[1].mmol_per_l, 53);
}

TEST(Concentration, that_no_whole_number_gives_has_a_note) {
    Scene const scene = read(", concentration: 0.2 mmol/l", box);  // 1.45 chains
    EXPECT_EQ(scene.chains.size(), 1u);
    ASSERT_EQ(scene.notes.size(), 1u);
    EXPECT_NE(scene.notes[0].find("is 1.445 chains: 1 of them are"), std::string::npos)
        << scene.notes[0];
    std::string const none = refusal_of(scene_of(", concentration: 0.01 mmol/l", box));
    EXPECT_NE(none.find("is 0.072 chains"), std::string::npos) << none;
    EXPECT_NE(none.find("or `count: 1`"), std::string::npos) << none;
}

TEST(Concentration, of_a_cubic_box_gives_its_edges) {
    Scene const scene = read(", count: 24", "box: {cubic: {concentration: 5 mg/ml}}\n");
    ASSERT_TRUE(scene.box);
    double const edge = std::cbrt(24 * mass_of_ten * amu_per_nm3 / 5);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR((*scene.box)[i], edge, 1e-3);
    EXPECT_NEAR(concentrations_of(scene).at(0).mg_per_ml, 5, 1e-3);
    // The edges as `check` prints them give the same scene.
    std::string const edges = std::to_string((*scene.box)[0]);
    EXPECT_EQ(
        scene.hash,
        read(", count: 24", "box: {periodic: [" + edges + ", " + edges + ", " + edges + "]}").hash);
}

TEST(Concentration, of_several_components_counts_all_chains) {
    Scene const scene = parse_scene(
        "chains: [{name: a, count: 3, sequence: GSGSGSGSGS, model: calvados2}, {name: b, count: 5, "
        "sequence: GGGGGGGGGGGGGGGGGGGG, model: calvados2}]\nbox: {cubic: {concentration: 2 "
        "mmol/l}}\n",
        "s.yaml");
    double const volume = 8 * 1e3 * amu_per_nm3 / 2;
    EXPECT_NEAR((*scene.box)[0], std::cbrt(volume), 1e-4);
    std::vector<ChainConcentration> found = concentrations_of(scene);
    std::erase_if(found, [](ChainConcentration const& each) { return each.where != "the box"; });
    ASSERT_EQ(found.size(), 3u);
    EXPECT_EQ(found[0].chains, "a-1 .. a-3");
    EXPECT_NEAR(found[1].mmol_per_l, 1.25, 1e-3);
    EXPECT_EQ(found[2].count, 8);
    EXPECT_NEAR(found[2].mmol_per_l, 2, 1e-3);
}

TEST(Concentration, of_a_single_chain_is_not_reported) {
    EXPECT_TRUE(concentrations_of(read("", box)).empty());
}

struct BadConcentrations : public Refused {};
TEST_P(BadConcentrations, are_refused) {
    std::string const message = refusal_of(GetParam().yaml);
    EXPECT_NE(message.find(GetParam().message), std::string::npos) << message;
}
#define CATENA_CHAIN(more) "chains: [{sequence: GGGG, model: calvados2" more "}]\n"
#define CATENA_BOX "box: {periodic: [9, 9, 30]}\n"
INSTANTIATE_TEST_SUITE_P(
    Place, BadConcentrations,
    testing::Values(
        Refusal{"no_unit", CATENA_CHAIN(", concentration: 5") CATENA_BOX, "such as `5 mg/ml`"},
        Refusal{"other_unit", CATENA_CHAIN(", concentration: 5 kg") CATENA_BOX,
                "`5 kg` is not a concentration"},
        Refusal{"negative", CATENA_CHAIN(", concentration: -5 mg/ml") CATENA_BOX, "is not above 0"},
        Refusal{"no_box", CATENA_CHAIN(", concentration: 5 mg/ml"),
                "without a periodic box whose edges are given"},
        Refusal{"with_count", CATENA_CHAIN(", count: 3, concentration: 5 mg/ml") CATENA_BOX,
                "both `count` and `concentration`"},
        Refusal{"both_box_and_chain",
                CATENA_CHAIN(", concentration: 5 mg/ml") "box: {cubic: {concentration: 5 mg/ml}}",
                "without a periodic box whose edges are given"},
        Refusal{"cubic_and_periodic",
                CATENA_CHAIN("") "box: {cubic: {concentration: 5 mg/ml}, periodic: [9, 9, 9]}",
                "both `cubic` and `periodic`"},
        Refusal{"cubic_in_si",
                "units: si\nchains: [{generator: {freely_jointed: {beads: 3, length: 1}}}]\nbox: "
                "{cubic: {concentration: 5 mg/ml}}",
                "a concentration in SI units"}),
    name_of_case);

}  // namespace
}  // namespace catena::test
