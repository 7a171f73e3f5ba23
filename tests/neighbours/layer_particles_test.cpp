// What passes between the arrays of all particles and those of a layer, on the host.
#include "neighbours/layer_particles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace catena::testing {
namespace {

template <class Number>
void expect_positions_copied() {
    std::vector<Number> all, layer(8, Number{-1}), listed;
    for (int i = 0; i < 16; ++i) all.push_back(static_cast<Number>(i));
    std::vector<std::int32_t> const from{3, 1};
    std::int64_t far = 0;
    LayerPositions<Number> positions{from.data(), all.data(), layer.data()};
    positions.far = &far;
    for (std::int64_t i = 0; i < 2; ++i) positions(i);
    EXPECT_EQ(layer, (std::vector<Number>{12, 13, 14, -1, 4, 5, 6, -1}));  // charges stay
    EXPECT_EQ(far, 0);

    listed = layer;
    positions.listed = listed.data();
    positions.farthest_squared = 0.25f;
    for (std::size_t c : {0, 1, 2}) all[4 + c] += Number(0.25);  // 0.43 from there
    for (std::size_t c : {0, 1, 2}) all[c] += Number(10);        // in no layer
    for (std::int64_t i = 0; i < 2; ++i) positions(i);
    EXPECT_EQ(far, 0);
    all[12] += Number(0.5);
    positions(1);
    EXPECT_EQ(far, 0);
    positions(0);
    EXPECT_EQ(far, 1);
    EXPECT_EQ(layer, (std::vector<Number>{12.5, 13, 14, -1, 4.25, 5.25, 6.25, -1}));
    far = 0;
    all[5] = static_cast<Number>(NAN);
    positions(1);
    EXPECT_EQ(far, 1);
}

TEST(LayerParticles, TakePositionsAndNoteWhoIsFar) {
    expect_positions_copied<float>();
    expect_positions_copied<double>();
}

TEST(LayerParticles, AddForces) {
    std::vector<std::int64_t> all(12), some(6);  // of four and two places
    for (std::size_t i = 0; i < 12; ++i) all[i] = static_cast<std::int64_t>(10 * i);
    for (std::size_t i = 0; i < 6; ++i) some[i] = -static_cast<std::int64_t>(i + 1);
    std::vector<std::int32_t> const from{2};  // the other place of the layer is for no particle
    LayerForces const forces{{all.data(), 4, from.data()}, some.data(), 2, 1};
    for (std::int64_t i = 0; i < 3; ++i) forces(i);
    EXPECT_EQ(all, (std::vector<std::int64_t>{0, 10, 20 - 1, 30, 40, 50, 60 - 3, 70, 80, 90,
                                              100 - 5, 110}));
    all[2] = some[0] = INT64_MIN;  // what OpenMM makes of NaN: their sum would be 0
    forces(0);
    EXPECT_FALSE(DeviceParticles::is_number(all[2]));
    all[2] = 1;
    forces(0);
    EXPECT_FALSE(DeviceParticles::is_number(all[2]));
}

}  // namespace
}  // namespace catena::testing
