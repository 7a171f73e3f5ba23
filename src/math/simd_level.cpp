// Names and widths of the SIMD levels, and the choice of the best one.
#include "math/simd_level.hpp"

#include "math/host_device.hpp"

namespace catena {

char const* name_of(SimdLevel level) {
    switch (level) {
        case SimdLevel::avx512:
            return "avx512";
        case SimdLevel::avx2:
            return "avx2";
        default:
            return "off";
    }
}

int lanes_of(SimdLevel level) {
    switch (level) {
        case SimdLevel::avx512:
            return 8;
        case SimdLevel::avx2:
            return 4;
        default:
            return 1;
    }
}

bool rounds_as_vectors() { return fused(1 + 0x1p-30, 1 + 0x1p-30, -1 - 0x1p-29) != 0; }

SimdLevel best_simd_level() {
    static SimdLevel const best = simd_levels().back();
    return best;
}

}  // namespace catena
