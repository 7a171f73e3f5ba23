// The two operations of the divide-and-conquer algorithm, assembly and disassembly, host and
// device. Real = double, float, an extended or a SIMD type; K = number of directions per handle.
//
// At joint j the directions are ordered so that the first m(j) are the restricted ones (D of the
// chapter) and the others are free. Projected handles carry K = max m directions, full handles all
// of them (6; 3 for point beads). The operations are the same, because forces along free directions
// are known and are part of the biases (src/dca/README.md, "Projected handles").
#pragma once

#include "math/linear.hpp"

namespace catena::dca {

/// Mobility of a run of bodies between its two handles (chapter, eqs 2.8-2.9), projected on the
/// directions of the joints there:
///  a1 = z11 f1 + z12 f2 + b1,   a2 = z12^T f1 + z22 f2 + b2.
template <class Real, int K>
struct SegmentMatrix {
    Symmetric<Real, K> z11, z22;
    Matrix<Real, K, K> z12;
    /// The ground: zeta = 0.
    static CATENA_HD SegmentMatrix zero() {
        return {Symmetric<Real, K>::zero(), Symmetric<Real, K>::zero(), Matrix<Real, K, K>::zero()};
    }
};
/// Bias accelerations b1 and b2 of the two handles in the equations of SegmentMatrix.
template <class Real, int K>
struct SegmentBias {
    Vector<Real, K> b1, b2;
    static CATENA_HD SegmentBias zero() {
        return {Vector<Real, K>::zero(), Vector<Real, K>::zero()};
    }
};

/// Row i of a segment's matrices and biases. The rows of z11 and z22 end at the diagonal.
template <class Real, int K>
struct SegmentRow {
    Vector<Real, K> z11, z22, z12;
    Real b1, b2;
};

/// Matrices of an eliminated joint. Let Z = z22^A + z11^B on the restricted directions and Z = L S
/// L^T. Then inboard = L^-1 z21^A and outboard = L^-1 z12^B. `factor` is L below the diagonal and
/// S^-1 on it (0 in unrestricted rows).
template <class Real, int K>
struct JointMatrix {
    Symmetric<Real, K> factor;
    Matrix<Real, K, K> inboard, outboard;
};

/// Computes 1 / x.
struct Quotient {
    template <class Real>
    CATENA_HD Real operator()(Real const& x) const {
        return Real(1) / x;
    }
};
/// Returns Z = L S L^T on the leading `restricted` rows, stored as in JointMatrix::factor. The
/// other rows get S^-1 = 0, so that they do not contribute anywhere. Precondition: Z is positive
/// definite on the leading rows.
template <class Real, int K, class Inverse = Quotient>
CATENA_HD Symmetric<Real, K> factorize(Symmetric<Real, K> const& z, int restricted,
                                       Inverse const& inverse = {}) {
    Symmetric<Real, K> f;
    Real pivot[K];
    CATENA_UNROLL
    for (int i = 0; i < K; ++i) {
        bool const active = i < restricted;
        CATENA_UNROLL
        for (int j = 0; j < i; ++j) {
            Real s = z(i, j);
            CATENA_UNROLL
            for (int k = 0; k < j; ++k) s = less_product(f(i, k) * pivot[k], f(j, k), s);
            f(i, j) = active ? s * f(j, j) : Real(0);
        }
        Real s = z(i, i);
        CATENA_UNROLL
        for (int k = 0; k < i; ++k) s = less_product(f(i, k) * pivot[k], f(i, k), s);
        pivot[i] = active ? s : Real(0);
        f(i, i) = active ? inverse(s) : Real(0);
    }
    return f;
}

/// Default factorizer, with exact reciprocals. Leaves and sweeps have the factorizer as a
/// parameter, so that faster ones that may fail can replace it.
struct Factorizer {
    static constexpr bool may_fail = false;
    /// Returns result(inverse), where inverse(x) = 1 / x. Other factorizers may call `result` again
    /// with another `inverse`.
    template <class Result>
    CATENA_HD auto with_inverse(Result const& result) const {
        return result(Quotient{});
    }
    template <class Real, int K>
    CATENA_HD Symmetric<Real, K> operator()(Symmetric<Real, K> const& z, int restricted) const {
        return factorize(z, restricted);
    }
};

/// Returns L^-1 b.
template <class Real, int K>
CATENA_HD Vector<Real, K> solve_lower(Symmetric<Real, K> const& f, Vector<Real, K> b) {
    CATENA_UNROLL
    for (int i = 1; i < K; ++i) {
        CATENA_UNROLL
        for (int j = 0; j < i; ++j) b[i] = less_product(f(i, j), b[j], b[i]);
    }
    return b;
}

/// Returns L^-1 B, column by column.
template <class Real, int K>
CATENA_HD Matrix<Real, K, K> solve_lower(Symmetric<Real, K> const& f, Matrix<Real, K, K> b) {
    CATENA_UNROLL
    for (int i = 1; i < K; ++i) {
        CATENA_UNROLL
        for (int j = 0; j < i; ++j) {
            CATENA_UNROLL
            for (int c = 0; c < K; ++c) b(i, c) = less_product(f(i, j), b(j, c), b(i, c));
        }
    }
    return b;
}

/// Returns S^-1 y.
template <class Real, int K>
CATENA_HD Vector<Real, K> scaled(Symmetric<Real, K> const& f, Vector<Real, K> y) {
    CATENA_UNROLL
    for (int i = 0; i < K; ++i) y[i] = f(i, i) * y[i];
    return y;
}

/// Returns L^-T S^-1 y.
template <class Real, int K>
CATENA_HD Vector<Real, K> solve_upper(Symmetric<Real, K> const& f, Vector<Real, K> y) {
    y = scaled(f, y);
    CATENA_UNROLL
    for (int i = K - 1; i > 0; --i) {
        CATENA_UNROLL
        for (int j = 0; j < i; ++j) y[j] = less_product(f(i, j), y[i], y[j]);
    }
    return y;
}

/// Returns z - a.b.
template <class Real, int K>
CATENA_HD Real less_products(Real z, Vector<Real, K> const& a, Vector<Real, K> const& b) {
    CATENA_UNROLL
    for (int k = 0; k < K; ++k) z = less_product(a[k], b[k], z);
    return z;
}
/// Returns z - m^T S^-1 m.
template <class Real, int K>
CATENA_HD Symmetric<Real, K> less_square(Symmetric<Real, K> const& z, Matrix<Real, K, K> const& m,
                                         Symmetric<Real, K> const& factor) {
    Symmetric<Real, K> s;
    CATENA_UNROLL
    // One column at a time, because the operands of a column fit the registers.
    for (int j = 0; j < K; ++j) {
        Vector<Real, K> const of_column = scaled(factor, m.column(j));
        CATENA_UNROLL
        for (int i = j; i < K; ++i) s(i, j) = less_products(z(i, j), m.column(i), of_column);
    }
    return s;
}
/// Joins `outboard` to `segment` at a joint with `restricted` restricted directions
/// (src/dca/README.md, "Assembly and disassembly", with W = D (D^T Z D)^-1 D^T). Precondition: z22
/// of `segment` + z11 of `outboard` is positive definite on these directions.
template <class Real, int K, class Factorizer = dca::Factorizer>
CATENA_HD void append(SegmentMatrix<Real, K>& segment, SegmentMatrix<Real, K> const& outboard,
                      int restricted, JointMatrix<Real, K>& joint, Factorizer const& factors = {}) {
    joint.factor = factors(segment.z22 + outboard.z11, restricted);
    joint.inboard = solve_lower(joint.factor, transpose(segment.z12));
    joint.outboard = solve_lower(joint.factor, outboard.z12);
    CATENA_UNROLL
    // The two products of a column are computed together, otherwise as in less_square().
    for (int j = 0; j < K; ++j) {
        Vector<Real, K> const of_column = scaled(joint.factor, joint.outboard.column(j));
        CATENA_UNROLL
        for (int i = j; i < K; ++i)
            segment.z22(i, j) =
                less_products(outboard.z22(i, j), joint.outboard.column(i), of_column);
        segment.z12.set_column(j, transposed_times(joint.inboard, of_column));
    }
    segment.z11 = less_square(segment.z11, joint.inboard, joint.factor);
}
/// Joins the biases at the same joint. `offset` keeps L^-1 (b2 - b1 of `outboard`) for the
/// disassembly (Y of the chapter).
template <class Real, int K>
CATENA_HD void append(SegmentBias<Real, K>& segment, SegmentBias<Real, K> const& outboard,
                      JointMatrix<Real, K> const& joint, Vector<Real, K>& offset) {
    offset = solve_lower(joint.factor, segment.b2 - outboard.b1);
    Vector<Real, K> const y = scaled(joint.factor, offset);
    segment.b1 = segment.b1 - transposed_times(joint.inboard, y);
    segment.b2 = outboard.b2 + transposed_times(joint.outboard, y);
}
/// Returns the merged segment's matrices.
template <class Real, int K>
CATENA_HD SegmentMatrix<Real, K> assemble(SegmentMatrix<Real, K> inboard,
                                          SegmentMatrix<Real, K> const& outboard, int restricted,
                                          JointMatrix<Real, K>& joint) {
    append(inboard, outboard, restricted, joint);
    return inboard;
}
/// Returns the merged segment's biases.
template <class Real, int K>
CATENA_HD SegmentBias<Real, K> assemble(SegmentBias<Real, K> inboard,
                                        SegmentBias<Real, K> const& outboard,
                                        JointMatrix<Real, K> const& joint,
                                        Vector<Real, K>& offset) {
    append(inboard, outboard, joint, offset);
    return inboard;
}

/// Returns the joint force on the outboard body (chapter, eq 2.12) from the forces at the merged
/// segment's own two joints. `first` acts on its first body, `next` on the body that follows its
/// last one (so that f1 = first, f2 = -next).
template <class Real, int K>
CATENA_HD Vector<Real, K> disassemble(JointMatrix<Real, K> const& joint,
                                      Vector<Real, K> const& offset, Vector<Real, K> const& first,
                                      Vector<Real, K> const& next) {
    return solve_upper(joint.factor, joint.inboard * first + (joint.outboard * next + offset));
}

/// Recursion of the joint forces in a run whose first force is known: phi = gain phi_next + offset.
template <class Real, int K>
struct Elimination {
    Matrix<Real, K, K> gain;
    Vector<Real, K> offset;
};

/// Matrices of a joint that is eliminated from one side: outboard = L^-1 z12^B, with the outboard
/// segment's biases.
template <class Real, int K>
struct OneSided {
    Symmetric<Real, K> factor;
    Matrix<Real, K, K> outboard;
    SegmentBias<Real, K> bias;
};
/// Returns `gain` of a joint's Elimination.
template <class Real, int K>
CATENA_HD Matrix<Real, K, K> gain(OneSided<Real, K> const& joint) {
    Matrix<Real, K, K> g;
    CATENA_UNROLL
    for (int j = 0; j < K; ++j)
        g.set_column(j, solve_upper(joint.factor, joint.outboard.column(j)));
    return g;
}
/// Returns `offset` of a joint's Elimination, given the force on the first body. Updates `b2` from
/// the segment so far to the merged segment.
template <class Real, int K>
CATENA_HD Vector<Real, K> pass_bias(Vector<Real, K>& b2, OneSided<Real, K> const& joint) {
    Vector<Real, K> const offset = solve_lower(joint.factor, b2 - joint.bias.b1);
    CATENA_UNROLL
    for (int i = 0; i < K; ++i) {
        Real b = joint.bias.b2[i];
        CATENA_UNROLL
        for (int k = 0; k < K; ++k)
            b = fused(joint.factor(k, k) * offset[k], joint.outboard(k, i), b);
        b2[i] = b;
    }
    return solve_upper(joint.factor, offset);
}
/// Returns the Elimination of a joint and updates `b2` as pass_bias() does.
template <class Real, int K>
CATENA_HD Elimination<Real, K> pass(Vector<Real, K>& b2, OneSided<Real, K> const& joint) {
    Vector<Real, K> const offset = pass_bias(b2, joint);
    return {gain(joint), offset};
}
/// Eliminates a joint from one side, where the force on the first body is known. Only handle 2 of
/// the segment so far matters: `z22`, and `b2` with that force's contribution. Both are updated to
/// the merged segment's.
template <class Real, int K, class Factorizer = dca::Factorizer>
CATENA_HD Elimination<Real, K> eliminate(Symmetric<Real, K>& z22, Vector<Real, K>& b2,
                                         SegmentMatrix<Real, K> const& outboard,
                                         SegmentBias<Real, K> const& bias, int restricted,
                                         Factorizer const& factors = {}) {
    OneSided<Real, K> joint;
    joint.factor = factors(z22 + outboard.z11, restricted);
    joint.outboard = solve_lower(joint.factor, outboard.z12);
    joint.bias = bias;
    CATENA_UNROLL
    for (int i = 0; i < K; ++i) {
        CATENA_UNROLL
        for (int j = 0; j <= i; ++j) {
            Real z = outboard.z22(i, j);
            CATENA_UNROLL
            for (int k = 0; k < K; ++k)
                z = less_product(joint.outboard(k, i), joint.factor(k, k) * joint.outboard(k, j),
                                 z);
            z22(i, j) = z;
        }
    }
    return pass(b2, joint);
}

}  // namespace catena::dca
