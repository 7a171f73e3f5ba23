// LU decomposition with full pivoting, compiled once for every oracle scalar: its code is as long
// as that of an oracle. Internal to the oracles.
#pragma once

#include <memory>
#include <optional>

#include "oracle/eigen.hpp"

namespace catena::oracle {

/// LU decomposition of a square matrix with full pivoting. Copies share it.
template <class S>
class FullPivoting {
  public:
    FullPivoting() = default;
    /// Decomposes a matrix. Pivots below `threshold` times the largest one count as zero; by
    /// default those below the rounding error.
    explicit FullPivoting(Dense<S> const& matrix, std::optional<S> threshold = {});
    /// Returns a solution x of matrix x = right. Precondition: the object has a matrix.
    Column<S> solve(Column<S> const& right) const;

  private:
    std::shared_ptr<Eigen::FullPivLU<Dense<S>> const> lu_;
};

}  // namespace catena::oracle
