#include "dca/host_space.hpp"
#define CATENA_WHOLE_SWEEPS CATENA_WHOLE
#include "tests/bench/precision/sweeps.hpp"

namespace catena::precision {

KernelTable scalar_kernels() { return kernel_table<double, float, double>(); }

}  // namespace catena::precision
