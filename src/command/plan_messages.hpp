// What a step costs in messages: counts and sizes on these ranks, and time on as many as one likes.
#pragma once

#include "command/outcome.hpp"
#include "command/requests.hpp"
#include "command/text.hpp"
#include "integrate/chain_system.hpp"

namespace catena::command {

/// Adds "messages" and, with --ranks, "network"; nothing for a scene without dynamics.
void add_messages(Text&, Json&, ChainSystem const&, PlanRequest const&);

}  // namespace catena::command
