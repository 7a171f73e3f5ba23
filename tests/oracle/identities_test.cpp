// Mechanics that any right answer obeys, whatever the algorithm: balances of the whole chain,
// power, joint forces.
#include <gtest/gtest.h>

#include "tests/oracle/compare.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using oracle::Kinematics;
using oracle::OracleResult;

/// A sum together with the sum of its terms' sizes, against which rounding is measured.
struct Sum {
    Vec3 value = Vec3::zero();
    double size = 0;
    void add(Vec3 const& v) {
        value = value + v;
        size += norm(v);
    }
    void add(double x) { add(Vec3{{x, 0, 0}}); }
    double relative() const { return size > 0 ? norm(value) / size : 0; }
};

struct Solved {
    ChainSpec chain;
    oracle::Loads loads;
    Kinematics<double> at;
    OracleResult<double> found;
    Mat3 inertia(std::size_t k) const {  // W
        return at.orientation[k] * (full(chain.bodies.inertia[k]) * transpose(at.orientation[k]));
    }
};
Solved solve(ChainSpec const& chain, Vec3 const& gravity) {
    oracle::Loads const loads{gravity, {}};
    return {chain, loads, oracle::kinematics<double>(chain, loads),
            oracle::aba<double>(chain, loads)};
}
/// c n eps cond: the accelerations' own error (agreement_test.cpp) carried into a sum over the
/// bodies.
double allowed(ChainSpec const& chain) {
    return 4 * static_cast<double>(chain.size()) * 0x1p-52 * oracle::condition_estimate(chain);
}

std::vector<ChainSpec> chains(Base base, bool springs) {
    std::vector<ChainSpec> all;
    std::uint64_t seed = 100;
    for (std::size_t const n : {1, 2, 3, 7, 8, 9, 20})
        for (RandomJoints const joints :
             {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::mixed})
            all.push_back(random_chain(
                ++seed, {.bodies = n, .joints = joints, .base = base, .springs = springs}));
    return all;
}
Vec3 const gravity{{1, -2, -9}};

TEST(Identities, AFreeChainAtRestFallsTogether) {
    for (RandomJoints const joints :
         {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::mixed}) {
        Solved const s = solve(random_chain(5, {.bodies = 12,
                                                .joints = joints,
                                                .base = Base::free,
                                                .moving = false,
                                                .loaded = false}),
                               gravity);
        double const tolerance = allowed(s.chain) * norm(gravity);
        EXPECT_LE(norm(s.found.base_acceleration - gravity), tolerance);
        for (std::size_t k = 0; k < 12; ++k) {
            EXPECT_LE(norm(s.found.com_acceleration[k] - gravity), tolerance) << k;
            EXPECT_LE(norm(s.found.qdd[k]), tolerance) << k;
            EXPECT_LE(norm(s.found.joint_force[k].force), tolerance) << k;
        }
    }
}

/// Momentum and angular momentum (about the ground's origin) of a free chain change by the external
/// loads alone.
TEST(Identities, AFreeChainObeysTheBalancesOfTheWhole) {
    for (bool const springs : {false, true})
        for (ChainSpec const& chain : chains(Base::free, springs)) {
            Solved const s = solve(chain, gravity);
            Sum force, moment;
            for (std::size_t k = 0; k < chain.size(); ++k) {
                double const mass = chain.bodies.mass[k];
                auto const& [torque, push] = chain.bodies.wrench[k];
                Vec3 const &x = s.at.com_position[k], &w = s.at.omega[k];
                Vec3 const inertial = mass * s.found.com_acceleration[k],
                           external = push + mass * gravity;
                force.add(inertial);
                force.add(-external);
                moment.add(s.inertia(k) * s.found.alpha[k]);
                moment.add(cross(w, s.inertia(k) * w));
                moment.add(cross(x, inertial));
                moment.add(-cross(x, external));
                moment.add(-torque);
            }
            EXPECT_LE(force.relative(), allowed(chain)) << chain.size();
            EXPECT_LE(moment.relative(), allowed(chain)) << chain.size();
        }
}

/// Newton and Euler of each body with the reported joint forces: forces hold the chain together,
/// both at one joint.
TEST(Identities, JointForcesBalanceEveryBody) {
    for (Base const base : {Base::fixed, Base::free})
        for (ChainSpec const& chain : chains(base, true)) {
            Solved const s = solve(chain, gravity);
            for (std::size_t k = 0; k < chain.size(); ++k) {
                double const mass = chain.bodies.mass[k];
                auto const& [torque, push] = chain.bodies.wrench[k];
                Vec3 const &x = s.at.com_position[k], &w = s.at.omega[k];
                Sum force, moment;
                force.add(-mass * s.found.com_acceleration[k]);
                force.add(push + mass * gravity);
                force.add(s.found.joint_force[k].force);
                moment.add(-(s.inertia(k) * s.found.alpha[k]));
                moment.add(-cross(w, s.inertia(k) * w));
                moment.add(torque);
                moment.add(s.found.joint_force[k].torque);
                moment.add(cross(s.at.origin[k] - x, s.found.joint_force[k].force));
                if (k + 1 < chain.size()) {
                    force.add(-s.found.joint_force[k + 1].force);
                    moment.add(-s.found.joint_force[k + 1].torque);
                    moment.add(-cross(s.at.origin[k + 1] - x, s.found.joint_force[k + 1].force));
                }
                EXPECT_LE(force.relative(), allowed(chain)) << k << " of " << chain.size();
                EXPECT_LE(moment.relative(), allowed(chain)) << k << " of " << chain.size();
            }
        }
}

/// A constraint does no work along the joint, and what the joint adds there is the joint torque.
TEST(Identities, ConstraintForcesLeaveTheFreeDirectionsAlone) {
    for (ChainSpec const& chain : chains(Base::fixed, false)) {
        Solved const s = solve(chain, gravity);
        for (std::size_t k = 0; k < chain.size(); ++k) {
            auto const &total = s.found.joint_force[k], &constraint = s.found.constraint_force[k];
            double const size = norm(total.torque) + norm(total.force);
            Vec3 const axis = s.at.orientation[k] * chain.bodies.axis[k],
                       given = chain.bodies.torque[k];
            if (chain.bodies.joint[k] == JointType::revolute) {
                EXPECT_LE(std::abs(dot(axis, constraint.torque)), 64 * 0x1p-52 * size);
                EXPECT_LE(norm(total.torque - constraint.torque - given[0] * axis),
                          64 * 0x1p-52 * size);
            } else {
                EXPECT_EQ(norm(constraint.torque), 0.0);
                EXPECT_LE(norm(total.torque - s.at.orientation[k] * given), 64 * 0x1p-52 * size);
            }
            EXPECT_EQ(norm(total.force - constraint.force), 0.0);
        }
    }
}

/// dK/dt equals the power of gravity, wrenches and joint torques (no springs here: motion_test.cpp
/// has them).
TEST(Identities, PowerBalance) {
    for (Base const base : {Base::fixed, Base::free})
        for (ChainSpec const& chain : chains(base, false)) {
            Solved const s = solve(chain, gravity);
            Sum power;
            for (std::size_t k = 0; k < chain.size(); ++k) {
                double const mass = chain.bodies.mass[k];
                auto const& [torque, push] = chain.bodies.wrench[k];
                power.add(mass * dot(s.at.com_velocity[k], s.found.com_acceleration[k]));
                power.add(dot(s.at.omega[k], s.inertia(k) * s.found.alpha[k]));
                power.add(-dot(push + mass * gravity, s.at.com_velocity[k]));
                power.add(-dot(torque, s.at.omega[k]));
                if (chain.bodies.joint[k] != JointType::free)
                    power.add(-dot(chain.bodies.torque[k], chain.bodies.qd[k]));
            }
            EXPECT_LE(power.relative(), allowed(chain)) << chain.size();
        }
}

/// A body swinging about a pin: q'' = - m g d sin q / (J + m d^2), force by Newton; worked out by
/// hand.
TEST(Identities, CompoundPendulum) {
    ChainSpec chain;
    chain.base = Base::fixed;
    BodyArrays& b = chain.bodies;
    b.mass = {2};
    b.com = {{{0, -0.5, 0}}};
    b.inertia = {{{0.3, 0, 0.2, 0, 0, 0.4}}};
    b.joint = {JointType::revolute};
    b.axis = {{{0, 0, 1}}};
    b.rotation = {Mat3::identity()};
    b.translation = {{{1, 2, 3}}};
    b.q = {{0.7, 0, 0, 0}};
    b.qd = {{{3, 0, 0}}};
    b.torque = {{{0.25, 0, 0}}};
    b.stiffness = {{{1.5, 0, 0}}};
    b.damping = {{{0.1, 0, 0}}};
    b.rest = {{0.2, 0, 0, 0}};
    Solved const s = solve(chain, {{0, -10, 0}});
    double const expected =
        (0.25 - 1.5 * 0.5 - 0.1 * 3 - 2 * 10 * 0.5 * std::sin(0.7)) / (0.4 + 2 * 0.25);
    EXPECT_NEAR(s.found.qdd[0][0], expected, 1e-14 * 10);
    Vec3 const arm{{0.5 * std::sin(0.7), -0.5 * std::cos(0.7), 0}}, spin{{0, 0, expected}};
    Vec3 const acceleration = cross(spin, arm) - 9.0 * arm;
    EXPECT_LE(norm(s.found.joint_force[0].force - 2.0 * (acceleration + Vec3{{0, 10, 0}})), 1e-13);
    EXPECT_NEAR(s.at.spring_energy, 0.5 * 1.5 * 0.25, 1e-15);
    EXPECT_NEAR(s.at.potential_energy, 2 * 10 * (2 - 0.5 * std::cos(0.7)), 1e-13);
    EXPECT_NEAR(s.at.kinetic_energy, 0.5 * (0.4 + 2 * 0.25) * 9, 1e-14);
}

}  // namespace
}  // namespace catena::test
