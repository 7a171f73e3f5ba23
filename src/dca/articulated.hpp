// Articulated handles: bodies and runs of them with the joint they hang on, held at its inboard
// side and free at handle 2, host and device.
//
// Mobilities (segment.hpp) belong to runs that float: where a light body hangs between heavy ones,
// or revolute joints are nearly parallel, what two of them have in common is large and cancels when
// they are joined. Here the inboard side is held, as in the articulated-body algorithm
// (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 7.3), and runs are joined by sums of
// positive semidefinite matrices (Redheffer's star product; in estimation Sarkka and
// Garcia-Fernandez, IEEE Trans. Autom. Control 66, 2021, Lemma 8). A light last body makes handle 2
// mobile out of all proportion along what its joint leaves free: that part is kept apart, and each
// joint's directions are turned until it lies along the first of them, so that it hides nothing.
#pragma once

#include "dca/segment.hpp"

namespace catena::dca {

/// A run from its first joint's inboard side, which has acceleration a1 there, to handle 2 of its
/// last body, on which force f2 acts:
///   f1 = inertia a1 - carry^T f2 + p,   a2 = carry a1 + (tip tip^T + rest rest^T) f2 + e + tip w,
/// f1 the force of the first joint on the run. `tip`: by the last body's own joint; `rest`: by the
/// others. Along the directions of the joints; what the first joint does not restrict of `inertia`
/// and `carry` is 0.
template <class Real, int K>
struct ArticulatedMatrix {
    Symmetric<Real, K> inertia;
    Matrix<Real, K, K> carry, tip, rest;
};
template <class Real, int K>
struct ArticulatedBias {
    Vector<Real, K> p, e, w;
};

/// A = P^-1 L U with partial pivoting, L and U in one matrix. (Products with an inverse would lose
/// what pivoting keeps.)
template <class Real, int K>
struct LuFactor {
    Matrix<Real, K, K> lu;
    Vector<Real, K> row;  // row i of P A is row[i] of A
};
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
/// A^-1 b
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
/// A^-T b
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

/// Orthonormal `turn` of the leading `rows` directions for which turn a = upper is upper triangular
/// in columns order[0], order[1], ..., `rank` of them, and 0 in the others: by Householder's
/// reflections, each of the largest column that is left (Golub and Van Loan, Matrix Computations,
/// 2013, section 5.4.2). Not `with_turn`: `turn` stays 1.
template <class Real, int K, int N>
struct Turned {
    Matrix<Real, K, K> turn;
    Matrix<Real, K, N> upper;
    int order[N], rank;
};
template <bool with_turn = true, class Real, int K, int N>
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
        if constexpr (with_turn)
            for (int j = 0; j < K; ++j) reflect(t.turn, j);
        for (int j = 0; j < N; ++j)
            if (!taken[j]) reflect(a, j);
        a(i, largest) = length;
        for (int k = i + 1; k < rows; ++k) a(k, largest) = Real(0);
    }
    for (int k = 0; k < t.rank; ++k)
        for (int j = 0; j < N; ++j) t.upper(k, j) = a(k, j);
    return t;
}

/// How many times the terms of another formula a formula's must be for the other one to be taken:
/// below, both are as good.
inline constexpr double far_larger = 64;

/// A power of two within a factor of two of 1 / sqrt(x), or 1 where x is no positive finite number:
/// scaling by it is free of rounding.
template <class Real>
CATENA_HD Real unit_of(Real x) {
    using std::frexp;
    using std::ldexp;
    int exponent = 0;
    if (!(x > Real(0) && x - x == Real(0))) return Real(1);
    frexp(x, &exponent);
    return ldexp(Real(1), -(exponent / 2));
}

/// Two runs that meet at the outboard one's first joint, in directions of its own: each of the
/// joint's in a unit in which the outboard run's inertia is about 1 (lengths and angles must not be
/// mixed as they come), then turned.
template <class Real, int K>
struct ArticulatedJoint {
    Matrix<Real, K, K> motion, force;  // of accelerations and forces to these directions
    Matrix<Real, K, K> tip;            // of the inboard run
    LuFactor<Real, K> factor;          // of 1 + mobility inertia
    Symmetric<Real, K> mobility,
        inertia;  // of the inboard run's handle 2, tip and all; of the outboard run
    Matrix<Real, K, K> inboard, outboard;  // their `carry`
};
/// Acceleration of the joint's inboard side and its force where none comes from the joined run's
/// ends, turned.
template <class Real, int K>
struct ArticulatedOffset {
    Vector<Real, K> acceleration, force;
};
/// What is known at a joint on the way down: acceleration of its inboard side and its force on the
/// outboard body.
template <class Real, int K>
struct HandleState {
    Vector<Real, K> acceleration, force;
};

/// a + s, s the symmetric part of m.
template <class Real, int K>
CATENA_HD Symmetric<Real, K> plus_symmetric_part(Symmetric<Real, K> a,
                                                 Matrix<Real, K, K> const& m) {
    for (int i = 0; i < K; ++i)
        for (int j = 0; j <= i; ++j) a(i, j) = a(i, j) + Real(0.5) * (m(i, j) + m(j, i));
    return a;
}

/// r with r r^T = s, by Cholesky's factorisation from the largest entry on the diagonal down.
/// Precondition: s positive semidefinite, to rounding; what is left when none is above 0 is taken
/// for that.
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

/// r with r r^T = a a^T + b b^T
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

/// The joined run.
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
            joint.motion(i, j) = turned.turn(i, j) / unit[j];
            joint.force(i, j) = turned.turn(i, j) * unit[j];
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
/// Forces of two formulas for one vector, direction by direction: `second` where its terms are far
/// smaller. Where both are alike the bits are those of `first`.
template <class Real, int K>
CATENA_HD Vector<Real, K> by_smaller_terms(Vector<Real, K> first, Vector<Real, K> const& of_first,
                                           Vector<Real, K> const& second,
                                           Vector<Real, K> const& of_second) {
    for (int i = 0; i < K; ++i)
        if (Real(far_larger) * of_second[i] < of_first[i]) first[i] = second[i];
    return first;
}
/// The joint's force where none comes from the joined run's ends, from what is apart there, `e`,
/// the outboard run's `p` and the acceleration `a` found. By the factor forces along the tip's
/// direction keep their digits; inertia times acceleration has smaller terms where a mobile last
/// body, accelerated by much, is held by a heavy run: there the factor's are as large as if the
/// body moved freely.
template <class Real, int K>
CATENA_HD_APART Vector<Real, K> force_at(ArticulatedJoint<Real, K> const& joint,
                                         Vector<Real, K> const& e, Vector<Real, K> const& p,
                                         Vector<Real, K> const& a) {
    using std::fabs;
    Matrix<Real, K, K> const& lu = joint.factor.lu;
    Vector<Real, K> of_sum, of_factor,
        by_row;  // sizes of the terms; of_factor: in rows of the factor
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
/// The joint's state from those at the joined run's two ends.
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

/// Direction i of a body, released: its row of the inertia and its column of `carry` before.
template <class Real>
struct ReleasedDirection {
    Vector<Real, 6> inertia, carry;
    Real own;
};
/// Of a body that was held in direction i of its inboard joint: no force acts along it from here
/// on. Precondition: inertia(i, i) > 0.
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
template <class Real>
CATENA_HD void release(int i, ReleasedDirection<Real> const& r, ArticulatedBias<Real, 6>& body) {
    using std::sqrt;
    Real const bias = body.p[i], rate = bias / r.own;
    for (int j = 0; j < 6; ++j)
        body.p[j] = j == i ? Real(0) : less_product(rate, r.inertia[j], body.p[j]);
    body.w[i] = -bias / sqrt(r.own);
}
/// |linear parts| |linear parts| + |angular parts| |angular parts|: of an acceleration and a force,
/// whatever the axes.
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
/// Accelerations of a body along the six directions of its inboard joint, from the states of its
/// two joints and how many directions either restricts. `body`, `bias`: with its free directions
/// released, which `released` holds. What these contribute is found from the force at handle 2 or
/// from the acceleration there: a light body between heavy ones is told by the latter alone. Taken
/// is, direction by direction, whichever has the smaller terms for the roundings to go by: `size`
/// those of the force, `terms` over the pivot those of the acceleration, with the largest pivot's,
/// whose roundings the others carry. A force that is small along a direction of the joint may be
/// what other directions' roundings left of it: where `whole`, its terms in no particular
/// directions, is far larger, the acceleration is taken too.
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
    Vector<Real, 6> const rest = turned.turn * (outboard.acceleration - by_inboard);
    for (int i = turned.rank - 1; i >= 0; --i) {
        int const at = turned.order[i];
        Real sum = rest[i], terms(0);
        for (int j = 0; j < 6; ++j) {
            if (j != at) sum = less_product(turned.upper(i, j), z[j], sum);
            if (j != at) terms = terms + fabs(turned.upper(i, j) * z[j]);
            if (j < restricted_outboard)
                terms = fused(fabs(turned.turn(i, j)),
                              fabs(outboard.acceleration[j]) + fabs(by_inboard[j]), terms);
        }
        Real const pivot = turned.upper(i, at), found = sum / pivot;
        terms = fused(fabs(turned.upper(0, turned.order[0])), fabs(found),
                      terms);  // the pivot's own rounding
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
