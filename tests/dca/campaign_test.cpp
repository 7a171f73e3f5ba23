#include "tests/dca/campaign.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace catena::test {
namespace {

TEST(Campaign, ChainsOf2000SeedsAgreeWithTheOracles) { run_campaign(1, 2000); }

/// One mass in forty wrong by a millionth is seen, and the chain made small round it.
TEST(Campaign, AWrongAnswerIsShrunk) {
    std::uint64_t seed = 1;
    while (campaign_case(seed).chain.bodies.size() < 40) ++seed;
    CampaignCase const c = campaign_case(seed);
    double const mass = c.chain.bodies.mass[23];
    auto const good = [&](CampaignCase const& smaller) {
        ChainSpec solved = smaller.chain;
        for (double& m : solved.bodies.mass)
            if (m == mass) m *= 1 + 1e-6;
        return campaign_errors(smaller, solved).good();
    };
    ASSERT_FALSE(good(c));
    Shrunk const found = smallest_failing(c, good);
    EXPECT_LE(found.chain.size(), 2U) << found.description;
    EXPECT_TRUE(std::count(found.chain.bodies.mass.begin(), found.chain.bodies.mass.end(), mass)) << found.description;
}

}  // namespace
}  // namespace catena::test
