// Rotations as unit quaternions (w, x, y, z). Q_AB maps components in frame B to components in
// frame A.
#pragma once

#include "math/elementary.hpp"
#include "math/linear.hpp"

namespace catena {

/// Quaternion w + x i + y j + z k; a unit quaternion represents a rotation.
template <class Real>
struct Quaternion {
    Real w, x, y, z;
    static CATENA_HD Quaternion identity() { return {Real(1), Real(0), Real(0), Real(0)}; }
};
using Quat = Quaternion<double>;
/// Returns the quaternion of components (w, x, y, z).
template <class Real>
CATENA_HD Quaternion<Real> as_quaternion(Vector<Real, 4> const& v) {
    return {v[0], v[1], v[2], v[3]};
}
/// Returns the components (w, x, y, z).
template <class Real>
CATENA_HD Vector<Real, 4> as_vector(Quaternion<Real> const& q) {
    return {{q.w, q.x, q.y, q.z}};
}

/// Quaternion product: Q_AC = Q_AB Q_BC.
template <class Real>
CATENA_HD Quaternion<Real> operator*(Quaternion<Real> const& a, Quaternion<Real> const& b) {
    return {fused(-a.z, b.z, fused(-a.y, b.y, fused(-a.x, b.x, a.w * b.w))),
            fused(-a.z, b.y, fused(a.y, b.z, fused(a.x, b.w, a.w * b.x))),
            fused(-a.x, b.z, fused(a.z, b.x, fused(a.y, b.w, a.w * b.y))),
            fused(-a.y, b.x, fused(a.x, b.y, fused(a.z, b.w, a.w * b.z)))};
}
template <class Real>
CATENA_HD Quaternion<Real> conjugate(Quaternion<Real> const& q) {
    return {q.w, -q.x, -q.y, -q.z};
}
template <class Real>
CATENA_HD Real squared_norm(Quaternion<Real> const& q) {
    return fused(q.z, q.z, fused(q.y, q.y, fused(q.x, q.x, q.w * q.w)));
}
template <class Real>
CATENA_HD Quaternion<Real> normalized(Quaternion<Real> const& q) {
    using std::sqrt;
    Real const s = Real(1) / sqrt(squared_norm(q));
    return {s * q.w, s * q.x, s * q.y, s * q.z};
}
/// Returns the rotation matrix R_AB of Q_AB, given s = 2 / |q|^2.
template <class Real>
CATENA_HD Matrix<Real, 3, 3> to_matrix(Quaternion<Real> const& q, Real const& s) {
    Real const xs = q.x * s, ys = q.y * s, zs = q.z * s;
    Real const wx = q.w * xs, wy = q.w * ys, wz = q.w * zs, xx = q.x * xs, yy = q.y * ys,
               zz = q.z * zs;
    // Sums and differences of the same products are not left to the compiler: gcc 12 contracts them
    // where it vectorises, with -ffp-contract=off or without.
    return {{Real(1) - (yy + zz), fused(q.x, ys, -wz), fused(q.x, zs, wy), fused(q.x, ys, wz),
             Real(1) - (xx + zz), fused(q.y, zs, -wx), fused(q.x, zs, -wy), fused(q.y, zs, wx),
             Real(1) - (xx + yy)}};
}
/// Returns s = 2 / |q|^2; q need not be normalised to the last bit. `inverse(x)` returns 1 / x.
template <class Real, class Inverse>
CATENA_HD Real matrix_scale(Quaternion<Real> const& q, Inverse const& inverse) {
    return Real(2) * inverse(squared_norm(q));
}
/// Returns the rotation matrix of q; the norm of q is divided out.
template <class Real>
CATENA_HD Matrix<Real, 3, 3> to_matrix(Quaternion<Real> const& q) {
    return to_matrix(q, Real(2) / squared_norm(q));
}
/// Returns the rotation matrix of a q whose norm is 1 up to rounding.
template <class Real>
CATENA_HD Matrix<Real, 3, 3> to_matrix_of_unit(Quaternion<Real> const& q) {
    return to_matrix(q, Real(4) - Real(2) * squared_norm(q));
}
/// Rotation by `angle` about the unit vector `axis` (right-hand rule).
template <class Real>
CATENA_HD Quaternion<Real> from_axis_angle(Vector<Real, 3> const& axis, Real angle) {
    auto const [c, s] = cos_sin(Real(0.5) * angle);
    return {c, s * axis[0], s * axis[1], s * axis[2]};
}
/// Returns the rotation with rotation vector v (angle |v| about v), accurate for small |v|.
template <class Real>
CATENA_HD Quaternion<Real> from_rotation_vector(Vector<Real, 3> const& v) {
    Real const angle = norm(v);
    auto const half = cos_sin(Real(0.5) * angle);
    Real const s = angle > Real(1e-8) ? half.sin / angle : Real(0.5);
    return {half.cos, s * v[0], s * v[1], s * v[2]};
}
/// Returns the rotation vector of q; its length is at most pi.
template <class Real>
CATENA_HD Vector<Real, 3> rotation_vector(Quaternion<Real> q) {
    using std::sqrt;
    if (q.w < Real(0)) q = {-q.w, -q.x, -q.y, -q.z};
    Real const s = sqrt(fused(q.z, q.z, fused(q.y, q.y, q.x * q.x)));
    Real const f = s > Real(1e-12) ? Real(2) * angle_of(s, q.w) / s : Real(2) / q.w;
    return {{f * q.x, f * q.y, f * q.z}};
}
/// Returns the unit quaternion of a rotation matrix (Shepperd's choice of the largest component).
template <class Real>
CATENA_HD Quaternion<Real> to_quaternion(Matrix<Real, 3, 3> const& r) {
    Real const t = r(0, 0) + r(1, 1) + r(2, 2);
    if (t >= r(0, 0) && t >= r(1, 1) && t >= r(2, 2))
        return normalized(
            Quaternion<Real>{Real(1) + t, r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1)});
    if (r(0, 0) >= r(1, 1) && r(0, 0) >= r(2, 2))
        return normalized(Quaternion<Real>{r(2, 1) - r(1, 2), Real(1) + r(0, 0) - r(1, 1) - r(2, 2),
                                           r(0, 1) + r(1, 0), r(0, 2) + r(2, 0)});
    if (r(1, 1) >= r(2, 2))
        return normalized(Quaternion<Real>{r(0, 2) - r(2, 0), r(0, 1) + r(1, 0),
                                           Real(1) - r(0, 0) + r(1, 1) - r(2, 2),
                                           r(1, 2) + r(2, 1)});
    return normalized(Quaternion<Real>{r(1, 0) - r(0, 1), r(0, 2) + r(2, 0), r(1, 2) + r(2, 1),
                                       Real(1) - r(0, 0) - r(1, 1) + r(2, 2)});
}

/// Returns the rotation matrix nearest to r, without its rounding errors, by r (3 - r^T r) / 2.
/// Precondition: r is a rotation matrix up to rounding.
template <class Real>
CATENA_HD Matrix<Real, 3, 3> orthogonal(Matrix<Real, 3, 3> const& r) {
    Symmetric<Real, 3> half;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        CATENA_UNROLL
        for (int j = 0; j <= i; ++j)
            half(i, j) = Real(i == j ? 1.5 : 0) - Real(0.5) * dot(r.column(i), r.column(j));
    }
    return r * full(half);
}

}  // namespace catena
