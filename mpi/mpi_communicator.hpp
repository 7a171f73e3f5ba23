// The communicator over MPI; only builds with MPI have it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mpi/communicator.hpp"

namespace catena {

struct MpiOptions {
    std::int64_t largest_message =
        std::int64_t{1} << 30;  // in bytes: MPI counts in 32 bits, longer data go in pieces
    std::optional<GatherChoice> gather;  // none: rank 0's CATENA_GATHER
    std::vector<int>
        host_of_rank;  // ranks of one host that count as different ones; empty: as they are
};

/// All ranks of MPI_COMM_WORLD. Initialises MPI, and finalises it at its end, unless the caller has
/// done so already. Throws ComputationError when MPI fails, InputError when the launcher started
/// several processes that MPI does not connect.
std::unique_ptr<Communicator> mpi_communicator(int* argc, char*** argv, MpiOptions const& = {});

}  // namespace catena
