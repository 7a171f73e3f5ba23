// Scalar with 113 bits for the oracles, precise enough to judge all other scalars. It is slow
// (software arithmetic).
#pragma once

#include <cmath>

namespace catena::oracle {

// QuadBits is IEEE quadruple: long double if the compiler has no __float128 (64-bit ARM).
#if defined(__SIZEOF_FLOAT128__)
using QuadBits = __float128;
#else
using QuadBits = long double;
#endif

/// IEEE quadruple precision as a class. Its functions are thus found by argument-dependent look-up,
/// and no compiler extension or run-time library except libgcc is needed. The errors of sqrt, sin,
/// cos and atan2 are a few units in the last place.
class Quad {
  public:
    Quad() = default;
    Quad(int x) : bits_(x) {}
    Quad(long x) : bits_(x) {}
    Quad(double x) : bits_(x) {}
    Quad(long double x) : bits_(x) {}
    explicit operator double() const { return static_cast<double>(bits_); }
    explicit operator long double() const { return static_cast<long double>(bits_); }
    explicit operator int() const { return static_cast<int>(bits_); }

    Quad& operator+=(Quad b) { return *this = of(bits_ + b.bits_); }
    Quad& operator-=(Quad b) { return *this = of(bits_ - b.bits_); }
    Quad& operator*=(Quad b) { return *this = of(bits_ * b.bits_); }
    Quad& operator/=(Quad b) { return *this = of(bits_ / b.bits_); }
    friend Quad operator+(Quad a, Quad b) { return of(a.bits_ + b.bits_); }
    friend Quad operator-(Quad a, Quad b) { return of(a.bits_ - b.bits_); }
    friend Quad operator*(Quad a, Quad b) { return of(a.bits_ * b.bits_); }
    friend Quad operator/(Quad a, Quad b) { return of(a.bits_ / b.bits_); }
    friend Quad operator-(Quad a) { return of(-a.bits_); }
    friend bool operator==(Quad a, Quad b) { return a.bits_ == b.bits_; }
    friend bool operator!=(Quad a, Quad b) { return a.bits_ != b.bits_; }
    friend bool operator<(Quad a, Quad b) { return a.bits_ < b.bits_; }
    friend bool operator<=(Quad a, Quad b) { return a.bits_ <= b.bits_; }
    friend bool operator>(Quad a, Quad b) { return a.bits_ > b.bits_; }
    friend bool operator>=(Quad a, Quad b) { return a.bits_ >= b.bits_; }

    /// Gap above 1: 2^-112.
    static Quad epsilon() { return of(QuadBits(0x1p-112)); }

  private:
    static Quad of(QuadBits bits) {
        Quad q;
        q.bits_ = bits;
        return q;
    }
    QuadBits bits_;
};

inline Quad abs(Quad x) { return x < Quad(0) ? -x : x; }
inline bool isfinite(Quad x) { return x - x == Quad(0); }

/// Square root; returns x itself unless x > 0.
inline Quad sqrt(Quad x) {
    if (!(x > Quad(0))) return x;
    // The long double root has 64 bits; one step of Newton's iteration doubles them.
    Quad const s(std::sqrt(static_cast<long double>(x)));
    return s + (x - s * s) / (s + s);
}

/// Reduces x to r in [-pi/4, pi/4] with x = r + quadrant pi/2. Precondition: |x| < 1e9.
inline Quad reduce_angle(Quad x, int& quadrant) {
    // pi/2 in four parts
    double const parts[] = {0x1.921fb54442d18p0, 0x1.1a62633145c07p-54, -0x1.f1976b7ed8fbcp-110,
                            0x1.4cf98e804177dp-164};
    double const k = std::nearbyint(static_cast<double>(x) / parts[0]);
    for (double const part : parts) x -= Quad(k) * Quad(part);
    quadrant = static_cast<int>(static_cast<long long>(k) & 3);
    return x;
}
/// Sums `term` and its successors, each -r^2 / (i (i + 1)) times the previous one: the tail of the
/// series of sine and cosine.
inline Quad alternating_series(Quad term, Quad r, int i) {
    Quad sum = term;
    Quad const r2 = r * r;
    for (; abs(term) > abs(sum) * Quad(0x1p-118); i += 2) {
        term *= -r2 / Quad(i * (i + 1));
        sum += term;
    }
    return sum;
}
/// Sine of r + quadrant pi/2.
inline Quad sin_of_quadrant(Quad r, int quadrant) {
    Quad const value =
        (quadrant & 1) ? alternating_series(Quad(1), r, 1) : alternating_series(r, r, 2);
    return (quadrant & 2) ? -value : value;
}
/// Sine of x. Precondition: |x| < 1e9.
inline Quad sin(Quad x) {
    int quadrant = 0;
    Quad const r = reduce_angle(x, quadrant);
    return sin_of_quadrant(r, quadrant);
}
/// Cosine of x. Precondition: |x| < 1e9.
inline Quad cos(Quad x) {
    int quadrant = 0;
    Quad const r = reduce_angle(x, quadrant);
    return sin_of_quadrant(r, quadrant + 1);
}
/// Angle of the direction (x, y): the long double result with one Newton correction.
inline Quad atan2(Quad y, Quad x) {
    Quad const t(std::atan2(static_cast<long double>(y), static_cast<long double>(x)));
    Quad const across = y * cos(t) - x * sin(t),
               // (along, across) is the direction (x, y) rotated by -t.
        along = x * cos(t) + y * sin(t);
    return along > Quad(0) ? t + across / along : t;  // tan d = d up to rounding, since d < 2^-63
}

}  // namespace catena::oracle
