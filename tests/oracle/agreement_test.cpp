// The articulated-body algorithm against the dense system on random chains.
#include <gtest/gtest.h>

#include "error.hpp"
#include "tests/oracle/compare.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using oracle::Quad;

/// Every kind of chain in turn: fixed and free base, each mixture of joints, with and without
/// springs; n from 1 to `largest`, small ones more often.
Case random_case(std::uint64_t seed, double largest) {
    Random random(1'000'000 + seed);
    RandomChainOptions options;
    options.bodies = static_cast<std::size_t>(std::pow(largest + 0.99, random.uniform()));
    options.base = seed % 2 == 0 ? Base::fixed : Base::free;
    options.joints = static_cast<RandomJoints>(seed / 2 % 3);
    options.springs = seed / 6 % 2 == 1;
    options.moving = seed / 12 % 4 != 0;
    options.loaded = seed / 12 % 4 != 1;
    return {random_chain(seed, options), {random.vector(10), {}}};
}

template <class S>
void compare(int count, double largest) {
    solvers_agree<S>(count, 16, [&](std::uint64_t seed) { return random_case(seed, largest); });
}

TEST(RandomChains, AThousandRandomChains) { compare<double>(1000, 32); }
TEST(RandomChains, InLongDouble) { compare<long double>(120, 16); }
/// With 113 bits conditioning hides nothing: the two derivations are the same mechanics.
TEST(RandomChains, In113Bits) { compare<Quad>(48, 6); }

/// Every joint type, and every type among the others; driven joints and drag in every other chain.
class EveryJoint : public ::testing::TestWithParam<RandomJoints> {
  protected:
    static Case random_case(std::uint64_t seed, std::size_t largest) {
        Random random(2'000'000 + seed);
        RandomChainOptions options;
        options.bodies = 1 + seed / 2 % largest;
        options.base = seed % 2 == 0 ? Base::fixed : Base::free;
        options.joints = GetParam();
        options.springs = random.chance(0.5);
        options.drag = random.chance(0.5);
        options.driven = random.chance(0.5) ? 0.3 : 0;
        Case c{random_chain(seed, options), {random.vector(10), {}}};
        c.loads.linear_drag = random.uniform(0, 1);
        c.loads.angular_drag = random.uniform(0, 0.1);
        c.loads.time = random.uniform(0, 3);
        return c;
    }
    template <class S>
    static void compare(int count, std::size_t largest) {
        solvers_agree<S>(
            count, 16, [&](std::uint64_t seed) { return random_case(seed, largest); },
            [](Case const& c) {
                inverse_dynamics_agree(c, 16, oracle::condition_estimate(c.chain, c.loads));
            });
    }
};
INSTANTIATE_TEST_SUITE_P(Kinds, EveryJoint,
                         ::testing::Values(RandomJoints::universal, RandomJoints::weld,
                                           RandomJoints::prismatic, RandomJoints::helical,
                                           RandomJoints::planar, RandomJoints::any,
                                           RandomJoints::cylindrical, RandomJoints::planar3,
                                           RandomJoints::all));
TEST_P(EveryJoint, SolversAgree) { compare<double>(240, 12); }
TEST_P(EveryJoint, SolversAgreeIn113Bits) { compare<Quad>(8, 4); }
TEST_P(EveryJoint, SolversAgreeOnJointsThatDoNotClose) {
    Agreement<double> agreement;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Case c = random_case(seed, 8);
        Random random(seed);
        for (std::size_t k = 0; k < c.chain.size(); ++k)
            c.loads.gaps.emplace_back(random.vector(5), random.vector(5));
        ASSERT_LE(agreement.add(c.chain, c.loads), 16)
            << "seed " << seed << ", " << c.chain.size() << " bodies";
    }
}

TEST(RandomChains, EmptyChain) {
    ChainSpec const chain;
    EXPECT_TRUE(oracle::aba<double>(chain, {}).qdd.empty());
    EXPECT_TRUE(oracle::dense<double>(chain, {}).qdd.empty());
    EXPECT_EQ(oracle::condition_estimate(chain), 1.0);
}

TEST(RandomChains, UnphysicalAndUnknownChainsAreRefusedByBody) {
    ChainSpec chain = random_chain(3, {.bodies = 4});
    chain.bodies.joint[2] = JointType::link;
    try {
        oracle::aba<double>(chain, {});
        FAIL() << "a link joint between rigid bodies passed";
    } catch (ComputationError const& error) {
        EXPECT_NE(std::string(error.what()).find("(joint 3)"), std::string::npos) << error.what();
    }
    chain = random_chain(3, {.bodies = 4, .joints = RandomJoints::spherical});
    for (double& x : chain.bodies.inertia[3].data) x = -x;
    chain.bodies.com[3] = Vec3::zero();
    try {
        oracle::aba<double>(chain, {});
        FAIL() << "a negative inertia passed";
    } catch (ComputationError const& error) {
        EXPECT_NE(std::string(error.what()).find("(body 4)"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace catena::test
