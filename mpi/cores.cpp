// Number of cores for a rank, and the limit on threads.
#include "mpi/cores.hpp"

#include <unistd.h>

#include <algorithm>

#include "error.hpp"
#include "mpi/communicator.hpp"
#include "mpi/thread_limit.hpp"

namespace catena {

// std::thread::hardware_concurrency() respects the binding only with some versions of glibc.
CoreSet cores_bound_to() {
    CoreSet set{};
    set.known = sched_getaffinity(0, sizeof(set.cores), &set.cores) == 0;
    if (!set.known) CPU_ZERO(&set.cores);
    return set;
}

int cores_of_rank(Communicator const& communicator) {
    CoreSet const bound = cores_bound_to();
    int const cores =
        bound.known ? CPU_COUNT(&bound.cores) : static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
    return std::max(1, cores / communicator.ranks_on_cores());
}

void require_possible_threads(int threads, std::string const& where) {
    // `always` threads are allowed in any case, `a_processor` threads per processor.
    constexpr long always = 64, a_processor = 16;
    long const processors = std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)),
               most = std::max(always, a_processor * processors);
    if (threads <= most) return;
    throw InputError(
        std::to_string(threads) + " threads on " + std::to_string(processors) + " processors",
        where, "use at most the number of processors, or 0");
}

}  // namespace catena
