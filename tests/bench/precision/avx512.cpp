#include "tests/bench/precision/avx512.hpp"

#include "tests/bench/precision/sweeps.hpp"

namespace catena::precision {

KernelTable avx512_kernels() {
    return kernel_table<dca::avx512::Real, dca::avx512::Single, Twice<dca::avx512::Real>>();
}

}  // namespace catena::precision
