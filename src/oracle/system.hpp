// Dense linear system and its solution. Internal to the oracles.
#pragma once

#include <cmath>

#include "oracle/full_pivoting.hpp"
#include "oracle/joint.hpp"

namespace catena::oracle {

/// System matrix x = right.
template <class S>
struct System {
    explicit System(Index size)
        : matrix(Dense<S>::Zero(size, size)), right(Column<S>::Zero(size)) {}
    /// Adds a block to the matrix.
    void add(Index row, Index column, M3<S> const& m) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) matrix(row + i, column + j) += m(i, j);
    }
    /// Adds a block to the right-hand side.
    void add(Index row, V3<S> const& v) {
        for (int i = 0; i < 3; ++i) right[row + i] += v[i];
    }
    /// Adds a constraint of the acceleration at rows `motion` to `motion` + 2. Row `row` becomes
    /// sign `direction` . a, and its column the constraint's force along the direction.
    void add_constraint(Index motion, Index row, S sign, V3<S> const& direction) {
        for (int i = 0; i < 3; ++i) {
            matrix(motion + i, row) -= sign * direction[i];
            matrix(row, motion + i) += sign * direction[i];
        }
    }
    Dense<S> matrix;
    Column<S> right;
};

/// Returns a power of two near 1 / x; scaling by it causes no rounding errors.
template <class S>
S scale_of(S x) {
    int exponent = 0;
    std::frexp(static_cast<double>(x), &exponent);
    return S(std::ldexp(1.0, -exponent));
}

/// Solves a system by LU with full pivoting of the row-scaled matrix, and one step of iterative
/// refinement.
template <class S>
Column<S> solve(System<S> const& system) {
    Index const n = system.right.size();
    Column<S> scale(n), right = system.right;
    Dense<S> scaled_matrix = system.matrix;
    for (Index i = 0; i < n; ++i) {
        scale[i] = scale_of(S(system.matrix.row(i).cwiseAbs().maxCoeff()));
        scaled_matrix.row(i) *= scale[i];
        right[i] *= scale[i];
    }
    FullPivoting<S> const lu(scaled_matrix);
    Column<S> x = lu.solve(right);
    Column<S> rest = system.right;
    for (Index j = 0; j < n; ++j) rest -= system.matrix.col(j) * x[j];
    for (Index i = 0; i < n; ++i) rest[i] *= scale[i];
    x += lu.solve(rest);
    return x;
}

/// Components `row` to `row` + 2 of a solution.
template <class S>
V3<S> segment(Column<S> const& x, Index row) {
    return {{x[row], x[row + 1], x[row + 2]}};
}

/// Dense solver for chains of beads.
template <class S>
OracleResult<S> dense_beads(ChainSpec const& chain, Loads const& loads);
/// Dense solver for linked chains.
template <class S>
OracleResult<S> dense_linked(ChainSpec const& chain, Loads const& loads);

}  // namespace catena::oracle
