// The communicator over MPI; only builds with MPI have it.
#pragma once

#include <cstdint>
#include <memory>

#include "mpi/communicator.hpp"

namespace catena {

/// All ranks of MPI_COMM_WORLD. Initialises MPI, and finalises it at its end, unless the caller has done so already.
/// No message is longer than `largest_message` bytes: MPI counts in 32 bits, longer data go in pieces.
/// Throws ComputationError when MPI fails, InputError when the launcher started several processes that MPI does not connect.
std::unique_ptr<Communicator> mpi_communicator(int* argc, char*** argv, std::int64_t largest_message = std::int64_t{1} << 30);

}  // namespace catena
