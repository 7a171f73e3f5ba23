// Implements the LU decomposition with Eigen.
#include "oracle/full_pivoting.hpp"

#include <Eigen/LU>

namespace catena::oracle {

template <class S>
FullPivoting<S>::FullPivoting(Dense<S> const& matrix, std::optional<S> threshold) {
    auto const lu = std::make_shared<Eigen::FullPivLU<Dense<S>>>();
    if (threshold) lu->setThreshold(*threshold);
    lu->compute(matrix);
    lu_ = lu;
}

template <class S>
Column<S> FullPivoting<S>::solve(Column<S> const& right) const {
    return lu_->solve(right);
}

template class FullPivoting<double>;
template class FullPivoting<long double>;
template class FullPivoting<Quad>;

}  // namespace catena::oracle
