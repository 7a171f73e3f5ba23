// Detection of AVX2 and AVX-512 on x86 processors.
#include "math/simd_level.hpp"

namespace catena {

std::vector<SimdLevel> simd_levels() {
    std::vector<SimdLevel> levels{SimdLevel::off};
    if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return levels;
    levels.push_back(SimdLevel::avx2);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw") &&
        __builtin_cpu_supports("avx512cd"))
        levels.push_back(SimdLevel::avx512);
    return levels;
}

}  // namespace catena
