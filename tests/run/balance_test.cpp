// Ranks with unequal shares: the same bits as one rank with everything; shares follow what is
// measured and are those of the checkpoint.
#include "run/balance.hpp"

#include <chrono>
#include <cstring>
#include <thread>

#include "measure/solution.hpp"
#include "mpi/timed_communicator.hpp"
#include "reader/load_scene.hpp"
#include "tests/run/whole_run.hpp"

namespace catena::test {
namespace {

Communicator const& world() { return catena::testing::world(); }

Scene scene_of(std::string const& chains) {
    return parse_scene("units: si\nforces: {gravity: [0, 0, -9.81]}\nchains:\n" + chains, "test");
}

std::string generated(std::string const& joint, int bodies, bool fixed) {
    return "  - {base: " + std::string(fixed ? "fixed" : "free") +
           ", generator: {random: {bodies: " + std::to_string(bodies) + ", joint: " + joint +
           ", seed: 5}}}\n";
}

Solution solve(Scene scene, Backend backend, Handles handles, Communicator const& communicator,
               dca::Shares const& shares = {}) {
    scene.solver.backend = backend;
    scene.solver.handles = handles;
    ChainSystem system(scene, Axes::joint, communicator, 0, shares);
    system.evaluate();
    return solution_of(system);
}

bool same_bits(std::vector<double> const& a, std::vector<double> const& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

/// The first, the last or one in the middle has eight times as much as the others.
std::vector<dca::Shares> uneven_shares() {
    std::vector<dca::Shares> all;
    for (int const large : {0, world().size() / 2, world().size() - 1}) {
        dca::Shares shares(static_cast<std::size_t>(world().size()), 500);
        shares[static_cast<std::size_t>(large)] = 4000;
        all.push_back(shares);
    }
    return all;
}

void expect_same_bits(Scene const& scene, std::string const& what) {
    auto const alone = serial_communicator();
    for (Handles const handles : {Handles::projected, Handles::full})
        for (Backend const backend : {Backend::serial, Backend::segments}) {
            Solution const expected = solve(scene, backend, handles, *alone);
            for (dca::Shares const& shares : uneven_shares()) {
                Solution const found = solve(scene, backend, handles, world(), shares);
                if (world().rank() != 0) continue;
                std::string const name = what + ", " + name_of(backend) + ", " + name_of(handles);
                EXPECT_TRUE(same_bits(found.acceleration, expected.acceleration)) << name;
                EXPECT_TRUE(same_bits(found.joint_force, expected.joint_force)) << name;
            }
        }
}

TEST(UnequalShares, OneChain) {
    for (char const* const joint : {"link", "spherical", "revolute", "mixed"})
        for (int const bodies : {1, 2, 3, 257, 3000})
            expect_same_bits(scene_of(generated(joint, bodies, bodies % 2 == 1)),
                             std::string(joint) + " " + std::to_string(bodies));
}

TEST(UnequalShares, SeveralChainsOfDifferentKinds) {
    expect_same_bits(scene_of(generated("link", 70, true) + generated("revolute", 9, false) +
                              generated("link", 300, false) + generated("spherical", 130, true) +
                              generated("revolute", 1, true)),
                     "several chains");
}

TEST(UnequalShares, ManyShortChains) {
    std::string chains;
    for (int i = 0; i < 120; ++i)
        chains += generated(i % 3 == 0 ? "spherical" : "link", 3 + i % 9, i % 2 == 1);
    expect_same_bits(scene_of(chains), "short chains");
}

/// As if an evaluation of each body of the last rank took so many times what it takes elsewhere.
MeasureOwnCosts costs_of_slow_last(double slowness) {
    return [slowness](Scene const& scene, Axes, Communicator const& ranks, double) {
        double const cost = ranks.rank() == ranks.size() - 1 ? slowness : 1;
        std::int64_t const own = scene.bodies() / ranks.size();
        return std::vector<OwnCost>{{own, 1e-7 * cost * static_cast<double>(own)}};
    };
}

TEST(AgreedShares, ASlowRankGetsLess) {
    auto const ranks = static_cast<std::size_t>(world().size());
    Scene const scene = scene_of(generated("link", 3000, false));
    dca::Shares const shares =
        agree_on_shares(world(), costs_of_slow_last(4)(scene, Axes::world, world(), 0));
    ASSERT_EQ(shares.size(), ranks);
    if (ranks == 1) return;
    EXPECT_NEAR(static_cast<double>(shares.front()) / static_cast<double>(shares.back()), 4, 0.03);
    EXPECT_EQ(shares.front(), shares[ranks - 2]);
}

/// Costs are compared within a group: who has only chains that are dear for everybody is not slow.
TEST(AgreedShares, WhoHasOtherChainsIsNotSlower) {
    bool const last = world().rank() == world().size() - 1;
    std::vector<OwnCost> const costs = last ? std::vector<OwnCost>{{0, 1e-6}, {1000, 1}}
                                            : std::vector<OwnCost>{{1000, 1e-3}, {0, 1e-6}};
    EXPECT_EQ(agree_on_shares(world(), costs),
              dca::Shares(static_cast<std::size_t>(world().size()), dca::parts_of_equal_share));
}

TEST(MeasuredCosts, CountEveryBodyAndTakeTime) {
    Scene scene = scene_of(generated("link", 700, true) + generated("revolute", 300, false) +
                           generated("spherical", 130, true));
    for (double const implicit_step : {0.0, 0.1})
        for (Axes const axes : {Axes::joint, Axes::world}) {
            if (axes == Axes::world)
                std::erase_if(scene.chains, [](ChainSpec const& c) { return c.size() == 300; });
            std::vector<OwnCost> const costs =
                measure_own_costs(scene, axes, world(), axes == Axes::joint ? implicit_step : 0);
            std::int64_t bodies = 0;
            for (OwnCost const& cost : costs) {
                bodies += cost.bodies;
                if (cost.bodies > 0) {
                    EXPECT_GT(cost.seconds, 0);
                }
                EXPECT_LT(cost.seconds, 10);
            }
            EXPECT_EQ(world().sum(bodies), scene.bodies());
        }
}

/// The longest part is that of the rank the others wait for.
TEST(TimedMessages, WaitingForOthersIsNoWork) {
    if (world().size() == 1) return;
    TimedCommunicator const timed(world());
    timed.barrier();
    double const before = timed.seconds();
    if (timed.rank() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    timed.barrier();
    if (timed.rank() != 0) {
        EXPECT_GT(timed.seconds() - before, 0.1);
    }
    EXPECT_FALSE(timed.may_be_passed_by());
}

class BalancedRuns : public WholeRun {
  protected:
    nlohmann::json run_with(Communicator const& communicator, std::string const& name,
                            std::int64_t steps, MeasureOwnCosts const& costs,
                            std::string const& restart = "", bool balance = true) {
        RunOptions options = options_of(name, steps, restart);
        options.own_costs = costs;
        Scene scene = parse_scene(GetParam().text, "scene.yaml",
                                  {"solver.balance=" + std::string(balance ? "true" : "false")});
        scene.solver.backend = Backend::segments;
        nlohmann::json const summary = run_simulation(scene, communicator, options);
        EXPECT_TRUE(summary["valid"].get<bool>());
        if (communicator.rank() == 0) {
            EXPECT_EQ(summary.at("parallel").at("messages_a_step").at("ranks_that_differ"), 0);
        }
        return summary;
    }
    auto motion(std::string const& name) const {
        auto all = arrays(name);
        all.erase("rank_shares");
        return all;
    }
};

TEST_P(BalancedRuns, AreTheRunOnOneRankAndKeepTheirShares) {
    int measured = 0;
    MeasureOwnCosts const costs = [&](Scene const& scene, Axes axes, Communicator const& ranks,
                                      double step) {
        ++measured;
        return costs_of_slow_last(5)(scene, axes, ranks, step);
    };
    int const each = world().size() > 1 ? 1 : 0;
    run_with(world(), "all", 40, costs);
    EXPECT_EQ(measured, each);
    run_with(world(), "half", 20, costs);
    EXPECT_EQ(measured, 2 * each);
    auto const rest = run_with(world(), "rest", 40, costs, "half/checkpoint.h5");
    EXPECT_EQ(measured, 2 * each) << "shares are the checkpoint's";
    if (world().rank() == 0) {
        auto const one = serial_communicator();
        run_with(*one, "one", 40, costs);
        run_with(*one, "one-half", 20, costs);
        run_with(*one, "half-then-one", 40, costs, "half/checkpoint.h5");
        EXPECT_EQ(measured, 2 * each);
        for (char const* const name : {"all", "rest", "half-then-one"})
            EXPECT_EQ(motion(name), arrays("one")) << name;
        EXPECT_EQ(arrays("rest"), arrays("all"));
        auto const& parallel = rest.at("parallel");
        EXPECT_EQ(parallel.contains("shares"), world().size() > 1);
        if (world().size() > 1) {
            EXPECT_EQ(parallel.at("shares_from"), "checkpoint");
            EXPECT_NEAR(parallel.at("shares").front().get<double>() /
                            parallel.at("shares").back().get<double>(),
                        5, 0.1);
            EXPECT_EQ(parallel.at("bodies_of_rank").size(),
                      static_cast<std::size_t>(world().size()));
        }
    }
    world().barrier();
    run_with(world(), "one-then-all", 40, costs, "one-half/checkpoint.h5");
    EXPECT_EQ(measured, 3 * each) << "one rank has no shares";
    run_with(world(), "unbalanced", 40, costs, "half/checkpoint.h5", false);
    EXPECT_EQ(measured, 3 * each);
    if (world().rank() != 0) return;
    EXPECT_EQ(motion("one-then-all"), arrays("one"));
    EXPECT_EQ(arrays("unbalanced"), arrays("one"));
}

std::vector<RunScene> some_scenes() {
    std::vector<RunScene> some;
    for (RunScene const& scene : run_scenes)
        for (char const* const name :
             {"rattle_beads", "rattle_rings", "langevin_linked", "rk4_every_joint", "rk4_thermal",
              "staggered", "implicit_langevin_rods"})
            if (std::strcmp(scene.name, name) == 0) some.push_back(scene);
    return some;
}

RunScene const long_chain{
    "long_chain",
    "chains: [{velocities: thermal, generator: {freely_jointed: {beads: 6000, length: 0.38}}}]\n"
    "dynamics: {integrator: g-baoab, step: 0.002, steps: 5, friction: 1, seed: 5}\noutput: {every: "
    "5}\n"};

using BalancedLongRun = BalancedRuns;

TEST_P(BalancedLongRun, ASlowRankHasFewerBodies) {
    auto const summary = run_with(world(), "run", 5, costs_of_slow_last(4));
    if (world().rank() != 0 || world().size() == 1) return;
    auto const bodies =
        summary.at("parallel").at("bodies_of_rank").get<std::vector<std::int64_t>>();
    double const unit = 6000.0 / 47;  // of 128 bodies
    EXPECT_NEAR(static_cast<double>(bodies.back()), 6000 / (4.0 * (world().size() - 1) + 1), unit);
    EXPECT_EQ(summary.at("parallel").at("shares_from"), "measurement");
    auto const stored = arrays("run").at("rank_shares");
    EXPECT_EQ(std::ssize(stored), world().size());
}

/// Whatever a clock says.
using MeasuredRuns = BalancedRuns;
TEST_P(MeasuredRuns, AreTheRunOnOneRank) {
    run_with(world(), "measured", 5, measure_own_costs);
    if (world().rank() != 0) return;
    run_with(*serial_communicator(), "one", 5, measure_own_costs);
    EXPECT_EQ(motion("measured"), arrays("one"));
}

auto const name_of_scene = [](auto const& scene) { return scene.param.name; };
INSTANTIATE_TEST_SUITE_P(Integrators, BalancedRuns, ::testing::ValuesIn(some_scenes()),
                         name_of_scene);
INSTANTIATE_TEST_SUITE_P(Long, BalancedLongRun, ::testing::Values(long_chain), name_of_scene);
INSTANTIATE_TEST_SUITE_P(Long, MeasuredRuns, ::testing::Values(long_chain), name_of_scene);
INSTANTIATE_TEST_SUITE_P(Integrators, MeasuredRuns, ::testing::ValuesIn(some_scenes()),
                         name_of_scene);

}  // namespace
}  // namespace catena::test
