// Implements the factorisation by pivoted Cholesky factors or, where pivots are small, eigenvalues.
#include "math/semidefinite.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace catena {
namespace {

/// Scaled eigenvalue below which one counts as 0.
double constexpr least_eigenvalue = 0x1p-33;
/// Scaled pivot from which on all eigenvalues are far above that: pivots of the largest remaining
/// diagonal entry exceed the least eigenvalue by small factors only.
double constexpr large_pivot = 0x1p-20;

}  // namespace

bool SemidefiniteSystem::factorize(Eigen::MatrixXd const& a, Eigen::VectorXd const& size) {
    scale_ = size.cwiseSqrt().cwiseInverse();
    rank_ = scale_.size();
    log_determinant_ = 0;
    pseudo_inverse_.resize(0, 0);
    Eigen::MatrixXd const scaled = scale_.asDiagonal() * a * scale_.asDiagonal();
    if (!scaled.allFinite()) return false;
    factor_.compute(scaled);
    Eigen::VectorXd const pivots = factor_.vectorD();
    if (factor_.info() != Eigen::Success || !(pivots.minCoeff() >= large_pivot))
        return take_spectrum(scaled);
    log_determinant_ = pivots.array().log().sum();
    return true;
}

bool SemidefiniteSystem::take_spectrum(Eigen::MatrixXd const& scaled) {
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const eigen(scaled);
    Eigen::VectorXd inverse = eigen.eigenvalues();
    if (eigen.info() != Eigen::Success || inverse.minCoeff() < -least_eigenvalue) return false;
    for (double& value : inverse) {
        bool const counts = value >= least_eigenvalue;
        if (counts) log_determinant_ += std::log(value);
        rank_ -= counts ? 0 : 1;
        value = counts ? 1 / value : 0;
    }
    pseudo_inverse_ =
        eigen.eigenvectors() * inverse.asDiagonal() * eigen.eigenvectors().transpose();
    return true;
}

Eigen::VectorXd SemidefiniteSystem::solve(Eigen::VectorXd const& b) const {
    Eigen::VectorXd const scaled = scale_.cwiseProduct(b);
    return scale_.cwiseProduct(pseudo_inverse_.size() > 0
                                   ? Eigen::VectorXd(pseudo_inverse_ * scaled)
                                   : Eigen::VectorXd(factor_.solve(scaled)));
}

double SemidefiniteSystem::log_determinant() const {
    return log_determinant_ - 2 * scale_.array().log().sum();
}

}  // namespace catena
