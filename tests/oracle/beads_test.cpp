// Point beads on rigid links: the two solvers against each other, Newton's law, and cases done by
// hand.
#include <gtest/gtest.h>

#include "tests/oracle/compare.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using oracle::Quad;

template <class S>
void compare(int count, double largest) {
    Agreement<S> agreement;
    for (int seed = 0; seed < count; ++seed) {
        auto const s = static_cast<std::uint64_t>(seed);
        auto const n = static_cast<std::size_t>(std::pow(largest + 0.99, Random(s + 77).uniform()));
        ChainSpec const chain = random_bead_chain(s, n, seed % 2 == 0 ? Base::fixed : Base::free);
        ASSERT_LE(agreement.add(chain, {Random(s).vector(10), random_forces(s + 9, n)}), 16)
            << "seed " << seed << ", " << n << " beads";
    }
    agreement.print();
    EXPECT_GT(agreement.error(), 0.0);
}
TEST(Beads, SolversAgree) { compare<double>(400, 60); }
TEST(Beads, SolversAgreeInLongDouble) { compare<long double>(60, 30); }
TEST(Beads, SolversAgreeIn113Bits) { compare<Quad>(24, 12); }

/// m a = F + m g + T_k+1 u_k+1 - T_k u_k, and the links keep their lengths to second order in time.
TEST(Beads, NewtonAndLengths) {
    for (Base const base : {Base::fixed, Base::free})
        for (std::size_t const n : {1U, 2U, 3U, 15U, 16U, 17U, 100U}) {
            ChainSpec const chain = random_bead_chain(n, n, base);
            BeadArrays const& b = chain.beads;
            oracle::Loads const loads{{{1, 2, -9}}, random_forces(n, n)};
            auto const r = oracle::aba<double>(chain, loads);
            double const allowed =
                4 * static_cast<double>(n) * 0x1p-52 * oracle::condition_estimate(chain);
            auto const along = [&](std::size_t k) {
                return b.position[k] - (k == 0 ? b.anchor : b.position[k - 1]);
            };
            auto const relative = [&](std::vector<Vec3> const& v, std::size_t k) {
                return k == 0 ? v[0] : v[k] - v[k - 1];
            };
            for (std::size_t k = 0; k < n; ++k) {
                Vec3 const applied = loads.bead_forces[k] + b.mass[k] * loads.gravity,
                           inertial = b.mass[k] * r.com_acceleration[k];
                Vec3 rest = inertial - applied;
                double size = norm(inertial) + norm(applied);
                if (k > 0 || base == Base::fixed) {
                    rest = plus_scaled(rest, r.tension[k] / norm(along(k)), along(k));
                    size += std::abs(r.tension[k]);
                    double const speed = dot(relative(b.velocity, k), relative(b.velocity, k));
                    double const pull = dot(along(k), relative(r.com_acceleration, k));
                    double const terms =
                        speed + norm(along(k)) * (norm(r.com_acceleration[k]) +
                                                  (k > 0 ? norm(r.com_acceleration[k - 1]) : 0));
                    EXPECT_LE(std::abs(speed + pull), allowed * terms)
                        << "link " << k + 1 << " of " << n;
                } else {
                    EXPECT_EQ(r.tension[0], 0.0);
                }
                if (k + 1 < n) {
                    rest = plus_scaled(rest, -r.tension[k + 1] / norm(along(k + 1)), along(k + 1));
                    size += std::abs(r.tension[k + 1]);
                }
                EXPECT_LE(norm(rest), allowed * size) << "bead " << k + 1 << " of " << n;
            }
            double const residual = oracle::rnea_residual(chain, loads, r.com_acceleration);
            EXPECT_LE(residual, allowed);
            std::vector<Vec3> changed = r.com_acceleration;
            changed[n / 2] = changed[n / 2] + Vec3{{1e-3, 2e-3, -1e-3}};
            EXPECT_GT(oracle::rnea_residual(chain, loads, changed), 1e-6);
        }
}

ChainSpec beads(Base base, std::vector<Vec3> const& positions,
                std::vector<Vec3> const& velocities) {
    ChainSpec chain;
    chain.base = base;
    for (std::size_t k = 0; k < positions.size(); ++k) {
        chain.beads.mass.push_back(2);
        chain.beads.length.push_back(1);
    }
    chain.beads.position = positions;
    chain.beads.velocity = velocities;
    return chain;
}

/// Four equal beads hanging at rest: the links carry what hangs below them.
TEST(Beads, HangingChainCarriesItsWeight) {
    ChainSpec const chain =
        beads(Base::fixed, {{{0, 0, -1}}, {{0, 0, -2}}, {{0, 0, -3}}, {{0, 0, -4}}},
              std::vector<Vec3>(4, Vec3::zero()));
    auto const r = oracle::aba<double>(chain, {{{0, 0, -10}}, {}});
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_NEAR(r.tension[k], 2 * 10.0 * static_cast<double>(4 - k), 1e-12);
        EXPECT_LE(norm(r.com_acceleration[k]), 1e-13);
    }
    auto const k = oracle::kinematics<double>(chain, {{{0, 0, -10}}, {}});
    EXPECT_EQ(k.potential_energy, -2 * 10.0 * (1 + 2 + 3 + 4));
    EXPECT_EQ(k.kinetic_energy, 0.0);
}

/// Two equal beads circling each other with speed v at distance 1: each is held by m v^2 / (1/2).
TEST(Beads, DumbbellTurnsUnderTension) {
    auto const r = oracle::aba<double>(
        beads(Base::free, {{{0, 0, 0}}, {{1, 0, 0}}}, {{{0, -3, 0}}, {{0, 3, 0}}}), {});
    EXPECT_NEAR(r.tension[1], 2 * 9 / 0.5, 1e-13);
    EXPECT_LE(norm(r.com_acceleration[0] - Vec3{{18, 0, 0}}), 1e-13);
    EXPECT_LE(norm(r.com_acceleration[1] + Vec3{{18, 0, 0}}), 1e-13);
}

/// A free chain falls together, its links slack.
TEST(Beads, FreeChainAtRestFallsTogether) {
    ChainSpec chain = random_bead_chain(12, 30, Base::free);
    for (Vec3& v : chain.beads.velocity) v = Vec3::zero();
    Vec3 const gravity{{3, 0, -9}};
    auto const r = oracle::aba<double>(chain, {gravity, {}});
    double const allowed = 4 * 30 * 0x1p-52 * oracle::condition_estimate(chain) * norm(gravity);
    for (std::size_t k = 0; k < 30; ++k) {
        EXPECT_LE(norm(r.com_acceleration[k] - gravity), allowed);
        EXPECT_LE(std::abs(r.tension[k]), allowed);
    }
}

}  // namespace
}  // namespace catena::test
