// Reports the messages of a step: numbers and sizes on the ranks at hand, and predicted times of
// steps on any number of ranks.
#pragma once

#include "console/requests.hpp"
#include "integrate/chain_system.hpp"
#include "plan/predictions.hpp"

namespace catena::command {

/// Adds "messages" and, with --ranks, "network" to the text and JSON. Adds nothing for a scene
/// without dynamics; throws InputError for such a scene with --ranks. `predictions` are used on
/// rank 0 alone. Collective.
void add_messages(Text&, Json&, ChainSystem const&, PlanRequest const&, Predictions const&);

}  // namespace catena::command
