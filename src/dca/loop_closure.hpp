// The joint that closes a chain last, host and device: from the first body to the ground or, in a
// ring, to the last body.
//
// A loop may be overconstrained; the matrix of its closing joint is then singular. The
// accelerations are unique, and the least forces are chosen.
#pragma once

#include <cmath>

#include "dca/segment.hpp"

namespace catena::dca {

/// Returns Z of the joint between a ring's two handles (src/dca/README.md, "Ends and rings").
template <class Real, int K>
CATENA_HD Symmetric<Real, K> ring_matrix(SegmentMatrix<Real, K> const& s) {
    Symmetric<Real, K> z;
    CATENA_UNROLL
    for (int i = 0; i < K; ++i) {
        CATENA_UNROLL
        for (int j = 0; j <= i; ++j)
            z(i, j) = (s.z11(i, j) + s.z22(i, j)) - (s.z12(i, j) + s.z12(j, i));
    }
    return z;
}

/// Fraction of the open chain's response below which a value counts as 0: fewer than six of its
/// digits would be significant.
template <class Real>
inline constexpr Real lost_digits = Real(0x1p-33);

/// Returns the response of the closing joint's two sides to a unit force along each direction while
/// the loop is open. It is the scale of Z's entries.
template <class Real, int K>
CATENA_HD Vector<Real, K> open_response(SegmentMatrix<Real, K> const& s, bool ring) {
    Vector<Real, K> size;
    CATENA_UNROLL
    for (int i = 0; i < K; ++i) size[i] = ring ? s.z11(i, i) + s.z22(i, i) : s.z11(i, i);
    return size;
}

/// True if a pivot is so small that the matrix may be singular. `factor` is factorize() of its
/// leading `restricted` rows.
template <class Real, int K>
CATENA_HD bool is_nearly_singular(Symmetric<Real, K> const& factor, Vector<Real, K> const& size,
                                  int restricted) {
    bool small = false;
    CATENA_UNROLL
    for (int i = 0; i < K; ++i)
        small = small || (i < restricted && Real(1) / factor(i, i) < lost_digits<Real> * size[i]);
    return small;
}

/// Spectral decomposition a = V diag(values) V^T; the columns of `vectors` are V.
template <class Real, int K>
struct Spectrum {
    Vector<Real, K> values;
    Matrix<Real, K, K> vectors;
};
/// Returns the spectral decomposition of `a` by Jacobi rotations.
template <class Real, int K>
CATENA_HD_APART Spectrum<Real, K> spectrum_of(Symmetric<Real, K> a) {
    using std::sqrt;
    // A 6 x 6 matrix is diagonal up to rounding after seven rounds at most.
    int constexpr rounds = 10;
    Spectrum<Real, K> s;
    s.vectors = Matrix<Real, K, K>::identity();
    for (int round = 0; round < rounds; ++round)
        for (int p = 0; p < K; ++p)
            for (int q = p + 1; q < K; ++q) {
                if (a(p, q) == Real(0)) continue;
                Real const slope = (a(q, q) - a(p, p)) / (Real(2) * a(p, q)),
                           root = sqrt(fused(slope, slope, Real(1)));
                Real const t =
                    slope < Real(0) ? Real(-1) / (root - slope) : Real(1) / (root + slope);
                Real const c = Real(1) / sqrt(fused(t, t, Real(1))), sine = t * c, moved = a(p, q);
                a(p, p) = fused(-t, moved, a(p, p));
                a(q, q) = fused(t, moved, a(q, q));
                a(p, q) = Real(0);
                for (int r = 0; r < K; ++r) {
                    Real const vp = s.vectors(r, p), vq = s.vectors(r, q);
                    s.vectors(r, p) = fused(c, vp, -(sine * vq));
                    s.vectors(r, q) = fused(sine, vp, c * vq);
                    if (r == p || r == q) continue;
                    Real const ap = a(r, p), aq = a(r, q);
                    a(r, p) = fused(c, ap, -(sine * aq));
                    a(r, q) = fused(sine, ap, c * aq);
                }
            }
    for (int i = 0; i < K; ++i) s.values[i] = a(i, i);
    return s;
}

/// Returns the pseudo-inverse of z's leading `restricted` rows in the metric of the open chain.
/// With D = diag(size), eigenvalues of D^-1/2 z D^-1/2 below `lost_digits` count as 0. Forces x =
/// z^+ b then have the least x^T D x. The result is NaN if z has an eigenvalue below
/// -`lost_digits` in this metric.
template <class Real, int K>
CATENA_HD_APART Matrix<Real, K, K> least_norm_inverse(Symmetric<Real, K> const& z,
                                                      Vector<Real, K> const& size, int restricted) {
    using std::sqrt;
    Vector<Real, K> scale;
    for (int i = 0; i < K; ++i) scale[i] = i < restricted ? Real(1) / sqrt(size[i]) : Real(0);
    Symmetric<Real, K> scaled;
    for (int i = 0; i < K; ++i)
        for (int j = 0; j <= i; ++j)
            scaled(i, j) = i < restricted ? (scale[i] * z(i, j)) * scale[j] : Real(0);
    Spectrum<Real, K> const s = spectrum_of(scaled);
    Matrix<Real, K, K> inverse = Matrix<Real, K, K>::zero();
    for (int e = 0; e < K; ++e) {
        bool const nothing = s.values[e] < lost_digits<Real> && s.values[e] > -lost_digits<Real>;
        Real const weight = nothing                 ? Real(0)
                            : s.values[e] > Real(0) ? Real(1) / s.values[e]
                                                    : Real(__builtin_nan(""));
        for (int i = 0; i < K; ++i)
            for (int j = 0; j < K; ++j)
                inverse(i, j) = fused((weight * (scale[i] * s.vectors(i, e))) * scale[j],
                                      s.vectors(j, e), inverse(i, j));
    }
    return inverse;
}

/// True if a matrix's diagonal has no negative number and no NaN.
template <class Real, int K>
CATENA_HD bool has_diagonal_of_squares(Matrix<Real, K, K> const& m) {
    bool good = true;
    CATENA_UNROLL
    for (int i = 0; i < K; ++i) good = good && m(i, i) >= Real(0);
    return good;
}
/// The joint that closes a loop.
template <class Real, int K>
struct ClosingJoint {
    /// The factor is that of any joint. If it is nearly singular, it is zero and `inboard` holds
    /// the pseudo-inverse, which is zero otherwise.
    JointMatrix<Real, K> joint;
    /// True if the joint was nearly singular, but not indefinite. The pseudo-inverse of a joint
    /// that is wholly redundant is zero. Of one direction alone, zero may also mean that all digits
    /// were lost (beads with mass ratios of 1e8), so such a joint does not count.
    bool has_least_norm = false;
};
/// Returns the joint that closes a loop.
template <class Real, int K>
CATENA_HD ClosingJoint<Real, K> closing_joint(Symmetric<Real, K> const& z,
                                              Vector<Real, K> const& size, int restricted) {
    ClosingJoint<Real, K> closing{
        {factorize(z, restricted), Matrix<Real, K, K>::zero(), Matrix<Real, K, K>::zero()}};
    JointMatrix<Real, K>& joint = closing.joint;
    if (!is_nearly_singular(joint.factor, size, restricted)) return closing;
    joint.inboard = least_norm_inverse(z, size, restricted);
    joint.factor = Symmetric<Real, K>::zero();
    closing.has_least_norm =
        has_diagonal_of_squares(joint.inboard) && (restricted > 1 || joint.inboard(0, 0) > Real(0));
    return closing;
}
/// Returns the closing joint's force. It cancels `apart`, the acceleration of the joint's inboard
/// side relative to its outboard side.
template <class Real, int K>
CATENA_HD Vector<Real, K> closing_force(JointMatrix<Real, K> const& joint,
                                        Vector<Real, K> const& apart) {
    return solve_upper(joint.factor, solve_lower(joint.factor, apart)) + joint.inboard * apart;
}

}  // namespace catena::dca
