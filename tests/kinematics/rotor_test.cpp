#include <gtest/gtest.h>

#include "kinematics/rotor.hpp"
#include "tests/support/random_chain.hpp"

namespace catena::test {
namespace {

PrincipalFrame frame_of(Random& random) { return {random.orientation(), {{0.4, 0.7, 1.0}}}; }

Vec3 momentum_in_space(PrincipalFrame const& frame, RotorState const& state) {
    Mat3 const p = to_matrix(frame.rotation);
    Vec3 l = transposed_times(p, state.omega);
    for (int i = 0; i < 3; ++i) l[i] *= frame.moments[i];
    return to_matrix(state.orientation) * (p * l);
}
double energy(PrincipalFrame const& frame, RotorState const& state) {
    Vec3 const w = transposed_times(to_matrix(frame.rotation), state.omega);
    return 0.5 * (frame.moments[0] * w[0] * w[0] + frame.moments[1] * w[1] * w[1] +
                  frame.moments[2] * w[2] * w[2]);
}
RotorState turned(PrincipalFrame const& frame, RotorState state, double time, int steps) {
    for (int i = 0; i < steps; ++i) state = free_rotor(frame, state, time / steps);
    return state;
}

// 1000 steps round a few eps each.
TEST(Rotor, KeepsMomentumInSpaceAndTurnsBack) {
    Random random(1);
    for (int i = 0; i < 20; ++i) {
        PrincipalFrame const frame = frame_of(random);
        RotorState const start{random.orientation(), random.vector(3)};
        RotorState const end = turned(frame, start, 5.0, 1000);
        double const size = norm(momentum_in_space(frame, start));
        EXPECT_LE(norm(momentum_in_space(frame, end) - momentum_in_space(frame, start)),
                  1000 * 40 * 0x1p-53 * size);
        RotorState const back = turned(frame, {end.orientation, -end.omega}, 5.0, 1000);
        EXPECT_LE(norm(back.omega + start.omega), 1000 * 400 * 0x1p-53 * norm(start.omega));
    }
}

TEST(Rotor, IsOfSecondOrderAndKeepsEnergyOverLongTimes) {
    Random random(2);
    PrincipalFrame const frame = frame_of(random);
    RotorState const start{random.orientation(), {{1.0, 2.0, -0.5}}};
    RotorState const exact = turned(frame, start, 1.0, 20000);
    double const coarse = norm(turned(frame, start, 1.0, 50).omega - exact.omega),
                 fine = norm(turned(frame, start, 1.0, 100).omega - exact.omega);
    EXPECT_NEAR(coarse / fine, 4.0, 0.3);
    double worst = 0;
    RotorState state = start;
    for (int i = 0; i < 20000; ++i) {
        state = free_rotor(frame, state, 0.02);
        worst = std::max(worst, std::abs(energy(frame, state) / energy(frame, start) - 1));
    }
    EXPECT_LT(worst, 1e-3);  // a bounded wobble of second order, no drift
}

TEST(Rotor, TurnsAboutAPrincipalAxisExactly) {
    PrincipalFrame const frame{Quat::identity(), {{0.4, 0.7, 1.0}}};
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 omega = Vec3::zero();
        omega[axis] = 2.0;
        RotorState const end = free_rotor(frame, {Quat::identity(), omega}, 0.3);
        Vec3 const turn = rotation_vector(end.orientation);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(turn[i], i == axis ? 0.6 : 0.0, 8 * 0x1p-53);
    }
}

}  // namespace
}  // namespace catena::test
