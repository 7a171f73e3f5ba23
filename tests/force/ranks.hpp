// Several ranks for a test: threads that play them, or the ranks of mpirun.
#pragma once

#include <functional>

#include "mpi/communicator.hpp"

namespace catena::testing {

/// Whether `on_ranks` can have so many.
bool has_ranks(int ranks);

/// Runs `body` once a rank, all at the same time (GoogleTest's EXPECT_ only: a rank that leaves early would leave the others waiting).
void on_ranks(int ranks, std::function<void(Communicator const&)> const& body);

}  // namespace catena::testing
