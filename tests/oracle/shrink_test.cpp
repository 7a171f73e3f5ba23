// The helper that makes failing chains small.
#include "tests/support/shrink.hpp"

#include <gtest/gtest.h>

#include "oracle/oracle.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

TEST(Shrink, FindsTheOneBodyThatMatters) {
    for (Base const base : {Base::fixed, Base::free}) {
        ChainSpec const chain = random_chain(11, {.bodies = 13,
                                                  .joints = RandomJoints::any,
                                                  .base = base,
                                                  .springs = true,
                                                  .drag = true,
                                                  .driven = 0.3,
                                                  .tip = JointType::spherical});
        double const culprit = chain.bodies.mass[7];
        auto const holds = [&](ChainSpec const& c) {
            oracle::aba<double>(c, {});  // each candidate is a chain that the oracles take
            return std::find(c.bodies.mass.begin(), c.bodies.mass.end(), culprit) ==
                   c.bodies.mass.end();
        };
        Shrunk const found = shrink(chain, holds);
        ASSERT_EQ(found.chain.size(), 1U) << found.description;
        EXPECT_EQ(found.chain.bodies.mass[0], culprit);
        EXPECT_TRUE(found.chain.bodies.wrench.empty());
        EXPECT_EQ(found.chain.tip, Tip::free);
        EXPECT_NE(found.description.find("1 bodies"), std::string::npos);
    }
}

/// Dropping bodies leaves a chain of the same kind: what is left of beads and linked bodies solves
/// too.
TEST(Shrink, BeadsAndLinkedBodies) {
    for (Base const base : {Base::fixed, Base::free})
        for (Tip const tip : {Tip::free, Tip::jointed})
            for (ChainSpec const& chain :
                 {random_bead_chain(3, 9, base, tip), random_linked_chain(3, 9, base, tip)}) {
                auto const holds = [](ChainSpec const& c) {
                    return oracle::dense<double>(c, {}).com_acceleration.size() != c.size();
                };
                EXPECT_EQ(shrink(chain, holds).chain.size(), 1U);
            }
}

}  // namespace
}  // namespace catena::test
