#include "structure/calvados2.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace catena {
namespace {

nlohmann::json reference(std::string const& name) {
    return nlohmann::json::parse(std::ifstream(std::string(CATENA_TEST_DATA) +
                                               "/reference/calvados2-asyn-" + name + ".json"));
}

TEST(Calvados2, HasTheTwentyResiduesOfTheFile) {
    ASSERT_EQ(calvados2_residues().size(), 20u);
    auto const* tryptophan = find_calvados2('W');
    ASSERT_NE(tryptophan, nullptr);
    EXPECT_EQ(tryptophan->name, "TRP");
    EXPECT_EQ(tryptophan->mass, 186.22);
    EXPECT_EQ(tryptophan->lambda, 0.989376474037);
    EXPECT_EQ(tryptophan->sigma, 0.678);
    EXPECT_EQ(find_calvados2("ASP")->charge, -1);
    for (auto const& residue : calvados2_residues()) {
        EXPECT_EQ(find_calvados2(residue.letter), &residue);
        EXPECT_EQ(find_calvados2(std::string_view(residue.name)), &residue);
    }
    EXPECT_EQ(find_calvados2('X'), nullptr);
    EXPECT_EQ(find_calvados2("UNK"), nullptr);
    EXPECT_EQ(find_calvados2("LA "), nullptr);
}

TEST(Calvados2, TerminiCarryMassAndCharge) {
    auto const& glycine = *find_calvados2('G');
    EXPECT_EQ(calvados2::bead_mass(glycine, {0, 3}), 57.05 + 2);
    EXPECT_EQ(calvados2::bead_mass(glycine, {1, 3}), 57.05);
    EXPECT_EQ(calvados2::bead_mass(glycine, {2, 3}), 57.05 + 16);
    EXPECT_EQ(calvados2::bead_mass(glycine, {0, 1}), 57.05 + 18);
    EXPECT_EQ(calvados2::bead_charge(glycine, {0, 3}, {}), 1);
    EXPECT_EQ(calvados2::bead_charge(glycine, {1, 3}, {}), 0);
    EXPECT_EQ(calvados2::bead_charge(glycine, {2, 3}, {}), -1);
    EXPECT_EQ(calvados2::bead_charge(*find_calvados2('K'), {0, 3}, {}), 2);
}

TEST(Calvados2, TerminiThatAreNotChargedCarryNeither) {
    auto const& glycine = *find_calvados2('G');
    EXPECT_EQ(calvados2::bead_mass(glycine, {0, 3, {false, true}}), 57.05);
    EXPECT_EQ(calvados2::bead_mass(glycine, {2, 3, {true, false}}), 57.05);
    EXPECT_EQ(calvados2::bead_charge(glycine, {0, 1, {true, false}}, {}), 1);
    EXPECT_EQ(calvados2::bead_charge(glycine, {0, 1, {false, true}}, {}), -1);
}

TEST(Calvados2, ChainsHaveTheEndsOfTheirNameElseThoseOfAll) {
    OpenMmSpec spec;
    EXPECT_EQ(calvados2::ChainEnds(spec).of("a"), (calvados2::ChargedTermini{true, true}));
    spec.map = {{"", {1, 0}}, {"a", {0, 1}}};
    EXPECT_EQ(calvados2::ChainEnds(spec).of("a"), (calvados2::ChargedTermini{false, true}));
    EXPECT_EQ(calvados2::ChainEnds(spec).of("b"), (calvados2::ChargedTermini{true, false}));
}

TEST(Calvados2, HistidineFollowsThePh) {
    auto const& histidine = *find_calvados2('H');
    EXPECT_EQ(calvados2::bead_charge(histidine, {1, 3}, {}), 0);
    EXPECT_DOUBLE_EQ(calvados2::bead_charge(histidine, {1, 3}, 6.0), 0.5);
    EXPECT_DOUBLE_EQ(calvados2::bead_charge(histidine, {1, 3}, 7.0), 1 / 11.0);
    EXPECT_DOUBLE_EQ(calvados2::bead_charge(histidine, {2, 3}, 5.0), 1 / 1.1 - 1);
    EXPECT_EQ(calvados2::bead_charge(*find_calvados2('K'), {1, 3}, 5.0), 1);
}

TEST(Calvados2, ScreeningIsThatOfTheReference) {
    auto const model = reference("coil")["model"]["yukawa"];
    auto const y = calvados2::yukawa(300, 0.15);
    EXPECT_NEAR(y.permittivity / model["epsw"].get<double>(), 1, 1e-15);
    EXPECT_NEAR(y.bjerrum_length / model["bjerrum"].get<double>(), 1, 1e-15);
    EXPECT_NEAR(y.prefactor / model["prefactor"].get<double>(), 1, 1e-15);
    EXPECT_NEAR(y.kappa / model["kappa"].get<double>(), 1, 1e-15);
    EXPECT_EQ(calvados2::yukawa(300, 0).kappa, 0);
}

}  // namespace
}  // namespace catena
