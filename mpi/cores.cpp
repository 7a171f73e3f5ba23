#include "mpi/cores.hpp"

#include <unistd.h>

#include <algorithm>

#include "mpi/communicator.hpp"

namespace catena {

CoreSet cores_bound_to() {  // std::thread::hardware_concurrency() knows them with some versions of glibc alone
    CoreSet set{};
    set.known = sched_getaffinity(0, sizeof(set.cores), &set.cores) == 0;
    if (!set.known) CPU_ZERO(&set.cores);
    return set;
}

int cores_of_rank(Communicator const& communicator) {
    CoreSet const bound = cores_bound_to();
    int const cores = bound.known ? CPU_COUNT(&bound.cores) : static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    return std::max(1, cores / communicator.ranks_on_cores());
}

}  // namespace catena
