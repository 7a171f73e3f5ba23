// Replacement of mpi_communicator.cpp in builds without MPI.
#include "error.hpp"
#include "mpi/communicator.hpp"
#include "mpi/launcher.hpp"

namespace catena {

std::unique_ptr<Communicator> world_communicator(int*, char***) {
    Launch const launch = launch_environment();
    if (launch.size > 1)
        throw built_without("MPI", "started with " + launch.evidence,
                            "start it without mpirun, or build with -DCATENA_WITH_MPI=ON (Debian: "
                            "libopenmpi-dev openmpi-bin)");
    return serial_communicator();
}

std::string message_passing_library() { return "none"; }

}  // namespace catena
