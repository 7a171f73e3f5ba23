// Communicator over MPI, for builds with MPI.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mpi/communicator.hpp"

namespace catena {

/// Options of the MPI communicator.
struct MpiOptions {
    /// Largest number of bytes per MPI call. MPI counts in 32 bits; longer data are sent in pieces.
    std::int64_t largest_message = std::int64_t{1} << 30;
    std::optional<GatherChoice> gather;  // absent: rank 0's CATENA_GATHER decides
    /// Simulated host of each rank, which divides real hosts; empty: real hosts.
    std::vector<int> host_of_rank;
};

/// Returns the communicator of all ranks of MPI_COMM_WORLD. It initialises MPI, and finalises it in
/// its destructor, unless the caller has initialised it. Throws ComputationError if MPI fails.
/// Throws InputError if the launcher started several processes that MPI does not connect.
std::unique_ptr<Communicator> mpi_communicator(int* argc, char*** argv, MpiOptions const& = {});

}  // namespace catena
