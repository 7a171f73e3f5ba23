// The ranks that a test of catena_mpi_test runs on. Every rank runs every case, so a case may call
// collectives.
#pragma once

#include "mpi/communicator.hpp"

namespace catena::testing {

Communicator const& world();

}  // namespace catena::testing
