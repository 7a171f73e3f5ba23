// Kernels for AVX-512 of leaves with up to four directions, compiled with that instruction set
// (runs.hpp).
#include "dca/simd/avx512.hpp"

#include "dca/simd/kernels.hpp"

namespace catena::dca {

template <class Leaf>
RunKernels<Leaf> avx512_kernels() {
    return kernels<avx512::Real, Leaf>();
}

#define CATENA_INSTANTIATE(...) template RunKernels<__VA_ARGS__> avx512_kernels();
CATENA_LEAVES_OF_FEW_DIRECTIONS(CATENA_INSTANTIATE)

}  // namespace catena::dca
