// Elementary functions for host and device. Library functions round differently on hosts and
// devices; these give the same bits everywhere.
#pragma once

#include <cmath>

#include "math/host_device.hpp"

namespace catena {

/// Cosine and sine of one angle.
template <class Real>
struct BasicCosSin {
    Real cos, sin;
};
using CosSin = BasicCosSin<double>;

/// Returns cosine and sine of an angle from those of the angle less `quarters` times pi/2.
CATENA_HD CosSin turned_back(int quarters, double c, double s) {
    bool const odd = (quarters & 1) != 0;
    double const along = odd ? s : c, across = odd ? c : s;
    return {((quarters + 1) & 2) != 0 ? -along : along, (quarters & 2) != 0 ? -across : across};
}

/// Returns the natural logarithm of u in (0, 1]. The function sums twice the series of atanh for u
/// scaled to [sqrt(1/2), sqrt(2)).
CATENA_HD double log_of_uniform(double u) {
    auto const bits = __builtin_bit_cast(std::uint64_t, u);
    int exponent = static_cast<int>(bits >> 52) - 1022;
    double m = __builtin_bit_cast(
        double, (bits & 0x000fffffffffffffULL) | 0x3fe0000000000000ULL);  // mantissa, in [1/2, 1)
    bool const small = m < 0.70710678118654752;
    m = small ? 2 * m : m;
    exponent = small ? exponent - 1 : exponent;
    double const s = (m - 1) / (m + 1), z = s * s;
    double series = 1.0 / 21;
    CATENA_UNROLL
    for (int odd = 19; odd > 0; odd -= 2) series = fused(series, z, 1.0 / odd);
    double const e = exponent, ln2_high = 0x1.62e42fefa39efp-1, ln2_low = 0x1.abc9e3b39803fp-56;
    return fused(e, ln2_high, fused(e, ln2_low, 2 * s * series));
}

/// Returns cosine and sine of 2 pi u, for u in [0, 1]. The function sums the Taylor series within
/// pi/4 of the nearest multiple of pi/2.
CATENA_HD CosSin cos_sin_of_turns(double u) {
    double const quarter = std::floor(4 * u + 0.5), x = (4 * u - quarter) * 1.57079632679489662,
                 z = -x * x;
    double c = 1, s = 1;
    CATENA_UNROLL
    for (int k = 18; k > 0; k -= 2) {
        c = fused(c * z, 1.0 / ((k - 1) * k), 1.0);
        s = fused(s * z, 1.0 / (k * (k + 1)), 1.0);
    }
    s *= x;
    return turned_back(static_cast<int>(quarter), c, s);
}

/// Returns cosine and sine of the angle x, in radians. The error is at most 0.8 units in the last
/// place for |x| up to 1e5, and 1e-15 beyond. The Taylor series is summed for the remainder of x by
/// the nearest multiple of pi/2. That multiple is subtracted in three parts; the products with the
/// first two are exact. The rounding error of the remainder is carried along.
CATENA_HD CosSin cos_sin(double x) {
    if (std::fabs(x) > 1e5) {
        double const turn = 0x1.921fb54442d18p+2, turn_low = 0x1.1a62633145c07p-52,
                     left = std::fmod(x, turn);
        x = fused(-std::floor((x - left) / turn + 0.5), turn_low, left);
    }
    double const quarters = std::floor(fused(x, 0.63661977236758134, 0.5)),
                 second = quarters * 0x1.0b4611a600000p-34;
    double const once = fused(-quarters, 0x1.921fb54400000p+0, x), twice = once - second;
    double const low = fused(-quarters, 0x1.3198a2e037073p-69, (once - twice) - second);
    double const r = twice + low, rest = (twice - r) + low, z = r * r;
    double s = 1 / 355687428096000.0, c = 1 / 20922789888000.0;
    s = fused(s, z, -1 / 1307674368000.0);
    c = fused(c, z, -1 / 87178291200.0);
    s = fused(s, z, 1 / 6227020800.0);
    c = fused(c, z, 1 / 479001600.0);
    s = fused(s, z, -1 / 39916800.0);
    c = fused(c, z, -1 / 3628800.0);
    s = fused(s, z, 1 / 362880.0);
    c = fused(c, z, 1 / 40320.0);
    s = fused(s, z, -1 / 5040.0);
    c = fused(c, z, -1 / 720.0);
    s = fused(s, z, 1 / 120.0);
    c = fused(c, z, 1 / 24.0);
    s = fused(s, z, -1 / 6.0);
    double const half = 0.5 * z, most = 1 - half;
    double const cosine = most + (((1 - most) - half) + fused(z * z, c, -r * rest));
    double const sine = r + fused(s * z, r, rest * cosine);
    return turned_back(quarters == quarters ? static_cast<int>(quarters) : 0, cosine, sine);
}
/// Overload for extended precision and instrumented scalars.
template <class Real>
CATENA_HD BasicCosSin<Real> cos_sin(Real x) {
    using std::cos;
    using std::sin;
    return {cos(x), sin(x)};
}
/// Overload that applies the same operations to all lanes of a vector. Digits may differ beyond
/// 1e16, where adjacent doubles are a radian apart.
template <class Real>
    requires requires { Real::lanes; }
CATENA_HD BasicCosSin<Real> cos_sin(Real x) {
    if (any_above(x, 1e5)) {
        Real const turn(0x1.921fb54442d18p+2), turn_low(0x1.1a62633145c07p-52), bound(1e5);
        // The remainder is exact, or one period off if the quotient was rounded across an integer.
        Real left = fused(-truncated(x / turn), turn, x);
        Real const wrong = Real(0) - left * x;  // positive if one period off
        left =
            where_less(Real(0), wrong, where_less(left, Real(0), left + turn, left - turn), left);
        Real const reduced = fused(-floor((x - left) / turn + Real(0.5)), turn_low, left);
        x = where_less(bound, x, reduced, where_less(x, -bound, reduced, x));
    }
    Real const quarters = floor(fused(x, Real(0.63661977236758134), Real(0.5))),
               second = quarters * Real(0x1.0b4611a600000p-34);
    Real const once = fused(-quarters, Real(0x1.921fb54400000p+0), x), twice = once - second;
    Real const low = fused(-quarters, Real(0x1.3198a2e037073p-69), (once - twice) - second);
    Real const r = twice + low, rest = (twice - r) + low, z = r * r;
    Real s(1 / 355687428096000.0), c(1 / 20922789888000.0);
    s = fused(s, z, Real(-1 / 1307674368000.0));
    c = fused(c, z, Real(-1 / 87178291200.0));
    s = fused(s, z, Real(1 / 6227020800.0));
    c = fused(c, z, Real(1 / 479001600.0));
    s = fused(s, z, Real(-1 / 39916800.0));
    c = fused(c, z, Real(-1 / 3628800.0));
    s = fused(s, z, Real(1 / 362880.0));
    c = fused(c, z, Real(1 / 40320.0));
    s = fused(s, z, Real(-1 / 5040.0));
    c = fused(c, z, Real(-1 / 720.0));
    s = fused(s, z, Real(1 / 120.0));
    c = fused(c, z, Real(1 / 24.0));
    s = fused(s, z, Real(-1 / 6.0));
    Real const half = Real(0.5) * z, most = Real(1) - half;
    Real const cosine = most + (((Real(1) - most) - half) + fused(z * z, c, -r * rest));
    Real const sine = r + fused(s * z, r, rest * cosine);
    // This repeats turned_back() with the last two bits of `quarters`.
    // odd() returns 0 for even n and 1/2 for odd n.
    auto const odd = [](Real const& n) { return Real(0.5) * n - floor(Real(0.5) * n); };
    Real const swapped = odd(quarters), zero(0);
    Real const along = where_less(zero, swapped, sine, cosine),
               across = where_less(zero, swapped, cosine, sine);
    return {where_less(zero, odd(floor(Real(0.5) * (quarters + Real(1)))), -along, along),
            where_less(zero, odd(floor(Real(0.5) * quarters)), -across, across)};
}

/// Returns the angle in [0, pi/2] whose tangent is s / w, within 2 units in the last place.
/// Preconditions: s >= 0, w >= 0, not both 0. The arc tangent of the nearest quarter c is
/// tabulated; the argument of the remaining series is below 1/8.
CATENA_HD double angle_of(double s, double w) {
    bool const steep = s > w;
    double const t = steep ? w / s : s / w, nearest = std::floor(4 * t + 0.5), c = 0.25 * nearest;
    double const u = (t - c) / fused(c, t, 1.0), z = u * u;
    double high = 0, low = 0;  // arc tangent of c, in two parts
    if (nearest == 1) {
        high = 0x1.f5b75f92c80ddp-3;
        low = 0x1.8ab6e3cf7afbdp-57;
    } else if (nearest == 2) {
        high = 0x1.dac670561bb4fp-2;
        low = 0x1.a2b7f222f65e2p-56;
    } else if (nearest == 3) {
        high = 0x1.4978fa3269ee1p-1;
        low = 0x1.2419a87f2a458p-56;
    } else if (nearest == 4) {
        high = 0x1.921fb54442d18p-1;
        low = 0x1.1a62633145c07p-55;
    }
    double series = 1.0 / 17;
    series = fused(series, z, -1.0 / 15);
    series = fused(series, z, 1.0 / 13);
    series = fused(series, z, -1.0 / 11);
    series = fused(series, z, 1.0 / 9);
    series = fused(series, z, -1.0 / 7);
    series = fused(series, z, 1.0 / 5);
    series = fused(series, z, -1.0 / 3);
    double const beyond = fused(series * z, u, low) + u;
    return steep ? (0x1.921fb54442d18p+0 - high) + (0x1.1a62633145c07p-54 - beyond) : high + beyond;
}
/// Overload for extended precision, instrumented and SIMD scalars.
template <class Real>
CATENA_HD Real angle_of(Real s, Real w) {
    using std::atan2;
    return atan2(s, w);
}

}  // namespace catena
