#include "mpi/communicator.hpp"

namespace catena::testing {

std::unique_ptr<Communicator> splitting_communicator() { return serial_communicator(); }

}  // namespace catena::testing
