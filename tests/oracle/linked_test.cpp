// Rigid bodies and beads on links, and links to the ground at the tip: the solvers against each
// other and against mechanics.
#include <gtest/gtest.h>

#include "tests/oracle/compare.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using oracle::Quad;

/// Every pair of ends in turn. A chain on fixed ends needs three beads, or it can be stretched
/// straight.
Case random_case(std::uint64_t seed, std::size_t largest, bool linked) {
    Random random(4'000'000 + seed);
    Base const base = seed % 2 == 0 ? Base::fixed : Base::free;
    Tip const tip = seed / 2 % 2 == 0 ? Tip::free : Tip::jointed;
    std::size_t const n =
        1 + static_cast<std::size_t>(random.uniform() * static_cast<double>(largest));
    Case c;
    c.chain =
        linked ? random_linked_chain(seed, n, base, tip) : random_bead_chain(seed, n, base, tip);
    c.loads.gravity = random.vector(10);
    c.loads.linear_drag = random.uniform(0, 1);
    c.loads.angular_drag = random.uniform(0, 0.1);
    if (linked)
        c.loads.wrenches = random_wrenches(seed, n);
    else
        c.loads.bead_forces = random_forces(seed, n);
    return c;
}

template <class S>
void compare(int count, std::size_t largest, bool linked) {
    solvers_agree<S>(count, 16,
                     [&](std::uint64_t seed) { return random_case(seed, largest, linked); });
}
TEST(Linked, SolversAgree) { compare<double>(400, 12, true); }
TEST(Linked, SolversAgreeIn113Bits) { compare<Quad>(24, 6, true); }
TEST(Linked, BeadsWithTipsAgree) { compare<double>(400, 20, false); }
TEST(Linked, BeadsWithTipsAgreeIn113Bits) { compare<Quad>(24, 8, false); }

std::optional<Case> ring_of_beads(std::uint64_t seed) {
    std::size_t const n = 3 + seed % 18;
    return Case{closed(random_bead_chain(seed, n, Base::free)),
                {Random(seed).vector(10), random_forces(seed, n)}};
}
TEST(Linked, RingsOfBeadsAgree) {
    solvers_agree<double>(100, 16, ring_of_beads, [](Case const& c) {
        auto const a = oracle::aba<double>(c.chain, c.loads).com_acceleration;
        double const bound =
            16 * static_cast<double>(c.chain.size()) * 0x1p-52 * growth(c.chain, c.loads);
        ASSERT_LE(oracle::rnea_residual(c.chain, c.loads, a), bound);
    });
}

/// Inverse dynamics accept the beads' accelerations, whatever holds their ends.
TEST(Linked, BeadResidualWithTip) {
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Case const c = random_case(seed, 20, false);
        auto a = oracle::aba<double>(c.chain, c.loads).com_acceleration;
        EXPECT_LE(oracle::rnea_residual(c.chain, c.loads, a),
                  16 * static_cast<double>(c.chain.size()) * 0x1p-52 * growth(c.chain, c.loads))
            << seed;
        if (a.size() < 3) continue;
        a[a.size() / 2] = a[a.size() / 2] + Vec3{{1e-3, 2e-3, -1e-3}};
        EXPECT_GT(oracle::rnea_residual(c.chain, c.loads, a), 1e-7) << seed;
    }
}

/// A linked chain of beads alone is a bead chain.
TEST(Linked, BeadsAreBeads) {
    for (Base const base : {Base::fixed, Base::free})
        for (Tip const tip : {Tip::free, Tip::jointed}) {
            ChainSpec const beads = random_bead_chain(7, 9, base, tip);
            ChainSpec linked = beads;
            linked.beads = {};
            LinkedArrays& l = linked.linked;
            l.mass = beads.beads.mass;
            l.position = beads.beads.position;
            l.velocity = beads.beads.velocity;
            l.anchor = beads.beads.anchor;
            l.inertia.assign(9, Sym3::zero());
            l.orientation.assign(9, {1, 0, 0, 0});
            l.omega.assign(9, Vec3::zero());
            l.inboard = l.outboard = l.omega;
            oracle::Loads const loads{{{1, -2, -9}}, {}};
            auto const a = oracle::aba<double>(beads, loads),
                       b = oracle::aba<double>(linked, loads);
            double const allowed = 16 * 9 * 0x1p-52 * growth(beads, loads);
            EXPECT_LE(relative_difference(b.com_acceleration, a.com_acceleration), allowed);
            EXPECT_LE(norm(b.tip_force.force - a.tip_force.force),
                      allowed * (1 + norm(a.tip_force.force)));
            double const condition = oracle::condition_estimate(beads);
            EXPECT_NEAR(oracle::condition_estimate(linked) / condition, 1, 9 * 0x1p-52 * condition);
        }
}

/// The chain a time h later, to second order.
ChainSpec moved_linked(ChainSpec chain, oracle::OracleResult<double> const& a, double h) {
    auto const k = oracle::kinematics<double>(chain, {});
    LinkedArrays& l = chain.linked;
    for (std::size_t i = 0; i < l.size(); ++i) {
        l.position[i] = l.position[i] + h * (l.velocity[i] + (0.5 * h) * a.com_acceleration[i]);
        l.velocity[i] = l.velocity[i] + h * a.com_acceleration[i];
        Vec3 const alpha =
            transposed_times(k.orientation[i], a.alpha[i]);  // d/dt of omega's components in B
        auto const& q = l.orientation[i];
        Quat const turned = normalized(Quat{q[0], q[1], q[2], q[3]} *
                                       from_rotation_vector(h * (l.omega[i] + (0.5 * h) * alpha)));
        l.orientation[i] = {turned.w, turned.x, turned.y, turned.z};
        l.omega[i] = l.omega[i] + h * alpha;
    }
    return chain;
}
std::vector<double> lengths(ChainSpec const& chain) {
    LinkedArrays const& l = chain.linked;
    auto const k = oracle::kinematics<double>(chain, {});
    std::vector<double> all;
    for (std::size_t i = 0; i <= l.size(); ++i) {
        if ((i == 0 && chain.base == Base::free) || (i == l.size() && chain.tip == Tip::free))
            continue;
        Vec3 const from =
            i == 0 ? l.anchor : Vec3(l.position[i - 1] + k.orientation[i - 1] * l.outboard[i - 1]);
        Vec3 const to = i == l.size() ? *chain.tip_joint.anchor
                                      : Vec3(l.position[i] + k.orientation[i] * l.inboard[i]);
        all.push_back(norm(to - from));
    }
    return all;
}

TEST(Linked, LinksKeepTheirLengthsAndEnergyItsBalance) {
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        Case const c = random_case(seed, 7, true);
        auto const a = oracle::aba<double>(c.chain, c.loads);
        auto const now = lengths(c.chain);
        auto const opening = [&](double h) {
            return second_derivative(lengths(moved_linked(c.chain, a, -h)), now,
                                     lengths(moved_linked(c.chain, a, h)), h);
        };
        double const h = 2e-4, coarse = opening(h), fine = opening(h / 2),
                     size = 1 + largest(a.com_acceleration) + largest(a.alpha);
        EXPECT_LT(coarse, 0.02 * size) << seed;
        EXPECT_LE(fine, coarse / 3 + 16 * 0x1p-52 / (h * h / 4)) << seed;

        auto const k = oracle::kinematics<double>(c.chain, c.loads);
        double power = 0;
        for (std::size_t i = 0; i < c.chain.size(); ++i) {
            auto const& [torque, force] = c.loads.wrenches[i];
            power += dot(force - c.loads.linear_drag * k.com_velocity[i], k.com_velocity[i]);
            if (!c.chain.linked.is_bead(i))
                power += dot(torque - c.loads.angular_drag * k.omega[i], k.omega[i]);
        }
        auto const energy = [&](double by) {
            auto const at = oracle::kinematics<double>(moved_linked(c.chain, a, by), c.loads);
            return at.kinetic_energy + at.potential_energy;
        };
        auto const error = [&](double by) {
            return std::abs((energy(by) - energy(-by)) / (2 * by) - power);
        };
        EXPECT_LT(error(1e-3), 0.02 * (1 + std::abs(power)) * size) << seed;
        EXPECT_LE(error(5e-4), error(1e-3) / 3 + 1e-9 * (1 + std::abs(power))) << seed;
    }
}

/// A rod held by a link at each end, hanging symmetrically: the links carry half its weight each.
TEST(Linked, HangingRod) {
    ChainSpec chain;
    chain.base = Base::fixed;
    chain.tip = Tip::jointed;
    LinkedArrays& l = chain.linked;
    l.mass = {3};
    l.inertia = {{{0.1, 0, 0.2, 0, 0, 0.2}}};
    l.position = {{{0, 0, -2}}};
    l.velocity = l.omega = {Vec3::zero()};
    l.orientation = {{1, 0, 0, 0}};
    l.inboard = {{{-0.5, 0, 0}}};
    l.outboard = {{{0.5, 0, 0}}};
    l.length = {2};
    l.anchor = {{-0.5, 0, 0}};
    chain.tip_joint.type = JointType::link;
    chain.tip_joint.anchor = Vec3{{0.5, 0, 0}};
    auto const r = oracle::aba<double>(chain, {{{0, 0, -10}}, {}});
    EXPECT_NEAR(r.tension[0], 15, 1e-14);
    EXPECT_LE(norm(r.tip_force.force - Vec3{{0, 0, 15}}), 1e-14);
    EXPECT_LE(norm(r.com_acceleration[0]), 1e-14);
    EXPECT_LE(norm(r.alpha[0]), 1e-14);
}

}  // namespace
}  // namespace catena::test
