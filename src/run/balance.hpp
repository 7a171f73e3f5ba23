// Which share of the bodies each rank gets where ranks differ: what they cost is measured before a
// run.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "chain/chain_group.hpp"

namespace catena {

/// Of one group of chains, cut equally: this rank's bodies, and the seconds that an evaluation of
/// them takes by this rank's own work.
struct OwnCost {
    std::int64_t bodies = 0;
    double seconds = 0;
};

/// Group after group, medians of several evaluations of the scene's start. Messages, the time they
/// are waited for included, do not count, nor do OpenMM's forces. `implicit_step`: ChainSystem's.
/// Collective.
std::vector<OwnCost> measure_own_costs(Scene const&, Axes, Communicator const&,
                                       double implicit_step);
using MeasureOwnCosts = std::function<std::vector<OwnCost>(Scene const&, Axes, Communicator const&,
                                                           double implicit_step)>;

/// In proportion to speeds, a rank's own being what its bodies would take at the ranks' mean costs
/// over what they take, as if costs were proportional to bodies: what every rank does alike, the
/// top of a long chain's tree, makes shares more equal. The same on every rank. Precondition: as
/// many groups on every rank. Collective.
dca::Shares agree_on_shares(Communicator const&, std::vector<OwnCost> const& of_groups);

}  // namespace catena
