// Articulated handles, host and device: a body or a run, together with its inboard joint, is held
// at that joint's inboard side and free at handle 2.
//
// Mobilities (segment.hpp) belong to runs that float. Where a light body hangs between heavy ones,
// or revolute joints are nearly parallel, two runs have large mobilities in common that cancel when
// the runs are merged.
//
// Here the inboard side is held, as in the articulated-body algorithm (Featherstone, Rigid Body
// Dynamics Algorithms, 2008, section 7.3). Runs are merged by sums of positive semidefinite
// matrices (Redheffer's star product; in estimation Sarkka and Garcia-Fernandez, IEEE Trans. Autom.
// Control 66, 2021, Lemma 8).
//
// A light last body makes handle 2 extremely mobile along the free directions of its joint. This
// part of the mobility, `tip`, is stored apart. The directions of each joint are rotated until
// `tip` lies along the first of them, so that its rounding errors stay out of the other directions.
#pragma once

#include "dca/segment.hpp"

namespace catena::dca {

/// A run between its first joint's inboard side, which has acceleration a1, and handle 2 of its
/// last body, on which force f2 acts:
///   f1 = inertia a1 - carry^T f2 + p,   a2 = carry a1 + (tip tip^T + rest rest^T) f2 + e + tip w.
/// Here f1 is the force of the first joint on the run. The last body's own joint contributes `tip`,
/// the other joints contribute `rest`. All are along the directions of the joints. Entries of
/// `inertia` and `carry` along free directions of the first joint are 0.
template <class Real, int K>
struct ArticulatedMatrix {
    Symmetric<Real, K> inertia;
    Matrix<Real, K, K> carry, tip, rest;
};
/// Bias terms p, e and w of the equations of ArticulatedMatrix.
template <class Real, int K>
struct ArticulatedBias {
    Vector<Real, K> p, e, w;
};

/// LU factorization with partial pivoting, A = P^-1 L U, with L and U in one matrix. Products with
/// an explicit inverse would lose the digits that pivoting preserves.
template <class Real, int K>
struct LuFactor {
    Matrix<Real, K, K> lu;
    Vector<Real, K> row;  // Row i of P A is row row[i] of A.
};
/// Returns the LU factorization of `a`. The caller checks the pivots lu(i, i) for zeros.
template <class Real, int K>
CATENA_HD_APART LuFactor<Real, K> lu_of(Matrix<Real, K, K> const& a) {
    using std::fabs;
    LuFactor<Real, K> f{a, {}};
    for (int i = 0; i < K; ++i) f.row[i] = Real(i);
    CATENA_NO_UNROLL
    for (int k = 0; k < K; ++k) {
        int largest = k;
        for (int i = k + 1; i < K; ++i)
            if (fabs(f.lu(i, k)) > fabs(f.lu(largest, k))) largest = i;
        for (int j = 0; j < K; ++j) {
            Real const other = f.lu(k, j);
            f.lu(k, j) = f.lu(largest, j);
            f.lu(largest, j) = other;
        }
        Real const other = f.row[k];
        f.row[k] = f.row[largest];
        f.row[largest] = other;
        for (int i = k + 1; i < K; ++i) {
            f.lu(i, k) = f.lu(i, k) / f.lu(k, k);
            for (int j = k + 1; j < K; ++j)
                f.lu(i, j) = less_product(f.lu(i, k), f.lu(k, j), f.lu(i, j));
        }
    }
    return f;
}
/// Returns A^-1 b.
template <class Real, int K>
CATENA_HD_APART Vector<Real, K> solve(LuFactor<Real, K> const& f, Vector<Real, K> const& b) {
    Vector<Real, K> x;
    for (int i = 0; i < K; ++i) {
        x[i] = b[static_cast<int>(f.row[i])];
        for (int j = 0; j < i; ++j) x[i] = less_product(f.lu(i, j), x[j], x[i]);
    }
    for (int i = K - 1; i >= 0; --i) {
        for (int j = i + 1; j < K; ++j) x[i] = less_product(f.lu(i, j), x[j], x[i]);
        x[i] = x[i] / f.lu(i, i);
    }
    return x;
}
/// Returns A^-T b.
template <class Real, int K>
CATENA_HD_APART Vector<Real, K> solve_transposed(LuFactor<Real, K> const& f, Vector<Real, K> b) {
    for (int i = 0; i < K; ++i) {
        for (int j = 0; j < i; ++j) b[i] = less_product(f.lu(j, i), b[j], b[i]);
        b[i] = b[i] / f.lu(i, i);
    }
    for (int i = K - 1; i >= 0; --i)
        for (int j = i + 1; j < K; ++j) b[i] = less_product(f.lu(j, i), b[j], b[i]);
    Vector<Real, K> x;
    for (int i = 0; i < K; ++i) x[static_cast<int>(f.row[i])] = b[i];
    return x;
}

/// Triangular form of a matrix under an orthonormal transformation of its leading `rows`
/// directions: orthogonal a = upper. `upper` is upper triangular in the columns order[0], order[1],
/// ..., `rank` of them, and 0 in the others. Householder reflections with column pivoting compute
/// it (Golub and Van Loan, Matrix Computations, 2013, section 5.4.2). Without `with_orthogonal`,
/// `orthogonal` stays the identity.
template <class Real, int K, int N>
struct Turned {
    Matrix<Real, K, K> orthogonal;
    Matrix<Real, K, N> upper;
    int order[N], rank;
};
/// Returns the triangular form of `a` with respect to its leading `rows` rows.
template <bool with_orthogonal = true, class Real, int K, int N>
CATENA_HD_APART Turned<Real, K, N> turned_to_upper(Matrix<Real, K, N> a, int rows) {
    using std::sqrt;
    Turned<Real, K, N> t{Matrix<Real, K, K>::identity(), Matrix<Real, K, N>::zero(), {}, 0};
    bool taken[N] = {};
    CATENA_NO_UNROLL
    for (int i = 0; i < rows; ++i) {
        int largest = 0;
        Real most(0);
        for (int j = 0; j < N; ++j) {
            Real size(0);
            for (int k = i; k < rows; ++k) size = fused(a(k, j), a(k, j), size);
            if (!taken[j] && size > most) largest = j, most = size;
        }
        if (!(most > Real(0))) break;
        taken[largest] = true;
        t.order[t.rank++] = largest;
        Real const length = a(i, largest) > Real(0) ? -sqrt(most) : sqrt(most);
        Vector<Real, K> v = Vector<Real, K>::zero();
        for (int k = i; k < rows; ++k) v[k] = a(k, largest);
        v[i] = v[i] - length;
        Real const scale = Real(2) / dot(v, v);
        auto const reflect = [&](auto& m, int j) {
            Real const along = scale * dot(v, m.column(j));
            for (int k = i; k < rows; ++k) m(k, j) = less_product(along, v[k], m(k, j));
        };
        if constexpr (with_orthogonal)
            for (int j = 0; j < K; ++j) reflect(t.orthogonal, j);
        for (int j = 0; j < N; ++j)
            if (!taken[j]) reflect(a, j);
        a(i, largest) = length;
        for (int k = i + 1; k < rows; ++k) a(k, largest) = Real(0);
    }
    for (int k = 0; k < t.rank; ++k)
        for (int j = 0; j < N; ++j) t.upper(k, j) = a(k, j);
    return t;
}

/// Ratio of the terms of two formulas from which on the formula with the smaller terms is used.
/// Below it, both are equally accurate.
inline constexpr double far_larger = 64;

/// Returns a power of two within a factor of two of 1 / sqrt(x), or 1 if x is not a positive finite
/// number. Scaling by it causes no rounding.
template <class Real>
CATENA_HD Real unit_of(Real x) {
    using std::frexp;
    using std::ldexp;
    int exponent = 0;
    if (!(x > Real(0) && x - x == Real(0))) return Real(1);
    frexp(x, &exponent);
    return ldexp(Real(1), -(exponent / 2));
}

/// Two runs that meet at the outboard run's first joint, in scaled and rotated directions of that
/// joint. Each direction is first scaled so that the outboard run's inertia along it is about 1;
/// otherwise lengths and angles would be mixed in arbitrary units. Then the directions are rotated.
template <class Real, int K>
struct ArticulatedJoint {
    // Transformations of accelerations and forces to these directions.
    Matrix<Real, K, K> motion, force;
    Matrix<Real, K, K> tip;    // Matrix `tip` of the inboard run.
    LuFactor<Real, K> factor;  // Factorization of 1 + mobility inertia.
    // Mobility of the inboard run's handle 2, `tip` included, and inertia of the outboard run.
    Symmetric<Real, K> mobility, inertia;
    Matrix<Real, K, K> inboard, outboard;  // Matrices `carry` of the inboard and the outboard run.
};
/// Acceleration of the joint's inboard side and the joint's force in the transformed directions, if
/// the ends of the merged run contribute nothing.
template <class Real, int K>
struct ArticulatedOffset {
    Vector<Real, K> acceleration, force;
};
/// State of a joint in the outward pass: acceleration of its inboard side and its force on the
/// outboard body.
template <class Real, int K>
struct HandleState {
    Vector<Real, K> acceleration, force;
};

/// Returns a + (m + m^T) / 2.
template <class Real, int K>
CATENA_HD Symmetric<Real, K> plus_symmetric_part(Symmetric<Real, K> a,
                                                 Matrix<Real, K, K> const& m) {
    for (int i = 0; i < K; ++i)
        for (int j = 0; j <= i; ++j) a(i, j) = a(i, j) + Real(0.5) * (m(i, j) + m(j, i));
    return a;
}

/// Returns r with r r^T = s, by Cholesky factorization with diagonal pivoting. Precondition: s is
/// positive semidefinite up to rounding. The remainder is dropped when no positive diagonal entry
/// is left.
template <class Real, int K>
CATENA_HD_APART Matrix<Real, K, K> root_of(Symmetric<Real, K> s) {
    using std::sqrt;
    auto r = Matrix<Real, K, K>::zero();
    bool done[K] = {};
    CATENA_NO_UNROLL
    for (int c = 0; c < K; ++c) {
        int largest = 0;
        Real most(0);
        for (int i = 0; i < K; ++i)
            if (!done[i] && s(i, i) > most) largest = i, most = s(i, i);
        if (!(most > Real(0))) break;
        done[largest] = true;
        Real const pivot = sqrt(most);
        for (int i = 0; i < K; ++i)
            if (!done[i] || i == largest) r(i, c) = i == largest ? pivot : s(i, largest) / pivot;
        for (int i = 0; i < K; ++i)
            for (int j = 0; j <= i; ++j)
                if (!done[i] && !done[j]) s(i, j) = less_product(r(i, c), r(j, c), s(i, j));
    }
    return r;
}

/// Returns r with r r^T = a a^T + b b^T.
template <class Real, int K>
CATENA_HD_APART Matrix<Real, K, K> root_of_sum(Matrix<Real, K, K> const& a,
                                               Matrix<Real, K, K> const& b) {
    Matrix<Real, 2 * K, K> both;
    for (int i = 0; i < K; ++i)
        for (int j = 0; j < K; ++j) {
            both(j, i) = a(i, j);
            both(K + j, i) = b(i, j);
        }
    Turned<Real, 2 * K, K> const turned = turned_to_upper<false>(both, 2 * K);
    Matrix<Real, K, K> r;
    for (int i = 0; i < K; ++i)
        for (int j = 0; j < K; ++j) r(i, j) = turned.upper(j, i);
    return r;
}

/// Merges two runs at a joint with `restricted` restricted directions. Returns the matrices of the
/// merged run; `joint` gets what the biases and the outward pass need.
template <class Real, int K>
CATENA_HD_APART ArticulatedMatrix<Real, K> join(ArticulatedMatrix<Real, K> const& inboard,
                                                ArticulatedMatrix<Real, K> const& outboard,
                                                int restricted, ArticulatedJoint<Real, K>& joint) {
    using Square = Matrix<Real, K, K>;
    Matrix<Real, K, 2 * K> all;
    Vector<Real, K> unit;
    for (int i = 0; i < K; ++i) {
        unit[i] = i < restricted ? unit_of(outboard.inertia(i, i)) : Real(1);
        for (int j = 0; j < K; ++j) {
            all(i, j) = inboard.tip(i, j) / unit[i];
            all(i, K + j) = inboard.rest(i, j) / unit[i];
        }
    }
    Turned<Real, K, 2 * K> const turned = turned_to_upper(all, restricted);
    for (int i = 0; i < K; ++i)
        for (int j = 0; j < K; ++j) {
            joint.motion(i, j) = turned.orthogonal(i, j) / unit[j];
            joint.force(i, j) = turned.orthogonal(i, j) * unit[j];
            joint.tip(i, j) = turned.upper(i, j);
        }
    auto const none = Symmetric<Real, K>::zero();
    joint.inertia =
        plus_symmetric_part(none, joint.force * (full(outboard.inertia) * transpose(joint.force)));
    joint.mobility = plus_symmetric_part(none, turned.upper * transpose(turned.upper));
    joint.inboard = joint.motion * inboard.carry;
    joint.outboard = outboard.carry * transpose(joint.force);
    Square const mobility = full(joint.mobility), inertia = full(joint.inertia);
    Square across = mobility * inertia, carried, stiff, yielding;
    for (int i = 0; i < K; ++i) across(i, i) = Real(1) + across(i, i);
    joint.factor = lu_of(across);
    for (int j = 0; j < K; ++j) {
        carried.set_column(j, solve(joint.factor, joint.inboard.column(j)));
        stiff.set_column(j, solve_transposed(joint.factor, inertia.column(j)));
        yielding.set_column(j, solve(joint.factor, mobility.column(j)));
    }
    return {
        plus_symmetric_part(inboard.inertia,
                            transposed_times(joint.inboard, stiff * joint.inboard)),
        joint.outboard * carried, outboard.tip,
        root_of_sum(outboard.rest, joint.outboard * root_of(plus_symmetric_part(none, yielding)))};
}
/// Chooses between two formulas for the same vector, direction by direction: `second` where its
/// terms are far smaller (far_larger), otherwise `first`. Equally accurate results thus have the
/// bits of `first`.
template <class Real, int K>
CATENA_HD Vector<Real, K> by_smaller_terms(Vector<Real, K> first, Vector<Real, K> const& of_first,
                                           Vector<Real, K> const& second,
                                           Vector<Real, K> const& of_second) {
    for (int i = 0; i < K; ++i)
        if (Real(far_larger) * of_second[i] < of_first[i]) first[i] = second[i];
    return first;
}
/// Returns the joint's force if the ends of the merged run contribute nothing. `e` is the
/// acceleration of the inboard run at the joint while no force acts there, `p` the outboard run's
/// bias and `a` the acceleration found.
///
/// The formula by the factor keeps the digits of forces along the tip's direction. Inertia times
/// acceleration has smaller terms where a heavy run holds a mobile last body that accelerates
/// strongly. There the factor's terms are as large as if the body moved freely.
template <class Real, int K>
CATENA_HD_APART Vector<Real, K> force_at(ArticulatedJoint<Real, K> const& joint,
                                         Vector<Real, K> const& e, Vector<Real, K> const& p,
                                         Vector<Real, K> const& a) {
    using std::fabs;
    Matrix<Real, K, K> const& lu = joint.factor.lu;
    // Sizes of the terms; `of_factor` and `by_row` are those of the factor, in its own and in the
    // original row order.
    Vector<Real, K> of_sum, of_factor, by_row;
    for (int i = 0; i < K; ++i) {
        of_sum[i] = of_factor[i] = fabs(p[i]);
        for (int j = 0; j < K; ++j) {
            of_sum[i] = fused(fabs(joint.inertia(i, j)), fabs(a[j]), of_sum[i]);
            of_factor[i] = fused(fabs(joint.inertia(i, j)), fabs(e[j]), of_factor[i]);
        }
        for (int j = 0; j < i; ++j)
            of_factor[i] = fused(fabs(lu(j, i)), of_factor[j], of_factor[i]);
        of_factor[i] = of_factor[i] / fabs(lu(i, i));
    }
    for (int i = K - 1; i >= 0; --i) {
        for (int j = i + 1; j < K; ++j)
            of_factor[i] = fused(fabs(lu(j, i)), of_factor[j], of_factor[i]);
        by_row[static_cast<int>(joint.factor.row[i])] = of_factor[i];
    }
    return by_smaller_terms(solve_transposed(joint.factor, joint.inertia * e + p), by_row,
                            joint.inertia * a + p, of_sum);
}
/// Merges the biases of two runs at `joint`. `offset` gets what the outward pass needs.
template <class Real, int K>
CATENA_HD_APART ArticulatedBias<Real, K> join(ArticulatedBias<Real, K> const& inboard,
                                              ArticulatedBias<Real, K> const& outboard,
                                              ArticulatedJoint<Real, K> const& joint,
                                              ArticulatedOffset<Real, K>& offset) {
    Vector<Real, K> const e = joint.motion * inboard.e + joint.tip * inboard.w,
                          p = joint.force * outboard.p;
    offset.acceleration = solve(joint.factor, e - joint.mobility * p);
    offset.force = force_at(joint, e, p, offset.acceleration);
    return {inboard.p + transposed_times(joint.inboard, offset.force),
            joint.outboard * offset.acceleration + outboard.e, outboard.w};
}
/// Returns the joint's state from those at the merged run's two ends.
template <class Real, int K>
CATENA_HD_APART HandleState<Real, K> state_between(ArticulatedJoint<Real, K> const& joint,
                                                   ArticulatedOffset<Real, K> const& offset,
                                                   HandleState<Real, K> const& first,
                                                   HandleState<Real, K> const& next) {
    Vector<Real, K> const a1 = joint.inboard * first.acceleration,
                          f2 = transposed_times(joint.outboard, next.force);
    Vector<Real, K> const a = solve(joint.factor, a1 - joint.mobility * f2) + offset.acceleration;
    Vector<Real, K> const f =
        solve_transposed(joint.factor, joint.inertia * a1 + f2) + offset.force;
    return {transposed_times(joint.force, a), transposed_times(joint.motion, f)};
}

/// Released direction i of a body: row i of its inertia and column i of `carry` before the release.
/// `own` is inertia(i, i).
template <class Real>
struct ReleasedDirection {
    Vector<Real, 6> inertia, carry;
    Real own;
};
/// Releases direction i of a body's inboard joint: no force acts along it from here on.
/// Precondition: inertia(i, i) > 0.
template <class Real>
CATENA_HD_APART ReleasedDirection<Real> release(int i, ArticulatedMatrix<Real, 6>& body) {
    using std::sqrt;
    ReleasedDirection<Real> r{{}, body.carry.column(i), body.inertia(i, i)};
    for (int j = 0; j < 6; ++j) r.inertia[j] = body.inertia(i, j);
    for (int j = 0; j < 6; ++j) {
        Real const share = r.inertia[j] / r.own;
        for (int k = j; k < 6; ++k)
            body.inertia(k, j) =
                j == i || k == i ? Real(0) : less_product(r.inertia[k], share, body.inertia(k, j));
        for (int k = 0; k < 6; ++k)
            body.carry(k, j) = j == i ? Real(0) : less_product(r.carry[k], share, body.carry(k, j));
        body.tip(j, i) = r.carry[j] / sqrt(r.own);
    }
    return r;
}
/// Releases the same direction in the body's bias.
template <class Real>
CATENA_HD void release(int i, ReleasedDirection<Real> const& r, ArticulatedBias<Real, 6>& body) {
    using std::sqrt;
    Real const bias = body.p[i], rate = bias / r.own;
    for (int j = 0; j < 6; ++j)
        body.p[j] = j == i ? Real(0) : less_product(rate, r.inertia[j], body.p[j]);
    body.w[i] = -bias / sqrt(r.own);
}
/// Returns |linear parts| |linear parts| + |angular parts| |angular parts| of an acceleration and a
/// force. The value does not depend on the axes.
template <class Real>
CATENA_HD Real product_of_sizes(Vector<Real, 6> const& a, Vector<Real, 6> const& f) {
    using std::sqrt;
    Real sum(0);
    for (int part = 0; part < 6; part += 3) {
        Vector<Real, 3> const of_a{{a[part], a[part + 1], a[part + 2]}},
            of_f{{f[part], f[part + 1], f[part + 2]}};
        sum = fused(sqrt(dot(of_a, of_a)), sqrt(dot(of_f, of_f)), sum);
    }
    return sum;
}
/// Returns the accelerations of a body along the six directions of its inboard joint, from the
/// states of its two joints and the number of directions that each restricts. The free directions
/// of `body` and `bias` have been released; `released` holds them.
///
/// The contribution of a free direction follows from the force at handle 2 or from the acceleration
/// there. Only the acceleration determines a light body between heavy ones. In each direction the
/// formula with the smaller terms is used, because its roundings are smaller: `size` bounds those
/// of the force, `terms` over the pivot those of the acceleration. `terms` includes the largest
/// pivot's terms, whose roundings reach the other rows.
///
/// A force that is small along a joint's direction may consist of roundings of other directions.
/// Where `whole`, the size of its terms regardless of directions, is far larger, the acceleration
/// is used too.
template <class Real>
CATENA_HD_APART Vector<Real, 6> accelerations(ArticulatedMatrix<Real, 6> const& body,
                                              ArticulatedBias<Real, 6> const& bias,
                                              ReleasedDirection<Real> const* released,
                                              HandleState<Real, 6> const& inboard, int restricted,
                                              HandleState<Real, 6> const& outboard,
                                              int restricted_outboard) {
    using std::fabs;
    using std::sqrt;
    Vector<Real, 6> a = Vector<Real, 6>::zero(), z = bias.w, size = Vector<Real, 6>::zero(),
                    whole = Vector<Real, 6>::zero();
    for (int i = 0; i < restricted; ++i) a[i] = inboard.acceleration[i];
    for (int i = restricted; i < 6; ++i) {
        size[i] = fabs(bias.w[i]);
        for (int j = 0; j < 6; ++j) {
            z[i] = less_product(body.tip(j, i), outboard.force[j], z[i]);
            size[i] = fused(fabs(body.tip(j, i)), fabs(outboard.force[j]), size[i]);
        }
        whole[i] = product_of_sizes(body.tip.column(i), outboard.force);
    }
    Turned<Real, 6, 6> const turned = turned_to_upper(body.tip, restricted_outboard);
    Vector<Real, 6> const by_inboard = body.carry * a + bias.e;
    Vector<Real, 6> const rest = turned.orthogonal * (outboard.acceleration - by_inboard);
    for (int i = turned.rank - 1; i >= 0; --i) {
        int const at = turned.order[i];
        Real sum = rest[i], terms(0);
        for (int j = 0; j < 6; ++j) {
            if (j != at) sum = less_product(turned.upper(i, j), z[j], sum);
            if (j != at) terms = terms + fabs(turned.upper(i, j) * z[j]);
            if (j < restricted_outboard)
                terms = fused(fabs(turned.orthogonal(i, j)),
                              fabs(outboard.acceleration[j]) + fabs(by_inboard[j]), terms);
        }
        Real const pivot = turned.upper(i, at), found = sum / pivot;
        // The pivot's own rounding counts too.
        terms = fused(fabs(turned.upper(0, turned.order[0])), fabs(found), terms);
        if (terms < fabs(pivot) * size[at] || Real(far_larger) * terms < fabs(pivot) * whole[at])
            z[at] = found;
    }
    for (int i = restricted; i < 6; ++i) {
        Real along(0);
        for (int j = 0; j < i; ++j) along = fused(released[i].inertia[j], a[j], along);
        a[i] = z[i] / sqrt(released[i].own) - along / released[i].own;
    }
    return a;
}

}  // namespace catena::dca
