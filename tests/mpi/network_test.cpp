// The model of messages, and its measurement on however many ranks there are.
#include "mpi/network.hpp"

#include <gtest/gtest.h>

#include "tests/mpi/world.hpp"

namespace catena::testing {
namespace {

/// Seconds of a gather on so many ranks and hosts, in so many stages.
double gather(Network const& network, std::int64_t bytes, std::int64_t ranks, std::int64_t hosts,
              int stages = 1) {
    GatherWay way;
    way.ranks = ranks;
    way.hosts = hosts;
    way.stages = stages;
    return network.gather_seconds(bytes, way);
}

TEST(Network, AGatherTakesARoundADoublingAndEveryByteOnce) {
    Network network;
    network.near = Link{1e-6, 1e-9};
    network.far = Link{1e-5, 1e-8};
    EXPECT_EQ(gather(network, 1000, 1, 1), 0);
    EXPECT_DOUBLE_EQ(gather(network, 1000, 2, 1), 1e-6 + 500e-9);
    EXPECT_DOUBLE_EQ(gather(network, 0, 8, 1), 3e-6);
    EXPECT_DOUBLE_EQ(gather(network, 0, 5, 1), 3e-6);
    EXPECT_DOUBLE_EQ(gather(network, 0, 4096, 512), 12e-5);
    EXPECT_DOUBLE_EQ(gather(network, 1000, 2, 2), 1e-5 + 500e-8);
    EXPECT_DOUBLE_EQ(gather(network, 0, 4096, 512, 2), 6e-6 + 9e-5);
    EXPECT_DOUBLE_EQ(gather(network, 1000, 8, 2, 2), 4e-6 + 1000e-9 + 1e-5 + 500e-8);
    network.gather_overhead = 2;
    EXPECT_DOUBLE_EQ(gather(network, 0, 2, 1), 2e-6);
    EXPECT_DOUBLE_EQ(network.exchange_seconds(100, 1), 1.1e-6);
    EXPECT_DOUBLE_EQ(network.exchange_seconds(100, 2), 1.1e-5);
    network.far.reset();  // hosts that are there by name alone
    EXPECT_DOUBLE_EQ(gather(network, 0, 8, 2, 2), 2 * (4e-6 + 1e-6));
}

TEST(Network, IsMeasuredBetweenRanks) {
    NetworkTimes const times = time_network(world(), 3);
    EXPECT_EQ(times.ranks, world().size());
    EXPECT_EQ(times.hosts, 1);
    EXPECT_EQ(count_hosts(world()), 1);
    if (times.ranks == 1) {
        EXPECT_FALSE(times.network.near);
        return;
    }
    ASSERT_TRUE(times.network.near);
    EXPECT_FALSE(times.network.far);
    EXPECT_GT(times.network.near->latency, 0);
    EXPECT_GT(times.network.gather_overhead, 0);
    ASSERT_EQ(times.gathers.size(), 13U);  // biases and matrices of 1 to 6 directions, kinematics
    EXPECT_EQ(times.gathers[1].bytes, 64 * 3 * 8);
    EXPECT_EQ(times.gathers[11].bytes, 64 * 78 * 8);
    for (TimedMessage const& each : times.gathers) EXPECT_GT(each.seconds, 0) << each.what;
    EXPECT_GT(time_messages(world(), {3, 3000, 2, 48}, 3), 0);
}

}  // namespace
}  // namespace catena::testing
