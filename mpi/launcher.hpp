// Detection of the launcher of this process from the environment. It works before MPI is
// initialised and in builds without MPI.
#pragma once

#include <string>

namespace catena {

/// Launcher's description of this process.
struct Launch {
    /// True if mpirun, mpiexec or srun with a process manager started this process.
    bool found = false;
    int rank = 0;          // rank by the launcher's numbering
    int size = 1;          // number of processes; at least 1
    std::string evidence;  // variable and value, such as "OMPI_COMM_WORLD_SIZE=4"
};

/// Reads the variables of Open MPI, PMI (MPICH, Intel MPI, Slurm), PMIx and MVAPICH.
Launch launch_environment();

}  // namespace catena
