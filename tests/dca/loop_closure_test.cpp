// The joint that closes a chain last: what it determines, and what of the rest is least.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>

#include "dca/loop_closure.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

int constexpr K = 6;
using EigenMatrix = Eigen::Matrix<double, K, K>;

/// Of the given rank, with entries of very different sizes, as those of forces and torques are.
EigenMatrix random_matrix(std::uint64_t seed, int rank) {
    Random random(seed);
    EigenMatrix root = EigenMatrix::Zero();
    for (int i = 0; i < K; ++i)
        for (int j = 0; j < rank; ++j) root(i, j) = std::pow(10.0, i - 3) * random.uniform(-1, 1);
    return root * root.transpose();
}
Symmetric<double, K> symmetric(EigenMatrix const& m) {
    Symmetric<double, K> s;
    for (int i = 0; i < K; ++i)
        for (int j = 0; j <= i; ++j) s(i, j) = m(i, j);
    return s;
}
Vector<double, K> diagonal(EigenMatrix const& m) {
    Vector<double, K> d;
    for (int i = 0; i < K; ++i) d[i] = m(i, i);
    return d;
}
EigenMatrix as_eigen(Matrix<double, K, K> const& m) {
    return Eigen::Map<Eigen::Matrix<double, K, K, Eigen::RowMajor> const>(m.data);
}

TEST(Closure, spectra_are_those_of_another_solver) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        EigenMatrix m = random_matrix(seed, K);
        EigenMatrix const scale = m.diagonal().cwiseSqrt().cwiseInverse().asDiagonal();
        m = scale * m * scale;
        auto const found = dca::spectrum_of(symmetric(m));
        EigenMatrix const v = as_eigen(found.vectors);
        Eigen::Matrix<double, K, 1> values =
            Eigen::Map<Eigen::Matrix<double, K, 1> const>(found.values.data);
        EXPECT_LE((v * values.asDiagonal() * v.transpose() - m).norm(), 32 * 0x1p-52 * m.norm())
            << seed;
        EXPECT_LE((v.transpose() * v - EigenMatrix::Identity()).norm(), 32 * 0x1p-52) << seed;
        std::sort(values.data(), values.data() + K);
        Eigen::SelfAdjointEigenSolver<EigenMatrix> const exact(m);
        EXPECT_LE((values - exact.eigenvalues()).norm(), 32 * 0x1p-52 * m.norm()) << seed;
    }
}

/// Directions beyond the restricted ones take no part.
TEST(Closure, the_least_forces_are_those_of_the_pseudo_inverse) {
    for (std::uint64_t seed = 0; seed < 200; ++seed)
        for (int restricted = 2; restricted <= K; ++restricted) {
            int const rank = 1 + static_cast<int>(seed) % (restricted - 1);
            EigenMatrix const z = random_matrix(seed, rank);
            EigenMatrix scale = EigenMatrix::Zero();
            for (int i = 0; i < restricted; ++i) scale(i, i) = 1 / std::sqrt(z(i, i));
            Eigen::CompleteOrthogonalDecomposition<EigenMatrix> cod;
            cod.setThreshold(1e-10);
            cod.compute(scale * z * scale);
            EigenMatrix const expected = scale * cod.pseudoInverse() * scale;
            auto const closing = dca::closing_joint(symmetric(z), diagonal(z), restricted);
            ASSERT_TRUE(closing.has_least_norm) << seed << ", rank " << rank;
            EigenMatrix const unscaled = z.diagonal().cwiseSqrt().asDiagonal();
            EigenMatrix const error =
                unscaled * (as_eigen(closing.joint.inboard) - expected) * unscaled;
            double const condition = cod.pseudoInverse().norm();
            EXPECT_LE(error.norm(), 64 * 0x1p-52 * condition * condition)
                << seed << ", rank " << rank << " of " << restricted;
        }
}

TEST(Closure, regular_joints_are_factorised_as_all_others) {
    EigenMatrix const z =
        random_matrix(3, K) + EigenMatrix(random_matrix(3, K).diagonal().asDiagonal());
    auto const closing = dca::closing_joint(symmetric(z), diagonal(z), K);
    EXPECT_FALSE(closing.has_least_norm);
    auto const factor = dca::factorize(symmetric(z), K);
    for (int i = 0; i < Symmetric<double, K>::size; ++i)
        EXPECT_EQ(closing.joint.factor.data[i], factor.data[i]);
}

/// The chain itself prevents all motions that the joint would: it carries nothing. Of one direction
/// it may as well be that all digits were lost.
TEST(Closure, wholly_redundant_joints_have_a_pseudo_inverse_of_zero) {
    for (double const noise : {0.0, 1e-14, -1e-14})
        for (int restricted = 1; restricted <= K; ++restricted) {
            EigenMatrix const size = EigenMatrix::Identity();
            auto const closing =
                dca::closing_joint(symmetric(noise * size), diagonal(size), restricted);
            EXPECT_EQ(closing.has_least_norm, restricted > 1) << noise << ", " << restricted;
            EXPECT_EQ(as_eigen(closing.joint.inboard), EigenMatrix::Zero());
            for (double const number : closing.joint.factor.data) EXPECT_EQ(number, 0);
        }
}

TEST(Closure, numbers_that_are_not_finite_are_not_taken_for_redundant_ones) {
    double const none = std::numeric_limits<double>::quiet_NaN(),
                 infinite = std::numeric_limits<double>::infinity();
    EigenMatrix const size = EigenMatrix::Identity();
    for (double const number : {none, infinite}) {
        EXPECT_FALSE(dca::closing_joint(symmetric(number * EigenMatrix::Ones()), diagonal(size), K)
                         .has_least_norm);
        Symmetric<double, 1> z;
        z(0, 0) = number;
        EXPECT_FALSE(dca::closing_joint(z, Vector<double, 1>{{1}}, 1).has_least_norm);
    }
    EigenMatrix z = EigenMatrix::Zero();
    z(3, 1) = z(1, 3) = none;
    EXPECT_FALSE(dca::closing_joint(symmetric(z), diagonal(size), K).has_least_norm);
}

TEST(Closure, indefinite_matrices_are_not_taken_for_singular_ones) {
    EigenMatrix z = EigenMatrix::Identity();
    z(4, 4) = -0.1;
    auto const closing = dca::closing_joint(symmetric(z), diagonal(EigenMatrix::Identity()), K);
    EXPECT_FALSE(closing.has_least_norm);
    EXPECT_FALSE(closing.joint.factor(4, 4) > 0);
}

}  // namespace
}  // namespace catena::test
