// Rotations, and the spring of a spherical joint. Internal to the oracles.
#pragma once

#include <array>

#include "math/rotation.hpp"
#include "oracle/algebra.hpp"

namespace catena::oracle {

/// Returns the normalised quaternion q.
template <class S>
Quaternion<S> unit(std::array<double, 4> const& q) {
    using std::sqrt;
    S const w(q[0]), x(q[1]), y(q[2]), z(q[3]);
    S const n = sqrt(w * w + x * x + y * y + z * z);
    return {w / n, x / n, y / n, z / n};
}
/// Returns v / |v|.
template <class S>
V3<S> unit(V3<S> const& v) {
    return S(S(1) / norm(v)) * v;
}

/// Returns 1 + sine [a]x + versine [a]x^2 (Rodrigues' formula).
template <class S>
M3<S> rodrigues(V3<S> const& a, S sine, S versine) {
    M3<S> const ax = skew(a);
    return plus(M3<S>::identity(), plus(scaled(sine, ax), scaled(versine, ax * ax)));
}
/// Returns the rotation matrix of a unit quaternion.
template <class S>
M3<S> matrix(Quaternion<S> const& q) {
    return rodrigues(V3<S>{{q.x, q.y, q.z}}, S(2) * q.w, S(2));
}
/// Returns the rotation matrix by `angle` about the unit vector `axis`.
template <class S>
M3<S> turn_about(V3<S> const& axis, S angle) {
    using std::cos;
    using std::sin;
    S const half = sin(angle / S(2));
    return rodrigues(axis, S(sin(angle)), S(S(2) * half * half));
}

/// Returns the rotation matrix nearest to r, which is orthogonal to about double precision.
/// Newton's iteration for the polar factor makes its transpose the inverse in wider scalars too.
template <class S>
M3<S> orthonormal(Mat3 const& r) {
    M3<S> m;
    for (int i = 0; i < 9; ++i) m.data[i] = S(r.data[i]);
    for (int step = 0; step < 2; ++step) {
        M3<S> const defect = plus(M3<S>::identity(), scaled(S(-1), transpose(m) * m));
        m = plus(m, scaled(S(1) / S(2), m * defect));
    }
    return m;
}

/// Returns the rotation vector (length at most pi) of rest^-1 q; its components are the same in B
/// and in the rest frame.
template <class S>
V3<S> deflection(Quaternion<S> const& rest, Quaternion<S> const& q) {
    using std::atan2;
    V3<S> const a{{rest.x, rest.y, rest.z}}, b{{q.x, q.y, q.z}};
    S w = rest.w * q.w + dot(a, b);
    V3<S> v = rest.w * b - q.w * a - cross(a, b);
    if (w < S(0)) {
        w = -w;
        v = -v;
    }
    S const s = norm(v);
    return s > S(0) ? S(S(2) * atan2(s, w) / s) * v : v;
}

/// Returns the torque (B) of the potential 1/2 sum k_i e_i^2 in the rotation vector e, with moment
/// = K e. The torque is - J^-T K e, where e' = J^-1(e) omega_B (J^-1 is the inverse right Jacobian
/// of the rotation group). For equal k_i it is - k e.
template <class S>
V3<S> spring_torque(V3<S> const& e, V3<S> const& moment) {
    using std::cos;
    using std::sin;
    S const angle = norm(e), half = angle / S(2);
    S const c = angle > S(0) ? S((S(1) - half * cos(half) / sin(half)) / (angle * angle)) : S(0);
    V3<S> const turned_moment = cross(e, moment);
    return S(1) / S(2) * turned_moment - c * cross(e, turned_moment) - moment;
}

/// Returns two unit vectors that are orthogonal to the unit vector `axis` and to each other.
template <class S>
std::array<V3<S>, 2> across(V3<S> const& axis) {
    using std::abs;
    int smallest = 0;
    for (int i = 1; i < 3; ++i)
        if (abs(axis[i]) < abs(axis[smallest])) smallest = i;
    V3<S> other = V3<S>::zero();
    other[smallest] = S(1);
    V3<S> const first = unit(cross(axis, other));
    return {first, cross(axis, first)};
}

}  // namespace catena::oracle
