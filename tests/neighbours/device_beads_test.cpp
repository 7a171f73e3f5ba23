// What is written into OpenMM's arrays and read from them, on the host.
#include "neighbours/device_beads.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "neighbours/bead_tables.hpp"

namespace catena::testing {
namespace {

struct Arrays {
    std::vector<DeviceBead> bead{{2, {0, 0, 0}}, {0, {1, 0, -2}}, {1, {0, 0, 0}}};
    std::vector<float> position = std::vector<float>(16, 7.0f),
                       correction = std::vector<float>(16, 7.0f);
    std::vector<double> double_position = std::vector<double>(16, 7.0);
    std::vector<std::int64_t> force = std::vector<std::int64_t>(12, 0);
    std::int64_t trouble = -1;
    DeviceParticles single() {
        DeviceParticles p;
        p.bead = bead.data();
        p.position = position.data();
        p.force = force.data();
        p.places = 4;
        p.origin = {{1, 0, 0}};
        p.box = {{10, 10, 10}};
        p.trouble = &trouble;
        return p;
    }
    DeviceParticles mixed() {
        DeviceParticles p = single();
        p.correction = correction.data();
        return p;
    }
    DeviceParticles doubles() {
        DeviceParticles p = single();
        p.position = nullptr;
        p.double_position = double_position.data();
        return p;
    }
};

TEST(DeviceBeads, PositionsGoToTheirPlacesAndCells) {
    Arrays a;
    a.mixed().put(1, {{12.1, 3, -17}});
    EXPECT_EQ(a.position[0], static_cast<float>(12.1 - 1 - 10));
    EXPECT_EQ(a.position[1], 3.0f);
    EXPECT_EQ(a.position[2], 3.0f);
    EXPECT_EQ(a.position[3], 7.0f);  // a charge
    EXPECT_NEAR(static_cast<double>(a.position[0]) + static_cast<double>(a.correction[0]), 1.1,
                1e-14);
    a.single().put(0, {{2, 3, 4}});
    EXPECT_EQ(a.position[8], 1.0f);
    EXPECT_EQ(a.correction[8], 7.0f);
    a.doubles().put(2, {{0.1, 0.2, 0.3}});
    EXPECT_EQ(a.double_position[4], 0.1 - 1);
    EXPECT_EQ(a.trouble, -1);
}

TEST(DeviceBeads, HowFarParticlesAreFromWhereTheirListWasMade) {
    for (bool const twice : {false, true}) {
        Arrays a;
        std::vector<float> const listed(16, 1.5f);
        std::vector<double> const double_listed(16, 1.5);
        std::int64_t far = 0;
        DeviceParticles p = twice ? a.doubles() : a.single();
        p.origin = p.box = Vec3::zero();
        p.put(0, {{9, 9, 9}});  // nobody asks
        p.double_listed = twice ? double_listed.data() : nullptr;
        p.listed = twice ? nullptr : listed.data();
        p.far = &far;
        p.farthest_squared = 0.25f;
        p.put(0, {{1.2, 1.5, 1.8}});
        EXPECT_EQ(far, 0);
        p.put(0, {{1.2, 1.1, 1.4}});
        EXPECT_EQ(far, 1);
        far = 0;
        p.put(1, {{NAN, 1.5, 1.5}});
        EXPECT_EQ(far, 1);
    }
}

TEST(DeviceBeads, ForcesAreFixedPointNumbersOfTheirPlace) {
    Arrays a;
    a.force[1] = std::int64_t{3} << 31;
    a.force[1 + 4] = -(std::int64_t{5} << 32);
    a.force[1 + 8] = 1;
    Vec3 const f = a.single().force_on(2);
    EXPECT_EQ(f[0], 1.5);
    EXPECT_EQ(f[1], -5);
    EXPECT_EQ(f[2], 1.0 / 4294967296.0);
    EXPECT_EQ(a.trouble, -1);
}

TEST(DeviceBeads, TroubleNamesTheBead) {
    Arrays a;
    a.single().put(1, {{0, std::numeric_limits<double>::quiet_NaN(), 0}});
    EXPECT_EQ(a.trouble, 1);
    a.single().put(2, {{0, 0, std::numeric_limits<double>::infinity()}});
    EXPECT_EQ(a.trouble, 2);
    a.force[2 + 8] = std::numeric_limits<std::int64_t>::min();  // what a GPU makes of a NaN
    a.single().force_on(0);
    EXPECT_EQ(a.trouble, 0);
    DeviceParticles second = a.single().from(1);
    second.put(0, {{0, -std::numeric_limits<double>::infinity(), 0}});
    EXPECT_EQ(a.trouble, 1);
}

/// Bead 0 goes to places 1 and 3, bead 2 to place 0.
TEST(DeviceBeads, ThoseThatOthersHaveAreShown) {
    std::vector<std::int64_t> const sent{2, 0, 1, 0};
    ShownTable const table = shown_table(sent, 3);
    EXPECT_EQ(table.first, (std::vector<std::int32_t>{0, 2, 3, 4}));
    EXPECT_EQ(table.place, (std::vector<std::int32_t>{1, 3, 2, 0}));
    std::vector<Vec3> out(4, Vec3::zero());
    std::vector<Vec3> const listed{{{0, 0, 0}}, {{1, 0, 0}}, {{2, 0, 0}}};
    std::int64_t far = 0, trouble = -1;
    ShownBeads shown;
    shown.first = table.first.data();
    shown.place = table.place.data();
    shown.shown = out.front().data;
    shown.listed = listed.front().data;
    shown.farthest_squared = 0.25;
    shown.far = &far;
    shown.trouble = &trouble;
    shown.show(0, {{0.1, 0.2, 0.3}});
    shown.from(2).show(0, {{2, 0.4, -0.2}});
    for (std::size_t i : {1, 3}) EXPECT_EQ(out[i][2], 0.3);
    EXPECT_EQ(out[0][1], 0.4);
    EXPECT_EQ(out[2][0], 0);  // bead 1 was not asked
    EXPECT_EQ(far, 0);
    shown.from(1).show(0, {{1, 0.3, -0.4}});
    EXPECT_EQ(far, 1);  // half a nanometre, to the bit
    EXPECT_EQ(trouble, -1);
    far = 0;
    shown.show(2, {{2, std::numeric_limits<double>::quiet_NaN(), 0}});
    EXPECT_EQ(trouble, 2);
    shown.listed = nullptr;
    far = 0;
    shown.show(1, {{1e9, 0, 0}});
    EXPECT_EQ(far, 0);
}

TEST(DeviceBeads, ABeadsCellIsTheBoxesThatItIsAway) {
    EXPECT_EQ(bead_at(7, {{-0.1, 5, 21}}, Vec3{{10, 10, 10}}).cell[0], -1);
    EXPECT_EQ(bead_at(7, {{-0.1, 5, 21}}, Vec3{{10, 10, 10}}).cell[2], 2);
    EXPECT_EQ(bead_at(7, {{-0.1, 5, 21}}, std::nullopt).cell[2], 0);
    EXPECT_EQ(bead_at(7, {{-0.1, 5, 21}}, std::nullopt).place, 7);
}

TEST(DeviceBeads, OfReplicasGoToTheirPlaces) {
    Arrays a;
    std::vector<double> const centre{0, 0, 0, 1000, 0, -2000, 5, 5, 5};
    std::int64_t strayed = 0;
    DeviceParticles p = a.mixed();
    p.centre = centre.data();
    p.box = {{30, 30, 30}};
    p.farthest = 12;
    p.strayed = &strayed;
    p.put(1, {{1001, 2, -1990}});  // cells 1, 0, -2
    EXPECT_EQ(a.position[0], 1.0f - 30);
    EXPECT_EQ(a.position[1], 2.0f);
    EXPECT_EQ(a.position[2], 10.0f + 60);
    p.from(1).put(0, {{1012, 12, -2012}});
    EXPECT_EQ(a.position[0], 12.0f - 30);
    EXPECT_EQ(strayed, 0);
    p.put(1, {{1001, -12.01, -1990}});
    EXPECT_EQ(strayed, 1);
    strayed = 0;
    p.put(1, {{1001, std::numeric_limits<double>::quiet_NaN(), -1990}});
    EXPECT_EQ(strayed, 1);
    EXPECT_EQ(a.trouble, 1);
}

}  // namespace
}  // namespace catena::testing
