// Symmetric positive semidefinite systems of few unknowns, which may be singular.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace catena {

/// System A x = b whose rank follows from the eigenvalues of A. With D = diag(size), those of
/// D^-1/2 A D^-1/2 below 2^-33 count as 0: fewer than six of their digits would be significant.
class SemidefiniteSystem {
  public:
    /// Factorises `a`. `size` has the scale of each of its diagonal entries. Returns false if an
    /// eigenvalue is below -2^-33 or a number is not finite.
    bool factorize(Eigen::MatrixXd const& a, Eigen::VectorXd const& size);
    /// Returns the x with least x^T D x that satisfies the system as far as it can be satisfied.
    Eigen::VectorXd solve(Eigen::VectorXd const& b) const;
    Eigen::Index unknowns() const { return scale_.size(); }
    Eigen::Index rank() const { return rank_; }
    /// True if no eigenvalue counts as 0.
    bool is_regular() const { return rank_ == unknowns(); }
    /// Returns log det A. Precondition: is_regular().
    double log_determinant() const;

  private:
    bool take_spectrum(Eigen::MatrixXd const& scaled);

    /// D^-1/2.
    Eigen::VectorXd scale_;
    Eigen::Index rank_ = 0;
    /// Factor of the scaled matrix, of 1 at first, unless it may be singular; then its
    /// pseudo-inverse.
    Eigen::LDLT<Eigen::MatrixXd> factor_{Eigen::MatrixXd::Identity(1, 1)};
    Eigen::MatrixXd pseudo_inverse_;
    double log_determinant_ = 0;
};

}  // namespace catena
