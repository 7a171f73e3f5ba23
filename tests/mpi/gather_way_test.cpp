// What CATENA_GATHER and CATENA_GPU_EXCHANGE may say, and the rule without the former.
#include "mpi/gather_way.hpp"

#include <gtest/gtest.h>

#include "error.hpp"
#include "mpi/gpu_exchange.hpp"

namespace catena {
namespace {

using Stages = GatherChoice::Stages;

TEST(GatherWay, ChoicesByName) {
    EXPECT_EQ(gather_choice("").stages, Stages::automatic);
    EXPECT_EQ(gather_choice("auto").stages, Stages::automatic);
    EXPECT_EQ(gather_choice("one-stage").stages, Stages::one);
    EXPECT_EQ(gather_choice("two-stage").stages, Stages::two);
    EXPECT_EQ(gather_choice("two-stage").ranks_a_host, 0);
    EXPECT_EQ(gather_choice("two-stage:3").stages, Stages::two);
    EXPECT_EQ(gather_choice("two-stage:3").ranks_a_host, 3);
    for (char const* const wrong :
         {"two", "two-stage:", "two-stage:0", "two-stage:-1", "two-stage:3x", "one-stage:2"})
        EXPECT_THROW(gather_choice(wrong), InputError) << wrong;
}

TEST(GpuExchange, ChoicesByName) {
    EXPECT_EQ(gpu_exchange_choice(""), GpuExchange::direct_where_possible);
    EXPECT_EQ(gpu_exchange_choice("auto"), GpuExchange::direct_where_possible);
    EXPECT_EQ(gpu_exchange_choice("direct"), GpuExchange::direct_where_possible);
    EXPECT_EQ(gpu_exchange_choice("host"), GpuExchange::host);
    EXPECT_THROW(gpu_exchange_choice("hosts"), InputError);
}

TEST(GatherWay, TwoStagesOnManyRanksOfSeveralHosts) {
    EXPECT_EQ(GatherWay::of({}, 31, 2).stages, 1);
    EXPECT_EQ(GatherWay::of({}, 32, 2).stages, 2);
    EXPECT_EQ(GatherWay::of({}, 64, 1).stages, 1);
    EXPECT_EQ(GatherWay::of({}, 64, 64).stages, 1);  // one rank a host
    EXPECT_EQ(GatherWay::of(gather_choice("two-stage"), 2, 1).stages, 2);
    EXPECT_EQ(GatherWay::of(gather_choice("one-stage"), 64, 2).stages, 1);
}

TEST(GatherWay, CountsPiecesOfWhatTwoStagesSend) {
    GatherWay way = GatherWay::of({}, 64, 2);
    way.piece = 100;
    EXPECT_EQ(way.within_and_between_hosts(250), (Traffic{0, 0, 0, 0, 6, 3, 250}));
    EXPECT_EQ(way.within_and_between_hosts(0), Traffic{});
    way.leads = false;
    EXPECT_EQ(way.within_and_between_hosts(250), (Traffic{0, 0, 0, 0, 6, 0, 0}));
    EXPECT_EQ(GatherWay{}.within_and_between_hosts(250), Traffic{});
}

}  // namespace
}  // namespace catena
