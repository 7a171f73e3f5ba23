// Runs of revolute bodies joined one to the other are what their inertias make of them; and these
// satisfy all bodies' equations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "dca/floating_run.hpp"

namespace catena::dca {
namespace {

using Body = ArticulatedBody<double>;

/// In memory of its own.
struct KeptRevolutes {
    std::vector<ReleasedRevolute<double>> revolutes;
    std::vector<BodyInRun<double>> bodies;
    std::vector<BodyAcceleration<double>> swings;
    RunsEnd<double> at_end;
    Mat3 last_axes;

    explicit KeptRevolutes(std::size_t n) : revolutes(n), bodies(n), swings(n) {}
    void put(int i, ReleasedRevolute<double> const& revolute) {
        revolutes[static_cast<std::size_t>(i)] = revolute;
    }
    void put(int i, ReleasedRevolute<double> const& revolute, BodyInRun<double> const& body,
             BodyAcceleration<double> const& velocity_bias) {
        put(i, revolute);
        bodies[static_cast<std::size_t>(i)] = body;
        swings[static_cast<std::size_t>(i)] = velocity_bias;
    }
    void put(RunsEnd<double> const& end) { at_end = end; }
    void put_axes(Mat3 const& axes) { last_axes = axes; }
    ReleasedRevolute<double> const& revolute(int i) const {
        return revolutes[static_cast<std::size_t>(i)];
    }
    BodyInRun<double> const& body(int i) const { return bodies[static_cast<std::size_t>(i)]; }
    BodyAcceleration<double> const& velocity_bias(int i) const {
        return swings[static_cast<std::size_t>(i)];
    }
    RunsEnd<double> const& end() const { return at_end; }
    Mat3 const& axes() const { return last_axes; }
};
template <class Torque>
BiasedSegment<double, 5> climb(std::vector<Body> const& b, Torque const& torque,
                               KeptRevolutes& kept) {
    auto const body = [&](int i) { return b[static_cast<std::size_t>(i)]; };
    return climb_revolutes<double>(static_cast<int>(b.size()),
                                   BodiesOfRun<double, decltype(body)>(body), torque, kept);
}
BiasedSegment<double, 5> climb(std::vector<Body> const& b, KeptRevolutes& kept) {
    return climb(b, [](int) { return Undriven{}; }, kept);
}

struct Draw {
    std::mt19937_64 engine;
    double operator()(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(engine);
    }
    Vec3 vector(double most) {
        return {{(*this)(-most, most), (*this)(-most, most), (*this)(-most, most)}};
    }
    Mat3 axes() {
        Vec3 const v = vector(1);
        return to_matrix(normalized(Quat{(*this)(-1, 1), v[0], v[1], v[2]}));
    }
};

std::vector<Body> bodies(int n, unsigned seed) {
    Draw draw{std::mt19937_64(seed)};
    std::vector<Body> all;
    for (int k = 0; k < n; ++k) {
        Body b{};
        b.mass = std::exp(draw(-2, 2));
        Mat3 const own = draw.axes();
        auto principal = Sym3::zero();
        for (int i = 0; i < 3; ++i) principal(i, i) = b.mass * draw(0.05, 0.2);
        b.inertia = turned(own, principal);
        b.r1 = draw.vector(1), b.r2 = draw.vector(1);
        b.e1 = draw.axes(), b.e2 = draw.axes();
        b.torque = draw.vector(3), b.force = draw.vector(3);
        b.inward1 = draw.vector(2), b.inward2 = draw.vector(2);
        for (int i = 0; i < 5; ++i) b.bias[i] = draw(-1, 1);
        all.push_back(b);
    }
    return all;
}

Sym3 inverse_of(Sym3 const& a) {
    Sym3 inverse;
    Sym3 const factor = factorize(a, 3);
    for (int j = 0; j < 3; ++j) {
        Vec3 unit = Vec3::zero();
        unit[j] = 1;
        Vec3 const column = solve_upper(factor, solve_lower(factor, unit));
        for (int i = j; i < 3; ++i) inverse(i, j) = column[i];
    }
    return inverse;
}

BiasedSegment<double, 5> segment_of_body(Body const& b) {
    Sym3 const inverse = inverse_of(b.inertia);
    auto const h1 = b.handle1(), h2 = b.handle2();
    Vec3 const alpha = inverse * b.torque, a = (1 / b.mass) * b.force;
    BiasedSegment<double, 5> s{leaf_matrix(1 / b.mass, inverse, h1, h2),
                               {along(h1, alpha, a + b.inward1), along(h2, alpha, a + b.inward2)}};
    s.bias.b1 = s.bias.b1 + b.bias;
    return s;
}

/// Largest difference over the largest number.
class Difference {
  public:
    void add(double a, double b) {
        difference_ = std::max(difference_, std::abs(a - b));
        largest_ = std::max({largest_, std::abs(a), std::abs(b)});
    }
    double value() const { return difference_ / largest_; }

  private:
    double difference_ = 0, largest_ = 0;
};

/// n joinings of matrices whose condition is some hundreds.
double tolerance(int n) { return 4096 * n * 0x1p-53; }

class InertiaRuns : public ::testing::TestWithParam<int> {};

TEST_P(InertiaRuns, AreTheSegmentsOfTheirBodies) {
    int const n = GetParam();
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::vector<Body> const b = bodies(n, seed);
        BiasedSegment<double, 5> joined = segment_of_body(b[0]);
        for (std::size_t k = 1; k < b.size(); ++k) {
            auto const next = segment_of_body(b[k]);
            JointMatrix<double, 5> joint;
            Vector<double, 5> offset;
            append(joined.matrix, next.matrix, 5, joint);
            append(joined.bias, next.bias, joint, offset);
        }
        KeptRevolutes kept(b.size());
        auto const [matrix, bias] = climb(b, kept);
        Difference z11, z22, z12, biases;
        for (int i = 0; i < 5; ++i) {
            for (int j = 0; j < 5; ++j) {
                z11.add(matrix.z11(i, j), joined.matrix.z11(i, j));
                z22.add(matrix.z22(i, j), joined.matrix.z22(i, j));
                z12.add(matrix.z12(i, j), joined.matrix.z12(i, j));
            }
            biases.add(bias.b1[i], joined.bias.b1[i]);
            biases.add(bias.b2[i], joined.bias.b2[i]);
        }
        EXPECT_LE(z11.value(), tolerance(n)) << seed;
        EXPECT_LE(z22.value(), tolerance(n)) << seed;
        EXPECT_LE(biases.value(), tolerance(n)) << seed;
        if (n < 4) {
            EXPECT_LE(z12.value(), tolerance(n)) << seed;
        }
    }
}

/// They satisfy every body's equations and every joint's, the revolute joints apart; at the ends
/// they are what the segment says.
TEST_P(InertiaRuns, GiveTheirBodiesAccelerations) {
    int const n = GetParam();
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::vector<Body> const b = bodies(n, seed);
        Draw draw{std::mt19937_64(seed + 100)};
        Vector<double, 5> first, next;
        for (int i = 0; i < 5; ++i) first[i] = draw(-2, 2), next[i] = draw(-2, 2);
        KeptRevolutes kept(b.size());
        climb(b, kept);
        std::vector<BodyAcceleration<double>> a(b.size());
        std::vector<double> about_revolute(b.size());
        Vector<double, 5> inboard = next;
        descend_revolutes<double>(
            n, true, [&](int i) -> RevoluteFrame<double> { return b[static_cast<std::size_t>(i)]; },
            kept, first, next,
            [&](int i, RevoluteFrame<double> const&, BodyAcceleration<double> const& of_body) {
                a[static_cast<std::size_t>(i)] = of_body;
                inboard = inboard_force(b[static_cast<std::size_t>(i)], of_body, inboard);
            },
            [](int, BodyAcceleration<double>&) {},
            [&](int i, double of_revolute) {
                about_revolute[static_cast<std::size_t>(i)] = of_revolute;
            });

        Difference begins;
        for (int i = 0; i < 5; ++i) begins.add(inboard[i], first[i]);
        EXPECT_LE(begins.value(), tolerance(n)) << seed;
        Vec3 torque = moment(b[0].handle1(), first),
             force = push(b[0].handle1(), first);  // by the inboard joint, about the body's centre
        Difference joints, revolutes, last;
        double largest = 0, off = 0;
        for (std::size_t k = 0; k < b.size(); ++k) {
            largest =
                std::max({largest, norm(torque), norm(force), norm(b[k].torque), norm(b[k].force)});
            Vec3 const force_out = (force + b[k].force) - b[k].mass * a[k].a;
            Vec3 const torque_out = (torque + b[k].torque) - b[k].inertia * a[k].alpha -
                                    cross(b[k].r2, force_out);  // about handle 2
            Vec3 const along_force = transposed_times(b[k].e2, force_out),
                       along_torque = transposed_times(b[k].e2, torque_out);
            if (k + 1 == b.size()) {
                for (int i = 0; i < 3; ++i) last.add(along_force[i], next[i]);
                for (int i = 0; i < 2; ++i) last.add(along_torque[i], next[3 + i]);
            } else {
                off = std::max(off, std::abs(along_torque[2]));
                force = b[k + 1].e1 * along_force;
                torque = b[k + 1].e1 * along_torque + cross(b[k + 1].r1, force);
                auto const in = along(b[k].handle2(), a[k].alpha, a[k].a + b[k].inward2);
                auto const out =
                    along(b[k + 1].handle1(), a[k + 1].alpha, a[k + 1].a + b[k + 1].inward1) +
                    b[k + 1].bias;
                for (int i = 0; i < 5; ++i) joints.add(in[i], out[i]);
                double const before = dot(b[k].e2.column(2), a[k].alpha),
                             after = dot(b[k + 1].e1.column(2), a[k + 1].alpha);
                revolutes.add(before + about_revolute[k + 1], after);
            }
        }
        EXPECT_LE(joints.value(), tolerance(n)) << seed;
        EXPECT_LE(revolutes.value(), tolerance(n)) << seed;
        EXPECT_LE(off / largest, tolerance(n)) << seed;  // no torque about a revolute joint
        EXPECT_LE(last.value(), tolerance(n) * std::max(1.0, largest)) << seed;
    }
}

/// A revolute joint's torque is what its two bodies' torques would say.
TEST_P(InertiaRuns, TakeRevolutesTorques) {
    int const n = GetParam();
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::vector<Body> const b = bodies(n, seed);
        Draw draw{std::mt19937_64(seed + 200)};
        std::vector<double> torque(b.size());
        std::vector<Body> pushed = b;
        for (std::size_t k = 1; k < b.size(); ++k) {
            torque[k] = draw(-3, 3);
            pushed[k].torque = pushed[k].torque + torque[k] * b[k].e1.column(2);
            pushed[k - 1].torque = pushed[k - 1].torque - torque[k] * b[k - 1].e2.column(2);
        }
        KeptRevolutes expected(b.size()), found(b.size());
        auto const of_pushed = climb(pushed, expected).bias;
        auto const driven =
            climb(b, [&](int i) { return torque[static_cast<std::size_t>(i)]; }, found).bias;
        Difference biases, revolutes;
        for (int i = 0; i < 5; ++i) {
            biases.add(driven.b1[i], of_pushed.b1[i]);
            biases.add(driven.b2[i], of_pushed.b2[i]);
        }
        for (std::size_t k = 1; k < b.size(); ++k)
            revolutes.add(found.revolutes[k].bias, expected.revolutes[k].bias);
        for (int i = 0; i < 6; ++i) revolutes.add(found.at_end.bias[i], expected.at_end.bias[i]);
        EXPECT_LE(biases.value(), tolerance(n)) << seed;
        EXPECT_LE(revolutes.value(), tolerance(n)) << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Bodies, InertiaRuns, ::testing::Values(2, 3, 4, 16, 32));

}  // namespace
}  // namespace catena::dca
