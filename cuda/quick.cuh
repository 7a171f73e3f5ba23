// Quotients and roots without branches, so that what is independent of them goes on meanwhile. They have the bits of those that are rounded
// once: steps and ranges are the ones that nvcc takes itself before it looks for the rest. Beyond these ranges they answer NaN.
#pragma once

#include <limits>

#include "dca/moving_beads.hpp"

namespace catena::cuda::kernels {

struct QuickInverse {
    __device__ double operator()(double x) const {
#if defined(__CUDACC__)
        int const high = __double2hiint(x), seed = high + 0x300402;
        double y;
        asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
        y = __hiloint2double(__double2hiint(y), seed);
        double e = __fma_rn(-x, y, 1.0);
        e = __fma_rn(e, e, e);
        y = __fma_rn(y, e, y);
        e = __fma_rn(-x, y, 1.0);
        y = __fma_rn(y, e, y);
        return (seed & 0x7fffffff) >= 0x400402 ? y : __hiloint2double(0x7ff80000, 0);
#else
        double const size = x < 0 ? -x : x;
        return size >= std::numeric_limits<double>::min() && size < 0x1p1022 ? 1 / x : std::numeric_limits<double>::quiet_NaN();
#endif
    }
};

struct QuickInverseLength {
    static constexpr bool may_fail = true;
    __device__ double operator()(Vec3 const& d) const {
#if defined(__CUDACC__)
        double const x = dot(d, d);
        int const seed = __double2hiint(x) - 0x03500000;
        double y;
        asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
        y = __hiloint2double(__double2hiint(y), seed);
        double const e = __fma_rn(x, -__dmul_rn(y, y), 1.0);
        y = __fma_rn(__fma_rn(e, 0.375, 0.5), __dmul_rn(y, e), y);
        double const root = __dmul_rn(x, y), half = __hiloint2double(__double2hiint(y) - 0x00100000, __double2loint(y));
        double const length = __fma_rn(__fma_rn(root, -root, x), half, root);
        double const found = QuickInverse{}(length);  // in any case: no branch
        return static_cast<unsigned>(seed) < 0x7ca00000u ? found : __hiloint2double(0x7ff80000, 0);
#else
        double const x = dot(d, d);
        return x >= 0x1p-960 && x < 0x1p1023 ? QuickInverse{}(norm(d)) : std::numeric_limits<double>::quiet_NaN();
#endif
    }
};

/// As factorize(), quick where all directions are restricted. `gives_up`: NaN where that does not do, else it looks again.
template <bool gives_up>
struct QuickFactors {
    static constexpr bool may_fail = gives_up;
    template <int K>
    __device__ Symmetric<double, K> operator()(Symmetric<double, K> const& z, int restricted) const {
        auto quick = dca::factorize(z, K, QuickInverse{});
        if constexpr (gives_up) {
            static_assert(K == 1);
            quick(0, 0) = restricted > 0 ? quick(0, 0) : 0;
            return quick;
        } else {
            double sum = 0;
        CATENA_UNROLL
            for (int i = 0; i < K; ++i) sum = sum + quick(i, i);
            return restricted == K && sum == sum ? quick : dca::factorize(z, restricted);
        }
    }
};

}  // namespace catena::cuda::kernels
