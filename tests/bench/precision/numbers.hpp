// Numbers of one lane or several, single and double, and how they turn into each other.
#pragma once

#include <cstdint>
#include <type_traits>

#include "math/linear.hpp"

namespace catena::precision {

/// Twice as many lanes: doubles beside single-precision vectors of the same size.
template <class Half>
struct Twice {
    static constexpr int lanes = 2 * Half::lanes;
    Half low, high;
    Twice() = default;
    Twice(double x) : low(x), high(x) {}
    Twice(Half low_in, Half high_in) : low(low_in), high(high_in) {}
    static Twice load_anywhere(double const* place) {
        return {Half::load_anywhere(place), Half::load_anywhere(place + Half::lanes)};
    }
    void store_anywhere(double* place) const {
        low.store_anywhere(place);
        high.store_anywhere(place + Half::lanes);
    }
    friend Twice operator+(Twice const& a, Twice const& b) {
        return {a.low + b.low, a.high + b.high};
    }
    friend Twice operator-(Twice const& a, Twice const& b) {
        return {a.low - b.low, a.high - b.high};
    }
    friend Twice operator*(Twice const& a, Twice const& b) {
        return {a.low * b.low, a.high * b.high};
    }
    friend Twice operator/(Twice const& a, Twice const& b) {
        return {a.low / b.low, a.high / b.high};
    }
    friend Twice operator-(Twice const& a) { return {-a.low, -a.high}; }
    friend Twice fused(Twice const& a, Twice const& b, Twice const& c) {
        return {fused(a.low, b.low, c.low), fused(a.high, b.high, c.high)};
    }
    friend Twice less_product(Twice const& a, Twice const& b, Twice const& c) {
        return {less_product(a.low, b.low, c.low), less_product(a.high, b.high, c.high)};
    }
};

template <class Real>
constexpr int lanes_of() {
    if constexpr (std::is_arithmetic_v<Real>)
        return 1;
    else
        return Real::lanes;
}
template <class Real>
struct NumberOf {
    using type = double;
};
template <>
struct NumberOf<float> {
    using type = float;
};
/// Vectors of single precision say so.
template <class Real>
    requires requires { typename Real::Number; }
struct NumberOf<Real> {
    using type = typename Real::Number;
};

template <class Real>
Real load(typename NumberOf<Real>::type const* place) {
    if constexpr (std::is_arithmetic_v<Real>)
        return *place;
    else
        return Real::load_anywhere(place);
}
template <class Real>
void store(Real const& value, typename NumberOf<Real>::type* place) {
    if constexpr (std::is_arithmetic_v<Real>)
        *place = value;
    else
        value.store_anywhere(place);
}

/// Bit j: lane j is not a positive finite number.
template <class Real>
unsigned not_positive(Real const& x) {
    if constexpr (std::is_arithmetic_v<Real>)
        return x > 0 && x - x == 0 ? 0U : 1U;
    else
        return x.not_positive();
}

/// In the other precision, with as many lanes.
template <class To, class From>
To converted(From const& x) {
    if constexpr (std::is_same_v<To, From>)
        return x;
    else if constexpr (std::is_arithmetic_v<To>)
        return static_cast<To>(x);
    else
        return convert(x, static_cast<To const*>(nullptr));
}
template <class To, class From, int N>
Vector<To, N> converted(Vector<From, N> const& v) {
    Vector<To, N> w;
    for (int i = 0; i < N; ++i) w[i] = converted<To>(v[i]);
    return w;
}

/// Lane j gets what lane j + by had, the last lanes what the first ones had.
template <class Real, class Record>
Record turned(Record const& record, int by) {
    constexpr int lanes = lanes_of<Real>();
    typename NumberOf<Real>::type numbers[2 * lanes];
    Record result = record;
    auto* const values = reinterpret_cast<Real*>(&result);
    for (int n = 0; n < static_cast<int>(sizeof(Record) / sizeof(Real)); ++n) {
        store(values[n], numbers);
        store(values[n], numbers + lanes);
        values[n] = load<Real>(numbers + by);
    }
    return result;
}
/// The same with `value` in one lane.
template <class Real, int N>
Vector<Real, N> with_lane(Vector<Real, N> v, int lane, double value) {
    using Number = typename NumberOf<Real>::type;
    Number numbers[lanes_of<Real>()];
    for (int i = 0; i < N; ++i) {
        store(v[i], numbers);
        numbers[lane] = static_cast<Number>(value);
        v[i] = load<Real>(numbers);
    }
    return v;
}

}  // namespace catena::precision
