// Conventions against time itself: coordinates moved on by a short time, differences taken, no
// formula of the oracles used.
#include <gtest/gtest.h>

#include "tests/oracle/compare.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

using oracle::Kinematics;
using oracle::OracleResult;

Vec3 const gravity{{2, -1, -9}};
double const start = 0.7;  // where driven joints are in their courses
oracle::Loads loads_at_start() {
    oracle::Loads loads{gravity, {}};
    loads.time = start;
    return loads;
}

using Vectors = std::vector<Vec3>;
Vectors central(Vectors const& ahead, Vectors const& behind, double h) {
    Vectors d;
    for (std::size_t k = 0; k < ahead.size(); ++k) d.push_back((0.5 / h) * (ahead[k] - behind[k]));
    return d;
}

struct Differences {
    Vectors velocity, acceleration, alpha;
    double energy;  // d/dt of kinetic, potential and spring energy
    double spring;  // of the last alone
};
Differences differences(ChainSpec const& chain, OracleResult<double> const& a, double h) {
    auto const later = [&](double by) {  // driven joints take their coordinates from the time
        oracle::Loads loads{gravity, {}};
        loads.time = start + by;
        return oracle::kinematics<double>(moved(chain, a, by), loads);
    };
    auto const ahead = later(h), behind = later(-h);
    auto const total = [](Kinematics<double> const& k) {
        return k.kinetic_energy + k.potential_energy + k.spring_energy;
    };
    return {central(ahead.com_position, behind.com_position, h),
            central(ahead.com_velocity, behind.com_velocity, h),
            central(ahead.omega, behind.omega, h), (total(ahead) - total(behind)) / (2 * h),
            (ahead.spring_energy - behind.spring_energy) / (2 * h)};
}

/// The error of a central difference falls by 4 when the step is halved, if what it tends to is
/// right; else it stays.
void expect_second_order(double coarse, double fine, char const* what) {
    EXPECT_LT(coarse, 0.02) << what;
    if (coarse < 1e-12)
        return;  // a motion without a third derivative (prismatic joints alone) leaves no error to
                 // halve
    EXPECT_GT(coarse, 1e-9) << what << ": too small to tell the order";
    EXPECT_NEAR(coarse / fine, 4, 0.3) << what;
}

RandomJoints const kinds[] = {
    RandomJoints::revolute,  RandomJoints::spherical, RandomJoints::mixed,
    RandomJoints::universal, RandomJoints::weld,      RandomJoints::prismatic,
    RandomJoints::helical,   RandomJoints::any,       RandomJoints::cylindrical,
    RandomJoints::planar3,   RandomJoints::all};

class Motion : public ::testing::TestWithParam<int> {
  protected:
    ChainSpec chain(double driven = 0) const {
        auto const i = static_cast<std::size_t>(GetParam());
        return random_chain(40 + i, {.bodies = 5,
                                     .joints = kinds[i % std::size(kinds)],
                                     .base = i < std::size(kinds) ? Base::fixed : Base::free,
                                     .springs = true,
                                     .drag = driven > 0,
                                     .driven = driven});
    }
    static void expect_time_derivatives(ChainSpec const& c) {
        auto const a = oracle::aba<double>(c, loads_at_start());
        auto const k = oracle::kinematics<double>(c, loads_at_start());
        double const h = 1e-3;
        Differences const coarse = differences(c, a, h), fine = differences(c, a, h / 2);
        expect_second_order(relative_difference(coarse.velocity, k.com_velocity),
                            relative_difference(fine.velocity, k.com_velocity), "velocity");
        expect_second_order(relative_difference(coarse.acceleration, a.com_acceleration),
                            relative_difference(fine.acceleration, a.com_acceleration),
                            "acceleration");
        if (largest(a.alpha) > 1e-9)
            expect_second_order(relative_difference(coarse.alpha, a.alpha),
                                relative_difference(fine.alpha, a.alpha), "angular acceleration");
    }
};
INSTANTIATE_TEST_SUITE_P(AllKinds, Motion,
                         ::testing::Range(0, 2 * static_cast<int>(std::size(kinds))));

TEST_P(Motion, VelocitiesAndAccelerationsAreTimeDerivatives) { expect_time_derivatives(chain()); }
TEST_P(Motion, WithDrivenJointsToo) { expect_time_derivatives(chain(0.5)); }

/// Springs conserve, whatever their three stiffnesses: the energy changes by the power of dampers,
/// torques and wrenches.
TEST_P(Motion, EnergyChangesByThePowerOfWhatIsNotConservative) {
    ChainSpec const c = chain();
    auto const a = oracle::aba<double>(c, loads_at_start());
    auto const k = oracle::kinematics<double>(c, loads_at_start());
    double power = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
        power += dot(c.bodies.wrench[i].first, k.omega[i]) +
                 dot(c.bodies.wrench[i].second, k.com_velocity[i]);
        if (c.bodies.joint[i] == JointType::free) continue;
        Vec3 const& qd = c.bodies.qd[i];
        for (int j = 0; j < 3; ++j)
            power += (c.bodies.torque[i][j] - c.bodies.damping[i][j] * qd[j]) * qd[j];
    }
    double const h = 1e-3;
    Differences const coarse = differences(c, a, h), fine = differences(c, a, h / 2);
    double const scale = std::abs(power) + std::abs(coarse.spring);
    EXPECT_GT(std::abs(coarse.spring), 1e-3 * scale);  // the springs take part
    expect_second_order(std::abs(coarse.energy - power) / scale,
                        std::abs(fine.energy - power) / scale, "power");
}

/// Poses by the definition of each joint's motion X(q) in scene.hpp, written out with quaternions.
TEST_P(Motion, PosesFollowTheDefinition) {
    ChainSpec const c = chain();
    BodyArrays const& b = c.bodies;
    auto const k = oracle::kinematics<double>(c, loads_at_start());
    Mat3 r = Mat3::identity();
    Vec3 x = Vec3::zero();
    for (std::size_t i = 0; i < c.size(); ++i) {
        JointType const type = b.joint[i];
        auto const& q = b.q[i];
        Quat turn = Quat::identity();
        Vec3 shift = Vec3::zero();
        if (type == JointType::free || type == JointType::spherical)
            turn = {q[0], q[1], q[2], q[3]};
        if (type == JointType::revolute || type == JointType::helical)
            turn = from_axis_angle(b.axis[i], q[0]);
        if (type == JointType::universal)
            turn = from_axis_angle(b.first_axis[i], q[0]) * from_axis_angle(b.axis[i], q[1]);
        if (type == JointType::prismatic) shift = q[0] * b.axis[i];
        if (type == JointType::helical) shift = (b.pitch[i] * q[0]) * b.axis[i];
        if (type == JointType::cylindrical)
            turn = from_axis_angle(b.axis[i], q[0]), shift = q[1] * b.axis[i];
        if (type == JointType::planar3) {
            turn = from_axis_angle(b.axis[i], q[2]);
            shift = q[0] * b.first_axis[i] + q[1] * cross(b.axis[i], b.first_axis[i]);
        }
        bool const free = type == JointType::free;
        x = free ? b.free_base.position : x + r * (b.translation[i] + b.rotation[i] * shift);
        r = free ? to_matrix(turn) : r * (b.rotation[i] * to_matrix(turn));
        EXPECT_LE(norm(k.origin[i] - x), 64 * 0x1p-52);
        for (int j = 0; j < 3; ++j)
            EXPECT_LE(norm(k.orientation[i].column(j) - r.column(j)), 64 * 0x1p-52);
    }
}

/// A drive holds its course with the effort that an undriven joint would need for it.
TEST_P(Motion, ADriveIsTheEffortItNeeds) {
    ChainSpec const c = chain(0.7);
    auto const driven = oracle::aba<double>(c, loads_at_start());
    auto const k = oracle::kinematics<double>(c, loads_at_start());
    ChainSpec pushed = c;
    pushed.bodies.driven.clear();
    for (DrivenJoint const& d : c.bodies.driven) {
        auto const i = static_cast<std::size_t>(d.body);
        JointType const type = c.bodies.joint[i];
        Vec3 &u = pushed.bodies.qd[i], &effort = pushed.bodies.torque[i], q = Vec3::zero();
        bool const two = type == JointType::universal || type == JointType::cylindrical;
        for (int j = 0; j < (two ? 2 : 1); ++j) {
            PrescribedMotion const& course = d.course[static_cast<std::size_t>(j)];
            double const turns = 2 * std::acos(-1.0) * course.frequency,
                         phase = turns * start + course.phase;
            q[j] = course.offset + course.rate * start + course.amplitude * std::sin(phase);
            u[j] = course.rate + course.amplitude * turns * std::cos(phase);
            EXPECT_NEAR(driven.qdd[i][j], -course.amplitude * turns * turns * std::sin(phase),
                        1e-12 * (1 + turns * turns));
        }
        pushed.bodies.q[i] = {q[0], q[1], 0, 0};
        pushed.bodies.stiffness[i] = pushed.bodies.damping[i] = Vec3::zero();
        auto const& wrench = driven.constraint_force[i];
        Vec3 const torque = transposed_times(k.orientation[i], wrench.torque),
                   force = transposed_times(k.orientation[i], wrench.force);
        Vec3 const axis = c.bodies.axis[i];
        if (type == JointType::prismatic) effort[0] = dot(axis, force);
        if (type == JointType::revolute) effort[0] = dot(axis, torque);
        if (type == JointType::helical)
            effort[0] = dot(axis, torque) + c.bodies.pitch[i] * dot(axis, force);
        if (type == JointType::cylindrical) effort = {{dot(axis, torque), dot(axis, force), 0}};
        if (type == JointType::universal)  // the first axis in B: turned back about the second
            effort = {
                {dot(to_matrix(from_axis_angle(axis, -q[1])) * c.bodies.first_axis[i], torque),
                 dot(axis, torque), 0}};
    }
    auto const found = oracle::dense<double>(pushed, loads_at_start());
    double const allowed = 64 * 5 * 0x1p-52 * growth(pushed, loads_at_start());
    EXPECT_LE(relative_difference(found.com_acceleration, driven.com_acceleration), allowed);
    EXPECT_LE(relative_difference(forces(found.joint_force), forces(driven.joint_force)), allowed);
}

/// Forces on carried beads are a wrench on the body that carries them.
TEST_P(Motion, ForcesOnCarriedBeads) {
    ChainSpec c = chain();
    auto const k = oracle::kinematics<double>(c, loads_at_start());
    ChainSpec pushed = c;
    oracle::Loads loads = loads_at_start(), with_beads = loads;
    Random random(5);
    c.bodies.carried.offset = {0, 2, 2, 3, 6, 6};
    for (std::size_t body = 0, bead = 0; body < 5; ++body)
        for (; bead < static_cast<std::size_t>(c.bodies.carried.offset[body + 1]); ++bead) {
            Vec3 const at = random.vector(0.5), force = random.vector(5);
            c.bodies.carried.position.push_back(at);
            with_beads.bead_forces.push_back(force);
            auto& wrench = pushed.bodies.wrench[body];
            wrench.first =
                wrench.first +
                cross(k.origin[body] + k.orientation[body] * at - k.com_position[body], force);
            wrench.second = wrench.second + force;
        }
    auto const a = oracle::aba<double>(c, with_beads), b = oracle::aba<double>(pushed, loads);
    EXPECT_LE(difference(a, b), 16 * 5 * 0x1p-52 * growth(pushed, loads));
}

}  // namespace
}  // namespace catena::test
