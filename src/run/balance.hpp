// Load balance between ranks of different speed: the cost of bodies is measured before a run and
// determines the rank's share.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "chain/chain_group.hpp"

namespace catena {

/// Cost of one group of chains, distributed equally: number of this rank's bodies, and the seconds
/// of this rank's own work per evaluation.
struct OwnCost {
    std::int64_t bodies = 0;
    double seconds = 0;
};

/// Measures the costs of all groups as medians over several evaluations of the scene's start.
/// Messages, including the wait for them, and OpenMM's forces do not count. `implicit_step`:
/// argument of ChainSystem's constructor. Collective.
std::vector<OwnCost> measure_own_costs(Scene const&, Axes, Communicator const&,
                                       double implicit_step);
using MeasureOwnCosts = std::function<std::vector<OwnCost>(Scene const&, Axes, Communicator const&,
                                                           double implicit_step)>;

/// Computes shares in proportion to the ranks' speeds. A rank's speed is the time that its bodies
/// would take at the mean cost of all ranks, divided by the measured time. Costs are assumed to be
/// proportional to bodies. Work that every rank does alike (the top of a long chain's tree)
/// therefore makes the shares more equal. The result is the same on every rank. Precondition: equal
/// number of groups on every rank. Collective.
dca::Shares agree_on_shares(Communicator const&, std::vector<OwnCost> const& of_groups);

/// Shares of the bodies that the ranks of a run have.
struct RankShares {
    dca::Shares shares;       // empty: equal shares
    bool are_stored = false;  // taken from a checkpoint, not from a measurement
};
/// Returns the stored shares if they fit the ranks, else those of agree_on_shares() for the costs
/// that `measure` returns. A restart must equal the uninterrupted run, also with OpenMM.
/// Collective.
RankShares rank_shares(Communicator const&, std::vector<double> const& stored,
                       std::function<std::vector<OwnCost>()> const& measure);
/// Returns {"shares", "shares_from", "bodies_of_rank"} for summary.json.
nlohmann::json json_of(RankShares const&, std::vector<std::unique_ptr<ChainGroup>> const&);

}  // namespace catena
