// Regular polygons of rods and of beads, and the tips that close them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "oracle/oracle.hpp"
#include "reader/load_scene.hpp"

namespace catena::test {
namespace {

/// Sides of one length that close; spun, the centre of mass rests.
TEST(Polygons, are_regular_and_spin_about_their_centre) {
    for (char const* const joint : {"spherical", "revolute"}) {
        ChainSpec const chain =
            parse_scene(fmt::format("chains: [{{base: free, generator: {{polygon: {{bodies: 7, "
                                    "joint: {}, length: 2, mass: 3, spin: [1, 2, 3]}}}}, tip: "
                                    "{{ring: {{type: spherical, translation: [2, 0, 0]}}}}}}]",
                                    joint),
                        "s.yaml")
                .chains[0];
        auto const at = oracle::kinematics<double>(chain, {});
        Vec3 momentum = Vec3::zero(), centre = Vec3::zero();
        for (std::size_t k = 0; k < 7; ++k) {
            momentum = momentum + 3.0 * at.com_velocity[k];
            centre = centre + (1.0 / 7) * at.com_position[k];
            EXPECT_LE(norm(at.omega[k] - Vec3{{1, 2, 3}}), 64 * 0x1p-52) << joint;
        }
        EXPECT_LE(norm(momentum), 64 * 0x1p-52 * 3 * 2 * 4) << joint;
        for (std::size_t k = 0; k < 7; ++k)
            EXPECT_NEAR(norm(at.com_position[k] - centre), 1 / std::tan(std::acos(-1.0) / 7),
                        64 * 0x1p-52)
                << joint;
    }
    ChainSpec const beads =
        parse_scene(
            "chains: [{generator: {polygon: {bodies: 100, joint: link, length: 0.5}}, tip: ring}]",
            "s.yaml")
            .chains[0];
    EXPECT_TRUE(beads.is_ring());
    EXPECT_NEAR(beads.tip_joint.length, 0.5, 1e-12);
}

}  // namespace
}  // namespace catena::test
