// The two operations against a dense elimination, for every block size and every number of
// restricted directions.
#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "dca/segment.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::dca {
namespace {

template <int K>
struct Random {
    using Dense = Eigen::Matrix<double, 2 * K, 2 * K>;
    /// A random symmetric positive definite 2K x 2K matrix as a segment.
    static SegmentMatrix<double, K> segment(test::Random& random) {
        Dense a;
        for (int i = 0; i < 2 * K; ++i)
            for (int j = 0; j < 2 * K; ++j) a(i, j) = random.uniform(-1, 1);
        Dense const spd = a * a.transpose() + 0.3 * Dense::Identity();
        SegmentMatrix<double, K> s;
        for (int i = 0; i < K; ++i)
            for (int j = 0; j < K; ++j) {
                if (j <= i) {
                    s.z11(i, j) = spd(i, j);
                    s.z22(i, j) = spd(K + i, K + j);
                }
                s.z12(i, j) = spd(i, K + j);
            }
        return s;
    }
    static Vector<double, K> vector(test::Random& random) {
        Vector<double, K> v;
        for (int i = 0; i < K; ++i) v[i] = random.uniform(-1, 1);
        return v;
    }
};

/// Given forces at the outer handles, the closing of the restricted directions decides the joint
/// force; both sides' handle accelerations then follow from eqs 2.1-2.4 and must be the joined
/// segment's (eqs 2.8-2.9).
template <int K>
void check(int restricted, std::uint64_t seed) {
    test::Random random(seed);
    auto const a = Random<K>::segment(random), b = Random<K>::segment(random);
    SegmentBias<double, K> const ba{Random<K>::vector(random), Random<K>::vector(random)},
        bb{Random<K>::vector(random), Random<K>::vector(random)};
    JointMatrix<double, K> joint;
    Vector<double, K> offset;
    auto const s = assemble(a, b, restricted, joint);
    auto const bias = assemble(ba, bb, joint, offset);
    Vector<double, K> const first = Random<K>::vector(random), next = Random<K>::vector(random),
                            f2 = -next;
    Vector<double, K> const force = disassemble(joint, offset, first, next);

    double const tolerance =
        100 * K * K * 0x1p-53 / 0.3;  // rounding of K^2 products over the smallest eigenvalue
    Vector<double, K> const a1 = full(a.z11) * first - a.z12 * force + ba.b1;
    Vector<double, K> const inner_a = transposed_times(a.z12, first) - full(a.z22) * force + ba.b2;
    Vector<double, K> const inner_b = full(b.z11) * force + b.z12 * f2 + bb.b1;
    Vector<double, K> const a2 = transposed_times(b.z12, force) + full(b.z22) * f2 + bb.b2;
    Vector<double, K> const joined1 = full(s.z11) * first + s.z12 * f2 + bias.b1;
    Vector<double, K> const joined2 = transposed_times(s.z12, first) + full(s.z22) * f2 + bias.b2;
    for (int i = 0; i < K; ++i) {
        if (i < restricted)
            EXPECT_NEAR(inner_a[i], inner_b[i], tolerance * 10);
        else
            EXPECT_EQ(force[i], 0.0);
        EXPECT_NEAR(joined1[i], a1[i], tolerance * 10);
        EXPECT_NEAR(joined2[i], a2[i], tolerance * 10);
    }
}

template <int K>
void check_all() {
    for (int restricted = 0; restricted <= K; ++restricted)
        for (std::uint64_t seed = 1; seed <= 50; ++seed) check<K>(restricted, seed);
}

TEST(Segment, JoinedSegmentBehavesAsItsTwoParts) {
    check_all<1>();
    check_all<2>();
    check_all<3>();
    check_all<4>();
    check_all<5>();
    check_all<6>();
}

}  // namespace
}  // namespace catena::dca
