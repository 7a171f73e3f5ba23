// Implements the measurement of costs and the shares derived from them.
#include "run/balance.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "clock.hpp"
#include "integrate/chain_system.hpp"
#include "mpi/collectives.hpp"
#include "mpi/timed_communicator.hpp"

namespace catena {
namespace {

/// Numbers of evaluations, and seconds after which no further one begins.
constexpr int least_evaluations = 5, most_evaluations = 101;
constexpr double enough_seconds = 0.3;

double median(std::vector<double> values) {
    auto const middle = values.begin() + std::ssize(values) / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Evaluates a group in absolute coordinates, including the bias sweep of a projection. Forces of
/// implicit joints are not included, since they exist only within a step.
void evaluate(AbsoluteDynamics& group) {
    group.update_configuration();
    group.assemble_matrices();
    group.set_simple_forces();
    group.observe(0.0);
    group.solver().wait();
}

/// Evaluates a group in joint coordinates. `once`: fused matrix and bias sweep.
void evaluate(JointDynamics& group, bool once) {
    if (once) {
        group.update_to_solve_once();
        group.solve_once();
    } else {
        group.update_configuration();
        group.assemble_matrices();
        group.solve();
    }
    group.solver().wait();
}

/// Seconds of this rank's own work. All ranks begin together, because they share the memory of
/// their hosts in a run.
template <class Action>
double own_seconds(TimedCommunicator const& communicator, Action const& action) {
    communicator.barrier();
    double const messages = communicator.seconds(), start = seconds_now();
    action();
    return seconds_now() - start - (communicator.seconds() - messages);
}

}  // namespace

std::vector<OwnCost> measure_own_costs(Scene const& scene, Axes axes,
                                       Communicator const& communicator, double implicit_step) {
    std::optional<Scene> chains_alone;
    if (scene.forces.openmm) {
        chains_alone = scene;
        chains_alone->forces.openmm.reset();
    }
    TimedCommunicator const timed(communicator);
    ChainSystem system(chains_alone ? *chains_alone : scene, axes, timed, implicit_step);
    for (AbsoluteDynamics* group : system.absolute())
        evaluate(*group);  // the first evaluation takes longer
    for (JointDynamics* group : system.joint()) evaluate(*group, system.solves_once());
    std::vector<std::vector<double>> seconds(system.groups().size());
    double const start = seconds_now();
    for (int i = 0; i < most_evaluations; ++i) {
        bool const enough = i >= least_evaluations && seconds_now() - start > enough_seconds;
        if (timed.max(enough ? 1 : 0) > 0) break;
        std::size_t g = 0;
        for (AbsoluteDynamics* group : system.absolute())
            seconds[g++].push_back(own_seconds(timed, [&] { evaluate(*group); }));
        for (JointDynamics* group : system.joint())
            seconds[g++].push_back(
                own_seconds(timed, [&] { evaluate(*group, system.solves_once()); }));
    }
    std::vector<OwnCost> costs;
    for (AbsoluteDynamics const* group : system.absolute())
        costs.push_back({group->group().size, median(seconds[costs.size()])});
    for (JointDynamics const* group : system.joint())
        costs.push_back({group->group().size, median(seconds[costs.size()])});
    return costs;
}

dca::Shares agree_on_shares(Communicator const& communicator,
                            std::vector<OwnCost> const& of_groups) {
    auto const ranks = static_cast<std::size_t>(communicator.size());
    std::size_t const groups = of_groups.size();
    std::vector<OwnCost> const all = all_gathered_alike(communicator, of_groups);
    std::vector<double> taken(ranks, 0), expected(ranks, 0), speeds;
    for (std::size_t g = 0; g < groups; ++g) {
        double bodies = 0, seconds = 0;
        for (std::size_t r = 0; r < ranks; ++r) {
            OwnCost const& cost = all[r * groups + g];
            if (cost.bodies == 0) continue;  // cost of no body
            bodies += static_cast<double>(cost.bodies);
            seconds += cost.seconds;
            taken[r] += cost.seconds;
        }
        for (std::size_t r = 0; r < ranks && bodies > 0; ++r)
            expected[r] += seconds / bodies * static_cast<double>(all[r * groups + g].bodies);
    }
    for (std::size_t r = 0; r < ranks; ++r)
        speeds.push_back(taken[r] > 0 ? expected[r] / taken[r] : 0);
    return dca::shares_of_speeds(speeds);
}

RankShares rank_shares(Communicator const& communicator, std::vector<double> const& stored,
                       std::function<std::vector<OwnCost>()> const& measure) {
    auto const is_share = [](double share) { return share >= 1 && share <= 1e6; };
    if (std::ssize(stored) == communicator.size() &&
        std::all_of(stored.begin(), stored.end(), is_share))
        return {{stored.begin(), stored.end()}, true};
    return {agree_on_shares(communicator, measure()), false};
}

nlohmann::json json_of(RankShares const& ranks,
                       std::vector<std::unique_ptr<ChainGroup>> const& groups) {
    double sum = 0;
    for (std::int64_t const share : ranks.shares) sum += static_cast<double>(share);
    nlohmann::json shares = nlohmann::json::array(), bodies = nlohmann::json::array();
    for (std::size_t r = 0; r < ranks.shares.size(); ++r) {
        std::int64_t own = 0;
        for (auto const& group : groups)
            own += group->first_of_rank()[r + 1] - group->first_of_rank()[r];
        shares.push_back(static_cast<double>(ranks.shares[r]) / sum);
        bodies.push_back(own);
    }
    return {{"shares", shares},
            {"shares_from", ranks.are_stored ? "checkpoint" : "measurement"},
            {"bodies_of_rank", bodies}};
}

}  // namespace catena
