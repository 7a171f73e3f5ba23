// Reads the network model that `catena plan --ranks` predicts with.
#pragma once

#include "console/requests.hpp"
#include "mpi/network.hpp"

namespace catena::command {

/// Returns the network of --network FILE; --latency and --bandwidth replace its link between hosts.
/// Without a file these values hold for every link and for gathers. Throws InputError if a link is
/// missing that --ranks or --hosts need, and for impossible values.
Network network_of(PlanRequest const&);

}  // namespace catena::command
