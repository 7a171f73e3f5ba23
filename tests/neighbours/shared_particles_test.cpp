// What GPUs that share out pairs send each other, on the host.
#include "neighbours/shared_particles.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace catena::testing {
namespace {

TEST(SharedParticles, PositionsGoFromArrayToArray) {
    std::vector<float> here, there(16, -1.0f);
    for (int i = 0; i < 16; ++i) here.push_back(static_cast<float>(i));
    std::vector<std::int32_t> const own{1, 3}, received{2, 0};
    std::vector<float> first(6), second(6);
    SentPositions sent{here.data(), own.data()};
    for (std::vector<float>* box : {&first, &second}) sent.to[sent.messages++] = box->data();
    for (std::int64_t i = 0; i < 6; ++i) sent(i);
    EXPECT_EQ(first, (std::vector<float>{4, 5, 6, 12, 13, 14}));
    EXPECT_EQ(second, first);
    ArrivedPositions const arrived{there.data(), received.data(), first.data()};
    for (std::int64_t i = 0; i < 6; ++i) arrived(i);
    EXPECT_EQ(there, (std::vector<float>{12, 13, 14, -1, -1, -1, -1, -1, 4, 5, 6, -1, -1, -1, -1,
                                         -1}));  // charges stay
}

struct Forces {
    std::vector<std::int64_t> force = std::vector<std::int64_t>(12, 0);  // of four places
    ForcesOnBeads on(std::vector<std::int32_t> const& place) {
        return {force.data(), 4, place.data()};
    }
};

TEST(SharedParticles, PartsOfForcesGo) {
    Forces f;
    for (std::size_t i = 0; i < 12; ++i) f.force[i] = static_cast<std::int64_t>(10 * i);
    std::vector<std::int32_t> const others{0, 1};
    std::vector<std::int64_t> one(3), two(3);
    SentForces<std::int64_t> sent{f.on(others)};
    sent.add(1, one.data());
    sent.add(1, two.data());
    ASSERT_EQ(sent.count(), 2);
    for (std::int64_t i = 0; i < 6; ++i) sent(i);
    EXPECT_EQ(one, (std::vector<std::int64_t>{0, 40, 80}));
    EXPECT_EQ(two, (std::vector<std::int64_t>{10, 50, 90}));
    f.force[0] = f.force[1] = 0;  // nothing acts along x
    std::vector<std::int64_t> both{1, 2, 3, 4, 5, 6};
    SentForces<std::int64_t> without_zeros{f.on(others)};
    without_zeros.add(2, both.data());
    without_zeros.all = false;
    for (std::int64_t i = 0; i < 6; ++i) without_zeros(i);
    EXPECT_EQ(both, (std::vector<std::int64_t>{1, 40, 80, 4, 50, 90}));
}

TEST(SharedParticles, PartsOfForcesComeBack) {
    Forces f;
    for (std::size_t i = 0; i < 12; ++i) f.force[i] = static_cast<std::int64_t>(10 * i);
    std::vector<std::int32_t> const own{2, 0};
    std::vector<std::int64_t> arrived{1, 2, 3, 0, 5, 6, 100, 200, 300, 400, 500, 600};
    ReturnedForces<std::int64_t> const returned{f.on(own), arrived.data(), 2, 2};
    for (std::int64_t i = 0; i < 6; ++i) returned(i);
    EXPECT_EQ(f.force, (std::vector<std::int64_t>{400, 10, 20 + 101, 30, 40 + 505, 50, 60 + 202, 70,
                                                  80 + 606, 90, 100 + 303, 110}));
    EXPECT_EQ(arrived,
              std::vector<std::int64_t>(12, 0));  // for what comes next, of which zeros stay away
    std::int64_t const none = INT64_MIN;          // what OpenMM makes of NaN
    std::vector<std::int64_t> parts{none, 0, 0, 0, 0, 0, none, 0, 0, 0, 0, 0};
    ReturnedForces<std::int64_t> const without_sense{f.on(own), parts.data(), 2, 2};
    for (std::int64_t i = 0; i < 6; ++i) without_sense(i);
    EXPECT_FALSE(DeviceParticles::is_number(f.force[2]));
}

TEST(SharedParticles, InSinglePrecision) {
    Forces here, there;
    here.force[0] = std::int64_t{3} << 40;
    here.force[4] =
        -((std::int64_t{1} << 50) + 1);  // of which single precision has all but the last bit
    here.force[8] = INT64_MIN;
    here.force[1] = INT64_MAX;
    std::vector<std::int32_t> const place{0, 1};
    std::vector<float> box(6, 0.0f);
    SentForces<float> sent{here.on(place)};
    sent.add(2, box.data());
    sent.all = false;
    for (std::int64_t i = 0; i < 6; ++i) sent(i);
    there.force = std::vector<std::int64_t>(12, 5);
    ReturnedForces<float> const returned{there.on(place), box.data(), 2, 1};
    for (std::int64_t i = 0; i < 6; ++i) returned(i);
    EXPECT_EQ(there.force[0], (std::int64_t{3} << 40) + 5);
    EXPECT_EQ(there.force[4], 5 - (std::int64_t{1} << 50));
    EXPECT_EQ(there.force[5], 5);
    for (std::size_t i : {8, 1}) EXPECT_FALSE(DeviceParticles::is_number(there.force[i]));
    EXPECT_EQ(box, std::vector<float>(6, 0.0f));
    float const beyond = 9.3e18f;
    EXPECT_FALSE(DeviceParticles::is_number(arrived_force(beyond)));
    EXPECT_FALSE(DeviceParticles::is_number(arrived_force(-beyond)));
}

}  // namespace
}  // namespace catena::testing
