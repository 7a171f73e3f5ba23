// Quotients and roots without branches, so that what is independent of them goes on meanwhile. They
// have the bits of those that are rounded once: steps and ranges are the ones that nvcc takes
// itself before it looks for the rest. Beyond these ranges they say so, or answer NaN.
#pragma once

#include <limits>

#include "dca/bead_leaf.hpp"

namespace catena::cuda::kernels {

__device__ inline double not_known() { return __builtin_nan(""); }

#if defined(__CUDACC__)
/// A double's upper half: its sign, eleven bits of its exponent, and the leading ones of its
/// mantissa.
namespace upper {
constexpr unsigned no_sign = 0x7fffffff, exponent_step = 0x00100000, infinite = 0x7ff00000;
__device__ inline unsigned of(double x) { return static_cast<unsigned>(__double2hiint(x)); }
}  // namespace upper
/// A first guess has twenty good bits in its upper half; nvcc puts something there for the lower
/// one that tells of the range as well.
__device__ inline double first_guess(double coarse, unsigned lower) {
    return __hiloint2double(__double2hiint(coarse), static_cast<int>(lower));
}
#endif

/// 1 / x, or anything where it does not `know`.
struct BranchlessInverse {
    bool& known;
    __device__ double operator()(double x) const {
#if defined(__CUDACC__)
        constexpr unsigned shift =
            0x00300402;  // the sign's bit and those below it tell where the exponent is too large
        unsigned const lower = upper::of(x) + shift;
        double y;
        asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
        y = first_guess(y, lower);
        double e = __fma_rn(-x, y, 1.0);
        e = __fma_rn(e, e, e);
        y = __fma_rn(y, e, y);
        e = __fma_rn(-x, y, 1.0);
        y = __fma_rn(y, e, y);
        known = known & ((lower & upper::no_sign) >= shift + upper::exponent_step);
        return y;
#else
        double const size = x < 0 ? -x : x;
        known = known && size >= std::numeric_limits<double>::min() && size < 0x1p1022;
        return known ? 1 / x : not_known();
#endif
    }
};

struct BranchlessInverseLength {
    static constexpr bool may_fail = true;
    __device__ double operator()(Vec3 const& d) const {
#if defined(__CUDACC__)
        constexpr unsigned least = 0x03500000;  // 2^-970
        double const x = dot(d, d);
        unsigned const lower = upper::of(x) - least;
        double y;
        asm("rsqrt.approx.ftz.f64 %0, %1;" : "=d"(y) : "d"(x));
        y = first_guess(y, lower);
        double const e = __fma_rn(x, -__dmul_rn(y, y), 1.0);
        y = __fma_rn(__fma_rn(e, 0.375, 0.5), __dmul_rn(y, e), y);
        double const root = __dmul_rn(x, y);
        double const half = __hiloint2double(static_cast<int>(upper::of(y) - upper::exponent_step),
                                             __double2loint(y));  // of y
        double const length = __fma_rn(__fma_rn(root, -root, x), half, root);
        bool known = lower < upper::infinite - least;
        double const found = BranchlessInverse{known}(length);  // in any case: no branch
        return known ? found : not_known();
#else
        double const x = dot(d, d);
        bool known = x >= 0x1p-960 && x < 0x1p1023;
        return BranchlessInverse{known}(norm(d));
#endif
    }
};

/// As factorize() of one direction, where it is not restricted or its pivot is positive and the
/// inverse is known quickly; else anything, and it is not `sure`.
struct UncheckedFactorizer {
    static constexpr bool may_fail = true;
    bool& sure;
    __device__ Symmetric<double, 1> operator()(Symmetric<double, 1> const& z,
                                               int restricted) const {
        bool known = true;
        double const inverse = BranchlessInverse{known}(z(0, 0));
        sure = sure && (restricted <= 0 || (known && z(0, 0) > 0));
        Symmetric<double, 1> factor;
        factor(0, 0) = restricted > 0 ? inverse : 0;
        return factor;
    }
};

/// As factorize(), quick where all directions are restricted. `gives_up`: NaN where that does not
/// do, else it looks again.
template <bool gives_up>
struct BranchlessFactorizer {
    static constexpr bool may_fail = gives_up;
    template <int K>
    __device__ Symmetric<double, K> operator()(Symmetric<double, K> const& z,
                                               int restricted) const {
        bool known = gives_up || restricted == K;
        auto quick = dca::factorize(z, K, BranchlessInverse{known});
        if constexpr (gives_up) {
            static_assert(K == 1);
            quick(0, 0) = restricted <= 0 ? 0 : known ? quick(0, 0) : not_known();
            return quick;
        } else {
            return known ? quick : dca::factorize(z, restricted);
        }
    }
    template <class Result>
    __device__ auto with_inverse(Result const& result) const {
        bool known = true;
        auto const quick = result(BranchlessInverse{known});
        return known ? quick : result(dca::Quotient{});
    }
};

}  // namespace catena::cuda::kernels
