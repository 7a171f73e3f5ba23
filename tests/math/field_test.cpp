// How arrays of bodies lie in memory: the host's, and the order of a GPU's.
#include "math/field.hpp"

#include <gtest/gtest.h>

#include <set>

#include "integrate/chain_system.hpp"
#include "reader/load_scene.hpp"

namespace catena {
namespace {

TEST(GpuOrder, EveryNumberHasItsPlaceAndTheHaloComesBefore) {
    for (int const columns : {1, 3, 27})
        for (std::int64_t const bodies : {1, 16, 511, 512, 513, 1500}) {
            std::int64_t const pitch = gpu_order::pitch(columns),
                               end = gpu_order::padded(bodies) * columns;
            std::set<std::int64_t> taken;
            for (std::int64_t k = -1; k < bodies; ++k)
                for (int i = 0; i < columns; ++i) {
                    std::int64_t const place =
                        gpu_order::first_number(k, pitch) + i * gpu_order::lanes;
                    EXPECT_TRUE(k < 0 ? place >= -pitch && place < 0 : place >= 0 && place < end)
                        << k << " " << i;
                    EXPECT_TRUE(taken.insert(place).second) << k << " " << i;
                }
        }
}

TEST(GpuOrder, ThreadsSideBySideTouchWholeLines) {
    std::set<std::int64_t> seen;
    for (std::int64_t i = 0; i < 2 * gpu_order::tile; ++i) {
        std::int64_t const k = gpu_order::body(i);
        EXPECT_TRUE(seen.insert(k).second);
        EXPECT_EQ(gpu_order::first_number(k, gpu_order::pitch(1)), i);
        EXPECT_EQ(gpu_order::first_number(k, 0), i % gpu_order::lanes);  // all rows in one
    }
    EXPECT_EQ(*seen.rbegin(), 2 * gpu_order::tile - 1);
}

TEST(Field, IsAlikeToTheBit) {
    Field<2> field(700);
    EXPECT_TRUE(Field<2>().alike());
    for (std::int64_t k = 0; k < 700; ++k) field.set(k, {{0.1, 0}});
    field.set(-1, {{3, 3}}), field.set(700, {{4, 4}});
    EXPECT_TRUE(field.alike());
    for (std::int64_t const other : {0, 1, 699}) {
        field.set(other, {{0.1, -0.0}});
        EXPECT_FALSE(field.alike()) << other;
        field.set(other, {{0.1, 0}});
    }
    EXPECT_TRUE(field.alike());
}

TEST(Field, SomeComponentsAreAFieldOfTheirOwn) {
    Field<5> field(3);
    for (std::int64_t k = -1; k <= 3; ++k)
        for (int i = 0; i < 5; ++i) field.view().at(k, i) = static_cast<double>(10 * k + i);
    View<2> const some = field.view().components<2>(3);
    EXPECT_EQ(some.size, 3);
    for (std::int64_t k = -1; k <= 3; ++k)
        for (int i = 0; i < 2; ++i) EXPECT_EQ(some.load(k)[i], static_cast<double>(10 * k + 3 + i));
}

/// The last one, whose tip nobody holds, is no exception.
TEST(Field, AlikeBodiesOfAChainHaveAlikeHandles) {
    auto const alone = serial_communicator();
    Scene const scene = parse_scene(
        "chains: [{base: fixed, generator: {pendulum: {links: 9, mass: 2, length: 3}}}]",
        "alike.yaml");
    ChainSystem const system(scene, Axes::joint, *alone);
    ChainGroup const& group = *system.groups().front();
    EXPECT_TRUE(group.bodies.inverse_mass.alike() && group.bodies.inverse_inertia.alike());
    EXPECT_TRUE(group.bodies.r1.alike() && group.bodies.r2.alike() && group.bodies.axes1.alike() &&
                group.bodies.axes2.alike());
}

}  // namespace
}  // namespace catena
