#include "tests/dca/campaign.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

TEST(Campaign, ChainsOf2000SeedsAgreeWithTheOracles) { run_campaign(1, 2000); }
TEST(Campaign, ChainsOfLaterJointsAgreeWithTheOracles) {
    run_campaign(1, 2000, CampaignJoints::later);
}

/// What hangs on three slides at right angles falls freely: no force is left there, and the
/// residual must not ask for digits of none.
TEST(Campaign, BodiesThatFallFreely) {
    RandomChainOptions const slides{
        .bodies = 12, .joints = RandomJoints::prismatic, .moving = false, .loaded = false};
    CampaignCase c;
    c.chain = random_chain(1, slides);
    c.loads.gravity = {{1, 2, -9.81}};
    BodyArrays& b = c.chain.bodies;
    for (std::size_t k = 0; k < b.size(); ++k) {
        b.rotation[k] = Mat3::identity();
        b.axis[k] = Vec3::zero();
        b.axis[k][static_cast<int>(k % 3)] = 1;
    }
    for (Handles const handles : {Handles::projected, Handles::full}) {
        c.handles = handles;
        CampaignErrors const e = campaign_errors(c, c.chain);
        EXPECT_TRUE(e.good()) << name_of(handles) << ": " << e.text();
    }
}

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
    EXPECT_TRUE(std::count(found.chain.bodies.mass.begin(), found.chain.bodies.mass.end(), mass))
        << found.description;
}

}  // namespace
}  // namespace catena::test
