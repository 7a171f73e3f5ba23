// The scenes of inputs/ load.
#include <filesystem>

#include "reader/load_scene.hpp"
#include "structure/mmcif_file.hpp"
#include "tests/reader/refusal.hpp"

namespace catena::test {
namespace {

namespace fs = std::filesystem;

TEST(Inputs, every_scene_loads) {
    int scenes = 0;
    for (auto const& entry : fs::directory_iterator(CATENA_SOURCE_DIR "/inputs")) {
        if (entry.path().extension() != ".yaml") continue;
        // Its structure is an mmCIF file.
        if (scene::gemmi_version() == "none" && entry.path().stem() == "multi-domain") continue;
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

}  // namespace
}  // namespace catena::test
