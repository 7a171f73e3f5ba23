// What ranks tell each other about a run beside its steps: the checkpoint at its start, their
// timelines at its end.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "integrate/timeline.hpp"
#include "io/output.hpp"
#include "mpi/communicator.hpp"

namespace catena {

/// Arrays of more numbers are of bodies: each rank gets its own later (ChainSystem::set_state).
/// What a run keeps beside them is shorter: at most a number a rank.
inline constexpr std::size_t largest_shared_array = 1 << 16;
/// Rank 0's checkpoint to every rank, but its notes and those arrays. Collective.
void share(Communicator const&, Checkpoint&);

/// {"ranks": [{"rank", "steps": [{"step", "phases": [...]}]}]} on rank 0. Collective.
nlohmann::json gather_timelines(Communicator const&, std::vector<StepTimeline> const&);

}  // namespace catena
