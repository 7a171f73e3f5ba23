#include <gtest/gtest.h>

#include "tests/dca/campaign.hpp"

namespace catena::test {
namespace {

TEST(Campaign, ChainsOf10000SeedsAgreeWithTheOracles) { run_campaign(1, 10000); }
TEST(Campaign, ChainsOf10000SeedsOfLaterJointsAgreeWithTheOracles) {
    run_campaign(1, 10000, CampaignJoints::later);
}

}  // namespace
}  // namespace catena::test
