// Conventions against time itself: coordinates moved on by a short time, differences taken, no formula of the oracles used.
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
    auto const total = [](Kinematics<double> const& k) { return k.kinetic_energy + k.potential_energy + k.spring_energy; };
    return {central(ahead.com_position, behind.com_position, h), central(ahead.com_velocity, behind.com_velocity, h),
            central(ahead.omega, behind.omega, h), (total(ahead) - total(behind)) / (2 * h),
            (ahead.spring_energy - behind.spring_energy) / (2 * h)};
}

/// The error of a central difference falls by 4 when the step is halved, if what it tends to is right; else it stays.
void expect_second_order(double coarse, double fine, char const* what) {
    EXPECT_LT(coarse, 0.02) << what;
    if (coarse < 1e-12) return;  // a motion without a third derivative (prismatic joints alone) leaves no error to halve
    EXPECT_GT(coarse, 1e-9) << what << ": too small to tell the order";
    EXPECT_NEAR(coarse / fine, 4, 0.3) << what;
}

RandomJoints const kinds[] = {RandomJoints::revolute, RandomJoints::spherical, RandomJoints::mixed,   RandomJoints::universal,
                              RandomJoints::weld,     RandomJoints::prismatic, RandomJoints::helical, RandomJoints::any};

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
        expect_second_order(relative_difference(coarse.velocity, k.com_velocity), relative_difference(fine.velocity, k.com_velocity),
                            "velocity");
        expect_second_order(relative_difference(coarse.acceleration, a.com_acceleration),
                            relative_difference(fine.acceleration, a.com_acceleration), "acceleration");
        if (largest(a.alpha) > 1e-9)
            expect_second_order(relative_difference(coarse.alpha, a.alpha), relative_difference(fine.alpha, a.alpha),
                                "angular acceleration");
    }
};
INSTANTIATE_TEST_SUITE_P(AllKinds, Motion, ::testing::Range(0, 2 * static_cast<int>(std::size(kinds))));

TEST_P(Motion, VelocitiesAndAccelerationsAreTimeDerivatives) { expect_time_derivatives(chain()); }
TEST_P(Motion, WithDrivenJointsToo) { expect_time_derivatives(chain(0.5)); }

/// Springs conserve, whatever their three stiffnesses: the energy changes by the power of dampers, torques and wrenches.
TEST_P(Motion, EnergyChangesByThePowerOfWhatIsNotConservative) {
    ChainSpec const c = chain();
    auto const a = oracle::aba<double>(c, loads_at_start());
    auto const k = oracle::kinematics<double>(c, loads_at_start());
    double power = 0;
    for (std::size_t i = 0; i < c.size(); ++i) {
        power += dot(c.bodies.wrench[i].first, k.omega[i]) + dot(c.bodies.wrench[i].second, k.com_velocity[i]);
        if (c.bodies.joint[i] == JointType::free) continue;
        Vec3 const& qd = c.bodies.qd[i];
        for (int j = 0; j < 3; ++j) power += (c.bodies.torque[i][j] - c.bodies.damping[i][j] * qd[j]) * qd[j];
    }
    double const h = 1e-3;
    Differences const coarse = differences(c, a, h), fine = differences(c, a, h / 2);
    double const scale = std::abs(power) + std::abs(coarse.spring);
    EXPECT_GT(std::abs(coarse.spring), 1e-3 * scale);  // the springs take part
    expect_second_order(std::abs(coarse.energy - power) / scale, std::abs(fine.energy - power) / scale, "power");
}

}  // namespace
}  // namespace catena::test
