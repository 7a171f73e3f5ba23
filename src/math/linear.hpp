// Vectors and small matrices of compile-time size, for host and device. Real is double, float, an
// extended-precision or a SIMD type. These types are values; arrays over bodies are in
// math/field.hpp.
#pragma once

#include <cmath>

#include "math/host_device.hpp"

namespace catena {

/// Column vector of N components.
template <class Real, int N>
struct Vector {
    Real data[N];
    CATENA_HD Real& operator[](int i) { return data[i]; }
    CATENA_HD Real const& operator[](int i) const { return data[i]; }
    static CATENA_HD Vector zero() {
        Vector v;
        CATENA_UNROLL
        for (int i = 0; i < N; ++i) v[i] = Real(0);
        return v;
    }
};

/// Matrix of R rows and C columns, stored row-major: a(i, j) is row i, column j.
template <class Real, int R, int C>
struct Matrix {
    Real data[R * C];
    CATENA_HD Real& operator()(int i, int j) { return data[i * C + j]; }
    CATENA_HD Real const& operator()(int i, int j) const { return data[i * C + j]; }
    static CATENA_HD Matrix zero() {
        Matrix m;
        CATENA_UNROLL
        for (int i = 0; i < R * C; ++i) m.data[i] = Real(0);
        return m;
    }
    static CATENA_HD Matrix identity() {
        Matrix m = zero();
        CATENA_UNROLL
        for (int i = 0; i < (R < C ? R : C); ++i) m(i, i) = Real(1);
        return m;
    }
    CATENA_HD Vector<Real, R> column(int j) const {
        Vector<Real, R> v;
        CATENA_UNROLL
        for (int i = 0; i < R; ++i) v[i] = (*this)(i, j);
        return v;
    }
    CATENA_HD void set_column(int j, Vector<Real, R> const& v) {
        CATENA_UNROLL
        for (int i = 0; i < R; ++i) (*this)(i, j) = v[i];
    }
};

/// Symmetric matrix whose lower triangle is stored row by row: (0,0) (1,0) (1,1) (2,0) ...
template <class Real, int N>
struct Symmetric {
    static constexpr int size = N * (N + 1) / 2;
    Real data[size];
    /// Index of entry (i, j) in `data`; i and j may be swapped.
    static CATENA_HD constexpr int at(int i, int j) {
        return i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
    }
    CATENA_HD Real& operator()(int i, int j) { return data[at(i, j)]; }
    CATENA_HD Real const& operator()(int i, int j) const { return data[at(i, j)]; }
    static CATENA_HD Symmetric zero() {
        Symmetric m;
        CATENA_UNROLL
        for (int i = 0; i < size; ++i) m.data[i] = Real(0);
        return m;
    }
};

using Vec3 = Vector<double, 3>;

using Mat3 = Matrix<double, 3, 3>;
using Sym3 = Symmetric<double, 3>;
/// Returns the symmetric matrix whose stored triangle is v.
template <class Real>
CATENA_HD Symmetric<Real, 3> as_symmetric(Vector<Real, 6> const& v) {
    return {{v[0], v[1], v[2], v[3], v[4], v[5]}};
}

template <class Real, int N>
CATENA_HD Symmetric<Real, N> operator+(Symmetric<Real, N> a, Symmetric<Real, N> const& b) {
    CATENA_UNROLL
    for (int i = 0; i < Symmetric<Real, N>::size; ++i) a.data[i] = a.data[i] + b.data[i];
    return a;
}
template <class Real, int N>
CATENA_HD Vector<Real, N> operator+(Vector<Real, N> a, Vector<Real, N> const& b) {
    CATENA_UNROLL
    for (int i = 0; i < N; ++i) a[i] = a[i] + b[i];
    return a;
}
template <class Real, int N>
CATENA_HD Vector<Real, N> operator-(Vector<Real, N> a, Vector<Real, N> const& b) {
    CATENA_UNROLL
    for (int i = 0; i < N; ++i) a[i] = a[i] - b[i];
    return a;
}
template <class Real, int N>
CATENA_HD Vector<Real, N> operator-(Vector<Real, N> a) {
    CATENA_UNROLL
    for (int i = 0; i < N; ++i) a[i] = -a[i];
    return a;
}
template <class Real, int N>
CATENA_HD Vector<Real, N> operator*(Real s, Vector<Real, N> a) {
    CATENA_UNROLL
    for (int i = 0; i < N; ++i) a[i] = s * a[i];
    return a;
}
/// Returns a + s b.
template <class Real, int N>
CATENA_HD Vector<Real, N> plus_scaled(Vector<Real, N> a, Real s, Vector<Real, N> const& b) {
    CATENA_UNROLL
    for (int i = 0; i < N; ++i) a[i] = fused(s, b[i], a[i]);
    return a;
}
template <class Real, int N>
CATENA_HD Real dot(Vector<Real, N> const& a, Vector<Real, N> const& b) {
    Real s = a[0] * b[0];
    CATENA_UNROLL
    for (int i = 1; i < N; ++i) s = fused(a[i], b[i], s);
    return s;
}
template <class Real, int N>
CATENA_HD Real norm(Vector<Real, N> const& a) {
    using std::sqrt;
    return sqrt(dot(a, a));
}
template <class Real>
CATENA_HD Vector<Real, 3> cross(Vector<Real, 3> const& a, Vector<Real, 3> const& b) {
    return {{fused(a[1], b[2], -(a[2] * b[1])), fused(a[2], b[0], -(a[0] * b[2])),
             fused(a[0], b[1], -(a[1] * b[0]))}};
}
/// Returns the stored part of a rotation matrix: its first and last column.
template <class Real>
CATENA_HD Vector<Real, 6> kept_axes(Matrix<Real, 3, 3> const& axes) {
    Vector<Real, 3> const first = axes.column(0), last = axes.column(2);
    return {{first[0], first[1], first[2], last[0], last[1], last[2]}};
}
/// Returns the rotation matrix whose first and last column are `kept`; the second is their cross
/// product.
template <class Real>
CATENA_HD Matrix<Real, 3, 3> axes_of(Vector<Real, 6> const& kept) {
    Vector<Real, 3> const first{{kept[0], kept[1], kept[2]}}, last{{kept[3], kept[4], kept[5]}};
    Matrix<Real, 3, 3> axes;
    axes.set_column(0, first);
    axes.set_column(1, cross(last, first));
    axes.set_column(2, last);
    return axes;
}

template <class Real, int R, int C>
CATENA_HD Vector<Real, R> operator*(Matrix<Real, R, C> const& a, Vector<Real, C> const& x) {
    Vector<Real, R> y;
    CATENA_UNROLL
    for (int i = 0; i < R; ++i) {
        y[i] = a(i, 0) * x[0];
        CATENA_UNROLL
        for (int j = 1; j < C; ++j) y[i] = fused(a(i, j), x[j], y[i]);
    }
    return y;
}
/// Returns a^T x.
template <class Real, int R, int C>
CATENA_HD Vector<Real, C> transposed_times(Matrix<Real, R, C> const& a, Vector<Real, R> const& x) {
    Vector<Real, C> y;
    CATENA_UNROLL
    for (int j = 0; j < C; ++j) {
        y[j] = a(0, j) * x[0];
        CATENA_UNROLL
        for (int i = 1; i < R; ++i) y[j] = fused(a(i, j), x[i], y[j]);
    }
    return y;
}
template <class Real, int R, int K, int C>
CATENA_HD Matrix<Real, R, C> operator*(Matrix<Real, R, K> const& a, Matrix<Real, K, C> const& b) {
    Matrix<Real, R, C> m;
    CATENA_UNROLL
    for (int i = 0; i < R; ++i) {
        CATENA_UNROLL
        for (int j = 0; j < C; ++j) {
            Real s = a(i, 0) * b(0, j);
            CATENA_UNROLL
            for (int k = 1; k < K; ++k) s = fused(a(i, k), b(k, j), s);
            m(i, j) = s;
        }
    }
    return m;
}
/// Returns a^T b.
template <class Real, int K, int R, int C>
CATENA_HD Matrix<Real, R, C> transposed_times(Matrix<Real, K, R> const& a,
                                              Matrix<Real, K, C> const& b) {
    Matrix<Real, R, C> m;
    CATENA_UNROLL
    for (int i = 0; i < R; ++i) {
        CATENA_UNROLL
        for (int j = 0; j < C; ++j) {
            Real s = a(0, i) * b(0, j);
            CATENA_UNROLL
            for (int k = 1; k < K; ++k) s = fused(a(k, i), b(k, j), s);
            m(i, j) = s;
        }
    }
    return m;
}
template <class Real, int R, int C>
CATENA_HD Matrix<Real, C, R> transpose(Matrix<Real, R, C> const& a) {
    Matrix<Real, C, R> m;
    CATENA_UNROLL
    for (int i = 0; i < R; ++i) {
        CATENA_UNROLL
        for (int j = 0; j < C; ++j) m(j, i) = a(i, j);
    }
    return m;
}
template <class Real, int N>
CATENA_HD Vector<Real, N> operator*(Symmetric<Real, N> const& a, Vector<Real, N> const& x) {
    Vector<Real, N> y;
    CATENA_UNROLL
    for (int i = 0; i < N; ++i) {
        y[i] = a(i, 0) * x[0];
        CATENA_UNROLL
        for (int j = 1; j < N; ++j) y[i] = fused(a(i, j), x[j], y[i]);
    }
    return y;
}
/// Returns the symmetric matrix with both triangles stored.
template <class Real, int N>
CATENA_HD Matrix<Real, N, N> full(Symmetric<Real, N> const& a) {
    Matrix<Real, N, N> m;
    CATENA_UNROLL
    for (int i = 0; i < N; ++i) {
        CATENA_UNROLL
        for (int j = 0; j < N; ++j) m(i, j) = a(i, j);
    }
    return m;
}

}  // namespace catena
