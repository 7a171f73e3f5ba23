// Scenes that commands make themselves.
#include "bench/generated.hpp"

#include <gtest/gtest.h>

#include "integrate/chain_system.hpp"

namespace catena::command {
namespace {

TEST(GeneratedScenes, AlikeBodiesAreAlikeAndOfTheSameKind) {
    auto const alone = serial_communicator();
    for (char const* const joint :
         {"link", "planar", "spherical", "universal", "revolute", "prismatic", "helical", "weld"}) {
        SCOPED_TRACE(joint);
        Scene scene = random_scene(joint, 20, {});
        auto const group_of = [&](ChainSystem const& system) -> ChainGroup const& {
            return *system.groups().front();
        };
        ChainSystem const random(scene, Axes::joint, *alone);
        EXPECT_FALSE(group_of(random).bodies.inverse_mass.alike());
        make_alike(scene);
        ChainSystem alike(scene, Axes::joint, *alone);
        ChainGroup const& group = group_of(alike);
        EXPECT_EQ(group.directions, group_of(random).directions);
        EXPECT_EQ(group.planar, group_of(random).planar);
        EXPECT_TRUE(group.bodies.inverse_mass.alike() && group.bodies.inverse_inertia.alike() &&
                    group.joints.screw.alike());
        EXPECT_TRUE(group.bodies.r1.alike() && group.bodies.r2.alike() &&
                    group.bodies.axes1.alike() && group.bodies.axes2.alike());
        alike.evaluate();
        EXPECT_LE(alike.residual(), alike.residual_bound());
    }
}

TEST(GeneratedScenes, OneBodyIsAlikeAnyway) {
    for (char const* const joint : {"link", "spherical"}) {
        Scene scene = random_scene(joint, 1, {});
        auto const mass = joint == std::string("link") ? scene.chains.front().beads.mass
                                                       : scene.chains.front().bodies.mass;
        make_alike(scene);
        EXPECT_EQ(joint == std::string("link") ? scene.chains.front().beads.mass
                                               : scene.chains.front().bodies.mass,
                  mass);
    }
}

}  // namespace
}  // namespace catena::command
