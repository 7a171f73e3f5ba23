// A build without OpenMM.
#include <gtest/gtest.h>

#include <string>

#include "error.hpp"
#include "force/openmm_force.hpp"
#include "systems/import.hpp"

namespace catena {
namespace {

template <class Call>
void expect_built_without(Call call) {
    try {
        call();
        ADD_FAILURE() << "nothing was thrown";
    } catch (InputError const& e) {
        EXPECT_TRUE(
            std::string(e.what()).starts_with("built without OpenMM (scene.yaml: forces.openmm): "))
            << e.what();
    }
}

TEST(WithoutOpenMm, EveryUseSaysSo) {
    EXPECT_EQ(openmm_version(), "none");
    BeadSystem beads;
    beads.scene_file = "scene.yaml";
    auto const serial = serial_communicator();
    expect_built_without([&] { make_openmm_force({}, beads, *serial); });
    expect_built_without([&] { import_openmm_system({}, "scene.yaml"); });
    expect_built_without([&] { read_system_links({}, "scene.yaml"); });
    expect_built_without([&] { read_openmm_state("state.xml", "scene.yaml: forces.openmm"); });
    expect_built_without([&] { chains_by_bonds({}, "scene.yaml: forces.openmm"); });
}

}  // namespace
}  // namespace catena
