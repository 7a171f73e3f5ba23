#include "mpi/mpi_communicator.hpp"

namespace catena::testing {

std::unique_ptr<Communicator> splitting_communicator() { return mpi_communicator(nullptr, nullptr, 5); }

}  // namespace catena::testing
