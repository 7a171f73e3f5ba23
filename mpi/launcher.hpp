// What started this process, told by the environment alone: known before MPI is initialised, and in
// builds without it.
#pragma once

#include <string>

namespace catena {

struct Launch {
    bool found = false;    // mpirun, mpiexec or srun with a process manager started this process
    int rank = 0;          // as the launcher numbers it
    int size = 1;          // number of processes, 1 where the launcher does not say
    std::string evidence;  // "OMPI_COMM_WORLD_SIZE=4"
};

/// Reads the variables of Open MPI, PMI (MPICH, Intel MPI, Slurm), PMIx and MVAPICH.
Launch launch_environment();

}  // namespace catena
