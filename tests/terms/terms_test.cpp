// The list of force terms: what it promises of each.
#include <gtest/gtest.h>

#include <set>

#include "keys/maps.hpp"
#include "reader/load_scene.hpp"
#include "terms/force_terms.hpp"
#include "terms/hash.hpp"

namespace catena::test {
namespace {

TEST(ForceTerms, HaveNamesEnergiesAndKeysOfTheirOwn) {
    std::set<std::string> names, keys;
    terms::for_each([&](auto term) {
        using Term = decltype(term);
        EXPECT_TRUE(names.insert(Term::name).second) << Term::name;
        if constexpr (Term::body_key != nullptr) {
            EXPECT_TRUE(keys.insert(Term::body_key).second);
            EXPECT_NE(scene::keys::body.find(Term::body_key), nullptr);
        }
        if constexpr (Term::scene_key != nullptr) {
            EXPECT_NE(scene::keys::forces.find(Term::scene_key), nullptr);
        }
        if constexpr (Term::depends_on_velocities) {
            EXPECT_STRNE(Term::in_messages, "");
        }
    });
    std::vector<std::string> const energies = terms::names_of_energies();
    EXPECT_EQ(std::set(energies.begin(), energies.end()).size(), terms::number_of_energies);
    EXPECT_EQ(energies.size(), terms::number_of_energies);
}

TEST(ForceTerms, HaveColumnsAtEachPlaceOfFingerprints) {
    std::vector<int> places;
    terms::for_each_column([&](auto const& column) { places.push_back(column.place); });
    EXPECT_EQ(places, (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

std::string arm(std::string const& joint, std::string const& body) {
    return "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: revolute, "
           "axis: [0, 0, 1]" +
           joint + "}" + body + "}, {mass: 1, inertia: [1, 1, 1], joint: {type: spherical}}]}]\n";
}

/// Terms that act on a scene, by name.
std::set<std::string> acting(std::string const& text) {
    Scene const scene = parse_scene(text, "s.yaml");
    std::set<std::string> names;
    terms::for_each([&](auto term) {
        if (terms::acts_in<decltype(term)>(scene)) names.insert(term.name);
    });
    return names;
}

TEST(ForceTerms, ActWhereTheirKeysAre) {
    EXPECT_EQ(acting(arm("", "")), (std::set<std::string>{}));
    EXPECT_EQ(acting(arm(", torque: 1, stiffness: 2, damping: 3", "")),
              (std::set<std::string>{"torques", "springs", "dampers"}));
    EXPECT_EQ(acting(arm(", torque: 0, stiffness: 0, damping: 0", ", wrench: {}, drag: {}")),
              (std::set<std::string>{}));
    EXPECT_EQ(
        acting(arm("", ", wrench: {torque: [0, 0, 1]}, drag: {angular: 1}, force: [1, 0, 0]")),
        (std::set<std::string>{"wrenches", "drag", "constant_forces"}));
    EXPECT_EQ(acting(arm("", "") + "forces: {gravity: [0, 0, -1], drag: {linear: 1}}\n"),
              (std::set<std::string>{"gravity", "drag"}));
}

TEST(ForceTerms, ChangeTheFingerprintOfTheSceneEach) {
    std::set<std::string> prints;
    std::string const none = arm("", "");
    for (std::string const& text :
         {none, arm(", torque: 1", ""), arm(", stiffness: 1", ""), arm(", damping: 1", ""),
          arm("", ", wrench: {force: [1, 0, 0]}"), arm("", ", force: [1, 0, 0]"),
          arm("", ", force: [0, 1, 0]"), arm("", ", drag: {linear: 1}"),
          none + "forces: {gravity: [0, 0, -1]}\n", none + "forces: {drag: {linear: 1}}\n"})
        EXPECT_TRUE(prints.insert(scene::fingerprint(parse_scene(text, "s.yaml"))).second) << text;
}

TEST(ForceTerms, AddTheirConstantWrenches) {
    Scene const scene = parse_scene(
        arm("", ", wrench: {torque: [1, 2, 3], force: [4, 5, 6]}, force: [10, 20, 30]"), "s.yaml");
    auto const [torque, force] = terms::constant_wrench(scene.chains[0], 0);
    EXPECT_EQ(terms::vector_text(torque), "[1, 2, 3]");
    EXPECT_EQ(terms::vector_text(force), "[14, 25, 36]");
    EXPECT_EQ(norm(terms::constant_wrench(scene.chains[0], 1).second), 0);
}

}  // namespace
}  // namespace catena::test
