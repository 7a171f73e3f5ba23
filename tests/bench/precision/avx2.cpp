#include "tests/bench/precision/avx2.hpp"

#include "tests/bench/precision/sweeps.hpp"

namespace catena::precision {

KernelTable avx2_kernels() {
    return kernel_table<dca::avx2::Real, dca::avx2::Single, Twice<dca::avx2::Real>>();
}

}  // namespace catena::precision
