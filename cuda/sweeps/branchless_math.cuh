// Quotients and roots without branches, so that independent instructions overlap with them. Their
// results are bitwise those of correctly rounded operations. The iteration steps and argument
// ranges are those of nvcc's own fast path. Outside these ranges the functions report failure or
// return NaN.
#pragma once

#include <limits>

#include "dca/bead_leaf.hpp"

namespace catena::cuda::kernels {

/// Result of an operation whose argument is out of range.
__device__ inline double not_known() { return __builtin_nan(""); }

#if defined(__CUDACC__)
/// Upper half of a double: sign, eleven bits of exponent, and the leading bits of the mantissa.
namespace upper {
constexpr unsigned no_sign = 0x7fffffff, exponent_step = 0x00100000, infinite = 0x7ff00000;
__device__ inline unsigned of(double x) { return static_cast<unsigned>(__double2hiint(x)); }
}  // namespace upper
/// Combines the hardware's approximation, which has twenty correct bits in its upper half, with a
/// lower half. nvcc uses a lower half that depends on the range of the argument, and this function
/// receives the same.
__device__ inline double first_guess(double coarse, unsigned lower) {
    return __hiloint2double(__double2hiint(coarse), static_cast<int>(lower));
}
#endif

/// Computes 1 / x. If `known` becomes false, the result is arbitrary.
struct BranchlessInverse {
    bool& known;
    __device__ double operator()(double x) const {
#if defined(__CUDACC__)
        // The sign bit and the bits below it tell if the exponent is too large.
        constexpr unsigned shift = 0x00300402;
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

/// Computes 1 / |d|, or NaN if the square of the length is out of range.
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
        // This is half of y.
        double const half = __hiloint2double(static_cast<int>(upper::of(y) - upper::exponent_step),
                                             __double2loint(y));
        double const length = __fma_rn(__fma_rn(root, -root, x), half, root);
        bool known = lower < upper::infinite - least;
        // The inverse is computed in any case, to avoid a branch.
        double const found = BranchlessInverse{known}(length);
        return known ? found : not_known();
#else
        double const x = dot(d, d);
        bool known = x >= 0x1p-960 && x < 0x1p1023;
        return BranchlessInverse{known}(norm(d));
#endif
    }
};

/// Factorizes a matrix of one direction as factorize() does, without branches. The result is right
/// if the direction is unrestricted, or if the pivot is positive and its inverse is known.
/// Otherwise it is arbitrary and `sure` becomes false.
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

/// Factorizes as factorize() does, without branches if all directions are restricted. `gives_up`:
/// returns NaN if the fast inverse fails; otherwise it repeats the factorization exactly.
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
    /// Returns result(inverse) with the fast inverse, or with the exact quotient if that fails.
    template <class Result>
    __device__ auto with_inverse(Result const& result) const {
        bool known = true;
        auto const quick = result(BranchlessInverse{known});
        return known ? quick : result(dca::Quotient{});
    }
};

}  // namespace catena::cuda::kernels
