#include "tests/bench/precision/sweeps.hpp"

namespace catena::precision {

KernelTable scalar_kernels() { return kernel_table<double, float, double>(); }

}  // namespace catena::precision
