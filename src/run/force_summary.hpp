// Part of a run's summary about OpenMM: platform, overlap with the matrix sweep, and messages
// between ranks.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "integrate/chain_system.hpp"

namespace catena {

/// Returns the same object on every rank; null without OpenMM. `steps`: steps of this run.
/// Collective.
nlohmann::json summary_of_forces(ChainSystem const&, std::int64_t steps);

}  // namespace catena
