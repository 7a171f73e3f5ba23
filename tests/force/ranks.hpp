// Several ranks for a test: threads that play them, or the ranks of mpirun.
#pragma once

#include <functional>

#include "mpi/communicator.hpp"

namespace catena::testing {

/// Runs `body` once a rank, all at the same time: with threads on 1, 2, 3, 4 and 6 ranks in turn,
/// under mpirun on as many as there are. GoogleTest's EXPECT_ only: a rank that leaves early would
/// leave the others waiting.
void on_ranks(std::function<void(Communicator const&)> const& body);

}  // namespace catena::testing
