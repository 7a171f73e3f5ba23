// Momentum and angular momentum of free chains over long runs under RATTLE.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/integrate/constrained_run.hpp"

namespace catena::test {
namespace {

class LongRun : public ::testing::TestWithParam<std::pair<char const*, std::string>> {};
INSTANTIATE_TEST_SUITE_P(
    Chains, LongRun,
    ::testing::Values(
        std::pair{"spherical", std::string("{name: a, base: free, generator: {random: {bodies: 12, "
                                           "joint: spherical, seed: 1}}}")},
        std::pair{"beads",
                  std::string("{name: a, generator: {freely_jointed: {beads: 30, length: 0.38}}}")},
        std::pair{"linked", std::string("{name: a, base: free, generator: {random: {bodies: 12, "
                                        "joint: link, rigid: 0.5, seed: 1}}}")}),
    [](auto const& chain) { return std::string(chain.param.first); });

/// Impulses at a joint cancel but for a rounding: at worst one a step, all of one sign.
TEST_P(LongRun, KeepsMomenta) {
    int constexpr steps = 100000;
    Constrained run("chains: [" + GetParam().second + "]\n", 0.004);
    Momenta const before = momenta(run.scene(), run.snapshot());
    run.run(steps);
    Momenta const after = momenta(run.scene(), run.snapshot());
    double const linear = norm(after.linear - before.linear) / before.size,
                 angular = norm(after.angular - before.angular) / before.size;
    fmt::print(
        "{}, {} steps: momentum moved by {:.1e}, angular momentum by {:.1e} of their terms; joints "
        "closed to {:.1e}\n",
        GetParam().first, steps, linear, angular, run.constraint_error());
    double constexpr bound = steps * 0x1p-53;
    EXPECT_LE(linear, bound);
    EXPECT_LE(angular, bound);
}

}  // namespace
}  // namespace catena::test
