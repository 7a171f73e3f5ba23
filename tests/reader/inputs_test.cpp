// The scenes of inputs/ load, and the pages of inputs/ speak of every key.
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "reader/load_scene.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

namespace fs = std::filesystem;

TEST(Inputs, every_scene_loads) {
    int scenes = 0;
    for (auto const& entry : fs::directory_iterator(CATENA_SOURCE_DIR "/inputs")) {
        if (entry.path().extension() != ".yaml") continue;
        ++scenes;
        EXPECT_NO_THROW({
            Scene const scene = load_scene(entry.path().string());
            EXPECT_GT(scene.bodies(), 0);
        }) << entry.path();
    }
    EXPECT_GE(scenes, 17);
}

TEST(Inputs, alpha_synuclein) {
    Scene const s = load_scene(CATENA_SOURCE_DIR "/inputs/alpha-synuclein.yaml");
    ASSERT_EQ(s.bodies(), 140);
    EXPECT_EQ(s.chains[0].velocities, StartVelocities::thermal);
    BeadArrays const& beads = s.chains[0].beads;
    for (std::size_t k = 1; k < beads.size(); ++k)
        EXPECT_NEAR(norm(beads.position[k] - beads.position[k - 1]), 0.38, 1e-14);
    double mass = 0;
    for (double const m : beads.mass) mass += m;
    EXPECT_NEAR(mass, 14460.1, 0.5);  // amu, UniProt P37840
}

/// The keys that a message lists when a map has a key that is like none of them.
std::vector<std::string> known_keys(std::string const& yaml) {
    std::string const message = refusal_of(yaml);
    std::vector<std::string> keys;
    static std::regex const name("`([a-z0-9_]+)`");
    std::string const tail = message.substr(message.find("): ") + 1);
    for (std::sregex_iterator it(tail.begin(), tail.end(), name), end; it != end; ++it)
        keys.push_back((*it)[1]);
    return keys;
}

/// inputs/README.md and the pages of keys, one after the other.
std::string pages_of_keys() {
    std::stringstream pages;
    pages << std::ifstream(CATENA_SOURCE_DIR "/inputs/README.md").rdbuf();
    for (auto const& entry : fs::directory_iterator(CATENA_SOURCE_DIR "/inputs/keys"))
        pages << std::ifstream(entry.path()).rdbuf();
    return pages.str();
}

TEST(Inputs, the_pages_document_every_key) {
    std::string const pages = pages_of_keys();
    std::string const chain = "chains: [{sequence: G, model: calvados2}]\n",
                      odd = "{zzzzzzzzzzzz: 1}";
    std::string const rigid = "chains: [{base: fixed, bodies: [{mass: 1, inertia: [1, 1, 1], ";
    std::set<std::string> keys;
    std::vector<std::string> const scenes{
        odd,
        "chains: [" + odd + "]",
        chain + "box: " + odd,
        chain + "forces: " + odd,
        chain + "forces: {openmm: " + odd + "}",
        chain + "dynamics: " + odd,
        chain + "solver: " + odd,
        chain + "output: " + odd,
        "chains: [{generator: " + odd + "}]",
        "chains: [{generator: {random: " + odd + "}}]",
        "chains: [{generator: {pendulum: " + odd + "}}]",
        "chains: [{generator: {freely_jointed: " + odd + "}}]",
        "chains: [{bodies: [" + odd + "]}]",
        "chains: [{bodies: [{mass: 1, inertia: [1, 1, 1], joint: " + odd + "}]}]",
        "chains: [{bodies: [{mass: 1, inertia: [1, 1, 1], wrench: " + odd + "}]}]",
        "chains: [{bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free, q: " + odd + "}}]}]",
        "chains: [{bodies: [{mass: 1, inertia: [1, 1, 1], joint: {type: free, qd: " + odd + "}}]}]",
        "chains: [{bodies: [{mass: 1, position: [0, 0, 0], joint: {type: link}, zzzzzzzzzzzz: "
        "1}]}]",
        "chains: [{sequence: G, model: calvados2, conformation: " + odd + "}]",
        "chains: [{sequence: G, model: calvados2, tip: " + odd + "}]",
        "chains: [{sequence: G, model: calvados2, tip: {joint: " + odd + "}}]",
        chain + "forces: {drag: " + odd + "}",
        "chains: [{generator: {coil: " + odd + "}}]",
        "chains: [{generator: {dill: " + odd + "}}]",
        "chains: [{generator: {worm_like: " + odd + "}}]",
        "chains: [{generator: {pendulum: {links: 1, mass: " + odd + "}}}]",
        "chains: [{bodies: " + odd + "}]",
        rigid + "joint: {type: weld}, beads: [" + odd + "]}]}]",
        rigid + "joint: {type: revolute, axis: [0, 0, 1], motion: " + odd + "}}]}]",
        rigid + "position: [0, 0, 0], joint: {type: link}, zzzzzzzzzzzz: 1}]}]"};
    for (std::string const& yaml : scenes) {
        std::vector<std::string> const found = known_keys(yaml);
        EXPECT_FALSE(found.empty()) << refusal_of(yaml);
        keys.insert(found.begin(), found.end());
    }
    EXPECT_GE(keys.size(), 105u);
    for (std::string const& key : keys)
        EXPECT_NE(pages.find("`" + key + "`"), std::string::npos) << key;
}

}  // namespace
}  // namespace catena::test
