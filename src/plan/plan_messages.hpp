// What a step costs in messages: counts and sizes on these ranks, and with computing its time on as
// many as one likes.
#pragma once

#include "console/requests.hpp"
#include "integrate/chain_system.hpp"
#include "plan/predictions.hpp"

namespace catena::command {

/// Adds "messages" and, with --ranks, "network"; nothing for a scene without dynamics. The
/// predictions are rank 0's alone.
void add_messages(Text&, Json&, ChainSystem const&, PlanRequest const&, Predictions const&);

}  // namespace catena::command
