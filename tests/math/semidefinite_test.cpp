// Semidefinite systems: solutions, ranks, least norms and refusals.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "math/semidefinite.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

/// A random matrix of n unknowns and that rank, with the scales 1e-3 to 1e3.
Eigen::MatrixXd matrix_of(Random& random, Eigen::Index n, Eigen::Index rank) {
    Eigen::MatrixXd factor(n, rank);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < rank; ++j) factor(i, j) = random.uniform(-1, 1);
    for (Eigen::Index i = 0; i < n; ++i) factor.row(i) *= std::pow(10, random.uniform(-3, 3));
    return factor * factor.transpose();
}

TEST(Semidefinite, RegularSystemsAreSolved) {
    Random random(1);
    for (Eigen::Index n = 1; n <= 20; ++n) {
        Eigen::MatrixXd a = matrix_of(random, n, n + 4);
        Eigen::VectorXd const x = Eigen::VectorXd::LinSpaced(n, 1, 2);
        SemidefiniteSystem system;
        ASSERT_TRUE(system.factorize(a, a.diagonal()));
        EXPECT_TRUE(system.is_regular());
        Eigen::VectorXd const off = a * system.solve(a * x) - a * x;
        EXPECT_LE(off.norm(), 1e-9 * (a * x).norm());
        EXPECT_NEAR(system.log_determinant(), std::log(a.fullPivLu().determinant()), 1e-6);
    }
}

TEST(Semidefinite, SingularOnesHaveTheirRankAndLeastSolutions) {
    Random random(2);
    for (Eigen::Index n = 2; n <= 12; ++n)
        for (Eigen::Index rank = 1; rank < n; ++rank) {
            Eigen::MatrixXd const a = matrix_of(random, n, rank);
            Eigen::VectorXd const size = 2 * a.diagonal();
            SemidefiniteSystem system;
            ASSERT_TRUE(system.factorize(a, size));
            ASSERT_EQ(system.rank(), rank);
            EXPECT_FALSE(system.is_regular());
            Eigen::VectorXd const b = a * Eigen::VectorXd::Ones(n), x = system.solve(b);
            EXPECT_LE((a * x - b).cwiseQuotient(size.cwiseSqrt()).norm(),
                      1e-7 * b.cwiseQuotient(size.cwiseSqrt()).norm());
            // Of all solutions x + null space that with the least x^T D x.
            Eigen::VectorXd const root = size.cwiseSqrt(), one_over = root.cwiseInverse();
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> const eigen(
                Eigen::MatrixXd(one_over.asDiagonal() * a * one_over.asDiagonal()));
            Eigen::VectorXd const scaled = root.cwiseProduct(x);
            for (Eigen::Index i = 0; i < n - rank; ++i)
                EXPECT_NEAR(eigen.eigenvectors().col(i).dot(scaled), 0, 1e-9 * scaled.norm());
        }
}

TEST(Semidefinite, IndefiniteMatricesAndOthersThatAreNoneAreRefused) {
    SemidefiniteSystem system;
    Eigen::MatrixXd a(2, 2);
    a << 1, 2, 2, 1;
    EXPECT_FALSE(system.factorize(a, Eigen::VectorXd::Ones(2)));
    a << 1, 0, 0, std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(system.factorize(a, Eigen::VectorXd::Ones(2)));
}

TEST(Semidefinite, AZeroMatrixRestrictsNothing) {
    SemidefiniteSystem system;
    ASSERT_TRUE(system.factorize(Eigen::MatrixXd::Zero(3, 3), Eigen::VectorXd::Ones(3)));
    EXPECT_EQ(system.rank(), 0);
    EXPECT_EQ(system.solve(Eigen::VectorXd::Ones(3)).norm(), 0);
}

}  // namespace
}  // namespace catena::test
