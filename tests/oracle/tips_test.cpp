// Chains whose last body is joined to the ground: the solvers against each other, the closure
// against time, the balances.
#include <gtest/gtest.h>

#include "joints/joint_models.hpp"
#include "tests/oracle/compare.hpp"
#include "tests/oracle/loop_rank.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using oracle::Quad;

RandomJoints const kinds[] = {
    RandomJoints::revolute, RandomJoints::spherical, RandomJoints::mixed,   RandomJoints::universal,
    RandomJoints::weld,     RandomJoints::prismatic, RandomJoints::helical, RandomJoints::any};

/// Coordinates that are free to move.
int freedoms(ChainSpec const& chain) {
    int dof = 0;
    for (JointType const type : chain.bodies.joint) dof += freedom_of(type);
    return dof - static_cast<int>(chain.bodies.driven.size()) * 2;  // at most
}

class Tips : public ::testing::TestWithParam<JointType> {
  protected:
    struct TipCase : Case {
        /// Whether the joints leave the tip every motion it forbids, so that its forces are unique.
        bool held_once() const {
            return closure_rank(chain, loads) == restricted_by(chain.tip_joint.type);
        }
    };
    static TipCase random_case(std::uint64_t seed, std::size_t largest) {
        Random random(3'000'000 + seed);
        RandomChainOptions options;
        options.base = seed % 2 == 0 ? Base::fixed : Base::free;
        options.joints = kinds[seed / 2 % std::size(kinds)];
        options.bodies =
            1 + static_cast<std::size_t>(random.uniform() * static_cast<double>(largest));
        options.springs = random.chance(0.5);
        options.drag = random.chance(0.5);
        options.driven = random.chance(0.3) ? 0.2 : 0;
        options.tip = GetParam();
        options.time = random.uniform(0, 3);
        TipCase c{{random_chain(seed, options), {random.vector(10), {}}}};
        c.loads.time = options.time;
        return c;
    }
    /// c = 128: the articulated bodies answer by way of unit wrenches, whose system has a condition
    /// number of its own.
    template <class S>
    static void compare(int count, std::size_t largest) {
        auto const held_once = [&](std::uint64_t seed) -> std::optional<Case> {
            TipCase const c = random_case(seed, largest);
            return c.held_once() ? std::optional<Case>(c) : std::nullopt;
        };
        solvers_agree<S>(count, 128, held_once, [](Case const& c) {
            inverse_dynamics_agree(
                c, 64,
                std::max(growth(c.chain, c.loads), oracle::condition_estimate(c.chain, c.loads)));
        });
    }
};
INSTANTIATE_TEST_SUITE_P(Joints, Tips,
                         ::testing::Values(JointType::spherical, JointType::revolute,
                                           JointType::universal, JointType::weld,
                                           JointType::prismatic, JointType::helical,
                                           JointType::cylindrical, JointType::planar3));

TEST_P(Tips, SolversAgree) { compare<double>(320, 12); }
TEST_P(Tips, SolversAgreeIn113Bits) { compare<Quad>(16, 4); }

/// A planar chain holds its tip in the plane already: accelerations are unique, forces across the
/// plane are not.
TEST_P(Tips, PlanarChainsAreHeldTwice) {
    Agreement<double> agreement;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        ChainSpec const chain = random_chain(seed, {.bodies = 4 + seed % 6,
                                                    .joints = RandomJoints::planar,
                                                    .springs = seed % 2 == 0,
                                                    .tip = GetParam()});
        ASSERT_LE(agreement.add_accelerations(chain, {Random(seed).vector(10), {}}), 64) << seed;
    }
    agreement.print();
}

/// The wrench of the tip's joint goes on what it says: balances of the whole chain about the
/// ground's origin.
TEST_P(Tips, BalancesOfTheWhole) {
    for (std::uint64_t seed = 1; seed < 40; seed += 2) {
        TipCase const c = random_case(seed, 8);
        if (!c.chain.bodies.drag.empty()) continue;
        auto const k = oracle::kinematics<double>(c.chain, c.loads);
        auto const r = oracle::aba<double>(c.chain, c.loads);
        Vec3 force = -r.tip_force.force, moment = -r.tip_force.torque;
        double size = norm(force) + norm(moment);
        for (std::size_t i = 0; i < c.chain.size(); ++i) {
            Mat3 const inertia =
                k.orientation[i] * (full(c.chain.bodies.inertia[i]) * transpose(k.orientation[i]));
            auto const& [torque, push] = c.chain.bodies.wrench[i];
            Vec3 const net =
                c.chain.bodies.mass[i] * (r.com_acceleration[i] - c.loads.gravity) - push;
            force = force + net;
            moment = moment + cross(k.com_position[i], net) + inertia * r.alpha[i] +
                     cross(k.omega[i], inertia * k.omega[i]) - torque;
            size += norm(net) + norm(inertia * r.alpha[i]);
        }
        Vec3 const frame = k.origin.back() + k.orientation.back() * c.chain.tip_joint.translation;
        moment = moment - cross(frame, r.tip_force.force);
        double const allowed =
            16 * static_cast<double>(c.chain.size()) * 0x1p-52 * growth(c.chain, c.loads) * size;
        EXPECT_LE(norm(force), allowed) << seed;
        EXPECT_LE(norm(moment), allowed) << seed;
    }
}

/// The tip's constraint does no work, whatever its joint: kinetic energy changes by the power of
/// the loads.
TEST_P(Tips, PowerBalance) {
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        ChainSpec const chain =
            random_chain(seed, {.bodies = 6,
                                .joints = kinds[seed / 2 % std::size(kinds)],
                                .base = seed % 2 == 0 ? Base::fixed : Base::free,
                                .tip = GetParam()});
        oracle::Loads const loads{{{1, -2, -9}}, {}};
        auto const k = oracle::kinematics<double>(chain, loads);
        auto const r = oracle::aba<double>(chain, loads);
        double power = 0, size = 0;
        auto const add = [&](double x) { power += x, size += std::abs(x); };
        for (std::size_t i = 0; i < chain.size(); ++i) {
            Mat3 const inertia =
                k.orientation[i] * (full(chain.bodies.inertia[i]) * transpose(k.orientation[i]));
            auto const& [torque, push] = chain.bodies.wrench[i];
            add(dot(k.com_velocity[i],
                    chain.bodies.mass[i] * (r.com_acceleration[i] - loads.gravity) - push));
            add(dot(k.omega[i], inertia * r.alpha[i] - torque));
            if (chain.bodies.joint[i] != JointType::free)
                add(-dot(chain.bodies.torque[i], chain.bodies.qd[i]));
        }
        EXPECT_LE(std::abs(power),
                  16 * 6 * 0x1p-52 * oracle::condition_estimate(chain) * (1 + size))
            << seed;
    }
}

/// What a closed tip keeps constant, from the pose of the last body alone. `g`: G's orientation and
/// origin, at rest.
std::vector<double> kept(ChainSpec const& chain, oracle::Loads const& loads, Mat3 const& g,
                         Vec3 const& origin) {
    auto const k = oracle::kinematics<double>(chain, loads);
    TipJoint const& tip = chain.tip_joint;
    Mat3 const frame = k.orientation.back() * tip.rotation, turn = transposed_times(frame, g);
    Vec3 const shift =
        transposed_times(frame, origin - k.origin.back() - k.orientation.back() * tip.translation);
    std::vector<double> all;
    auto const add = [&](auto const& values) {
        all.insert(all.end(), std::begin(values.data), std::end(values.data));
    };
    bool const slides = tip.type == JointType::prismatic || tip.type == JointType::helical ||
                        tip.type == JointType::cylindrical;
    if (tip.type == JointType::planar3)
        all.push_back(dot(tip.axis, shift));
    else
        add(slides ? cross(tip.axis, shift) : shift);
    if (tip.type == JointType::weld || tip.type == JointType::prismatic) add(turn);
    if (tip.type == JointType::revolute || tip.type == JointType::helical ||
        tip.type == JointType::cylindrical || tip.type == JointType::planar3)
        add(turn * tip.axis);
    if (tip.type == JointType::universal) all.push_back(dot(tip.first_axis, turn * tip.axis));
    if (tip.type == JointType::helical)
        all.push_back(dot(tip.axis, shift) -
                      tip.pitch * dot(tip.axis, rotation_vector(to_quaternion(turn))));
    return all;
}
/// Second time derivative of that under the accelerations found, by differences over h.
double opening(ChainSpec const& chain, oracle::OracleResult<double> const& a, oracle::Loads loads,
               Mat3 const& g, Vec3 const& origin, double h) {
    double const start = loads.time;
    std::vector<double> const now = kept(chain, loads, g, origin);
    loads.time = start + h;
    std::vector<double> const ahead = kept(moved(chain, a, h), loads, g, origin);
    loads.time = start - h;
    return second_derivative(kept(moved(chain, a, -h), loads, g, origin), now, ahead, h);
}
/// G where the tip's coordinates put it: the joint's definition, written out once more.
std::pair<Mat3, Vec3> ground_frame(ChainSpec const& chain, oracle::Loads const& loads) {
    auto const k = oracle::kinematics<double>(chain, loads);
    TipJoint const& tip = chain.tip_joint;
    auto const& q = tip.q;
    Quat turn = Quat::identity();
    Vec3 shift = Vec3::zero();
    if (tip.type == JointType::spherical) turn = {q[0], q[1], q[2], q[3]};
    if (tip.type == JointType::revolute || tip.type == JointType::helical)
        turn = from_axis_angle(tip.axis, q[0]);
    if (tip.type == JointType::universal)
        turn = from_axis_angle(tip.first_axis, q[0]) * from_axis_angle(tip.axis, q[1]);
    if (tip.type == JointType::prismatic) shift = q[0] * tip.axis;
    if (tip.type == JointType::helical) shift = (tip.pitch * q[0]) * tip.axis;
    if (tip.type == JointType::cylindrical)
        turn = from_axis_angle(tip.axis, q[0]), shift = q[1] * tip.axis;
    if (tip.type == JointType::planar3) {
        turn = from_axis_angle(tip.axis, q[2]);
        shift = q[0] * tip.first_axis + q[1] * cross(tip.axis, tip.first_axis);
    }
    Mat3 const& r = k.orientation.back();
    return {r * (tip.rotation * to_matrix(turn)),
            k.origin.back() + r * (tip.translation + tip.rotation * shift)};
}

TEST_P(Tips, StayClosed) {
    int moving = 0;
    for (std::uint64_t seed = 0; seed < 32; ++seed) {
        TipCase const c = random_case(seed, 6);
        if (!c.held_once() || freedoms(c.chain) <= restricted_by(GetParam())) continue;
        auto const a = oracle::aba<double>(c.chain, c.loads);
        auto const [g, origin] = ground_frame(c.chain, c.loads);
        double const h = 2e-4, size = largest(a.com_acceleration) + largest(a.alpha);
        double const coarse = opening(c.chain, a, c.loads, g, origin, h),
                     fine = opening(c.chain, a, c.loads, g, origin, h / 2);
        double const rounding = 16 * 0x1p-52 / (h * h / 4);
        EXPECT_LT(coarse, 0.02 * (1 + size)) << seed;
        EXPECT_LE(fine, coarse / 3 + rounding)
            << seed << ": " << coarse << ", " << fine << " do not fall like the step's square";
        ++moving;
    }
    EXPECT_GT(moving, 12);
}

/// A ring of ten joints of a kind or more, closed by the tested one; none where they move too
/// little to be held once.
std::optional<Case> random_ring(std::uint64_t seed, JointType closing) {
    Random random(4'000'000 + seed);
    RandomChainOptions options;
    options.base = Base::free;
    options.joints = kinds[seed % std::size(kinds)];
    options.bodies = 10 + seed % 4;
    options.springs = random.chance(0.5);
    options.drag = random.chance(0.5);
    options.driven = random.chance(0.3) ? 0.1 : 0;
    options.tip = closing;
    options.ring = true;
    options.time = random.uniform(0, 3);
    Case c{random_chain(seed, options), {random.vector(10), {}}};
    c.loads.time = options.time;
    bool const turns =
        options.joints != RandomJoints::prismatic && options.joints != RandomJoints::weld;
    return turns && freedoms(c.chain) >= 12 ? std::optional<Case>(c) : std::nullopt;
}

TEST_P(Tips, RingsAgree) {
    solvers_agree<double>(
        80, 64, [](std::uint64_t seed) { return random_ring(seed, GetParam()); },
        [](Case const& c) {
            inverse_dynamics_agree(
                c, 64,
                std::max(growth(c.chain, c.loads), oracle::condition_estimate(c.chain, c.loads)));
        });
}

/// What a ring's joint keeps: the first body, seen from the last.
std::vector<double> kept_in_ring(ChainSpec const& chain, oracle::Loads const& loads) {
    auto const k = oracle::kinematics<double>(chain, loads);
    return kept(chain, loads, k.orientation.front(), k.origin.front());
}

TEST_P(Tips, RingsStayClosed) {
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        std::optional<Case> const made = random_ring(seed, GetParam());
        if (!made) continue;
        Case const& c = *made;
        auto const a = oracle::aba<double>(c.chain, c.loads);
        double const size = largest(a.com_acceleration) + largest(a.alpha);
        auto const opening = [&](double h) {
            oracle::Loads ahead = c.loads, behind = c.loads;
            ahead.time += h, behind.time -= h;
            return second_derivative(kept_in_ring(moved(c.chain, a, -h), behind),
                                     kept_in_ring(c.chain, c.loads),
                                     kept_in_ring(moved(c.chain, a, h), ahead), h);
        };
        double const h = 2e-4, coarse = opening(h), fine = opening(h / 2),
                     rounding = 64 * 0x1p-52 / (h * h / 4);
        EXPECT_LT(coarse, 0.02 * (1 + size)) << seed;
        EXPECT_LE(fine, coarse / 3 + rounding)
            << seed << ": " << coarse << ", " << fine << " do not fall like the step's square";
    }
}

/// The tip's velocity is what its joint allows.
TEST_P(Tips, ProjectedVelocitiesFit) {
    for (std::uint64_t seed = 0; seed < 32; ++seed) {
        TipCase const c = random_case(seed, 6);
        auto const [g, origin] = ground_frame(c.chain, c.loads);
        oracle::OracleResult<double> still;
        still.qdd.assign(c.chain.size(), Vec3::zero());
        double const h = 1e-5;
        oracle::Loads ahead = c.loads, behind = c.loads;
        ahead.time += h, behind.time -= h;
        std::vector<double> const after = kept(moved(c.chain, still, h), ahead, g, origin),
                                  before = kept(moved(c.chain, still, -h), behind, g, origin);
        bool const can_follow = c.held_once();
        for (std::size_t i = 0; i < after.size() && can_follow; ++i)
            EXPECT_NEAR((after[i] - before[i]) / (2 * h), 0, 1e-6) << seed;
    }
}

}  // namespace
}  // namespace catena::test
