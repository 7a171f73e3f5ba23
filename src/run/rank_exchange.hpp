// Exchange between ranks outside the time steps: the checkpoint at the start of a run and the
// timelines at its end.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "integrate/timeline.hpp"
#include "io/output.hpp"
#include "mpi/communicator.hpp"

namespace catena {

/// Largest array that share() sends, in numbers. Larger arrays belong to bodies, and each rank
/// receives its own part later (ChainSystem::set_state). Other arrays of a run have at most one
/// number per rank.
inline constexpr std::size_t largest_shared_array = 1 << 16;
/// Sends rank 0's checkpoint to every rank, except its notes and large arrays. Collective.
void share(Communicator const&, Checkpoint&);

/// Returns {"ranks": [{"rank", "steps": [{"step", "phases": [...]}]}]} on rank 0. Collective.
nlohmann::json gather_timelines(Communicator const&, std::vector<StepTimeline> const&);

}  // namespace catena
