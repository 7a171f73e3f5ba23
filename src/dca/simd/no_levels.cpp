// Replacements for the sources of AVX2 and AVX-512 in builds without them: no SIMD level is
// available.
#include "dca/simd/runs.hpp"

namespace catena {

std::vector<SimdLevel> simd_levels() { return {SimdLevel::off}; }

namespace dca {

template <class Leaf>
RunKernels<Leaf> avx2_kernels() {
    return {};
}
template <class Leaf>
RunKernels<Leaf> avx512_kernels() {
    return {};
}

#define CATENA_INSTANTIATE(...)                      \
    template RunKernels<__VA_ARGS__> avx2_kernels(); \
    template RunKernels<__VA_ARGS__> avx512_kernels();
CATENA_LEAVES_IN_LANES(CATENA_INSTANTIATE)

}  // namespace dca
}  // namespace catena
