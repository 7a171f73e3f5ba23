// The network that `catena plan --ranks` predicts with.
#pragma once

#include "console/requests.hpp"
#include "mpi/network.hpp"

namespace catena::command {

/// What --network FILE holds, with --latency and --bandwidth in the place of its link between
/// hosts. Without a file they are every link's, and gathers take what the model says. InputError
/// where --ranks or --hosts need a link that is not there, and for values that no link has.
Network network_of(PlanRequest const&);

}  // namespace catena::command
