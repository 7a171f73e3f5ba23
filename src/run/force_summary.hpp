// What a run's summary says of OpenMM: where it computed, how much ran beside it, and what ranks
// told each other for it.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "integrate/chain_system.hpp"

namespace catena {

/// The same on every rank; null without OpenMM. `steps`: of this run. Collective.
nlohmann::json summary_of_forces(ChainSystem const&, std::int64_t steps);

}  // namespace catena
