// Kernels for AVX2 of leaves with up to four directions, compiled with that instruction set
// (runs.hpp).
#include "dca/simd/avx2.hpp"

#include "dca/simd/kernels.hpp"

namespace catena::dca {

template <class Leaf>
RunKernels<Leaf> avx2_kernels() {
    return kernels<avx2::Real, Leaf>();
}

#define CATENA_INSTANTIATE(...) template RunKernels<__VA_ARGS__> avx2_kernels();
CATENA_LEAVES_OF_FEW_DIRECTIONS(CATENA_INSTANTIATE)

}  // namespace catena::dca
