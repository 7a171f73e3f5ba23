// Operations on 3-vectors and small matrices that math/linear.hpp lacks. Internal to the oracles.
#pragma once

#include "math/linear.hpp"
#include "oracle/quad.hpp"

namespace catena::oracle {

/// Vector of three components.
template <class S>
using V3 = Vector<S, 3>;
/// 3 x 3 matrix.
template <class S>
using M3 = Matrix<S, 3, 3>;

/// Converts a vector to the oracle's scalar.
template <class S>
V3<S> lift(Vec3 const& v) {
    return {{S(v[0]), S(v[1]), S(v[2])}};
}
/// Returns a + b.
template <class S, int R, int C>
Matrix<S, R, C> plus(Matrix<S, R, C> a, Matrix<S, R, C> const& b) {
    for (int i = 0; i < R * C; ++i) a.data[i] = a.data[i] + b.data[i];
    return a;
}
/// Returns s a.
template <class S, int R, int C>
Matrix<S, R, C> scaled(S s, Matrix<S, R, C> a) {
    for (S& x : a.data) x = s * x;
    return a;
}
/// Returns a + s b c^T.
template <class S>
M3<S> plus_outer(M3<S> a, S s, V3<S> const& b, V3<S> const& c) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) a(i, j) = a(i, j) + s * b[i] * c[j];
    return a;
}
/// Returns the matrix [v]x with [v]x y = v x y.
template <class S>
M3<S> skew(V3<S> const& v) {
    return {{S(0), -v[2], v[1], v[2], S(0), -v[0], -v[1], v[0], S(0)}};
}
/// Returns r a r^T.
template <class S>
M3<S> turned(M3<S> const& r, M3<S> const& a) {
    return r * (a * transpose(r));
}
/// Returns (a + a^T) / 2.
template <class S>
M3<S> symmetrized(M3<S> const& a) {
    return scaled(S(1) / S(2), plus(a, transpose(a)));
}

/// Cholesky factor L of a small symmetric positive definite matrix L L^T.
template <class S, int N>
class Cholesky {
  public:
    explicit Cholesky(Matrix<S, N, N> const& a) : factor_(Matrix<S, N, N>::zero()) {
        using std::sqrt;
        for (int j = 0; j < N; ++j)
            for (int i = j; i < N; ++i) {
                S rest = a(i, j);
                for (int k = 0; k < j; ++k) rest -= factor_(i, k) * factor_(j, k);
                if (i == j && !(rest > S(0))) definite_ = false;
                factor_(i, j) = i == j ? S(sqrt(rest)) : S(rest / factor_(j, j));
            }
    }
    /// False if some pivot was not positive; solve() is then invalid.
    bool definite() const { return definite_; }
    /// Returns the solution y of L L^T y = x.
    Vector<S, N> solve(Vector<S, N> x) const {
        for (int i = 0; i < N; ++i) {
            for (int k = 0; k < i; ++k) x[i] -= factor_(i, k) * x[k];
            x[i] /= factor_(i, i);
        }
        for (int i = N; i-- > 0;) {
            for (int k = i + 1; k < N; ++k) x[i] -= factor_(k, i) * x[k];
            x[i] /= factor_(i, i);
        }
        return x;
    }

  private:
    Matrix<S, N, N> factor_;
    bool definite_ = true;
};

}  // namespace catena::oracle
