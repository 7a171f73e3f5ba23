// The programs of the integrators in joint coordinates. joint_integrators.hpp says what each is.
#include <stdexcept>

#include "integrate/joint_program.hpp"

namespace catena {
namespace {

using enum JointOperator;

/// Four stages with weights 1/6, 1/3, 1/3, 1/6, each after an evaluation at its state.
constexpr JointOperation runge_kutta4[] = {
    {evaluate}, {.what = accumulate, .divisor = 6, .next = 2, .first = true},
    {evaluate}, {.what = accumulate, .divisor = 3, .next = 2},
    {evaluate}, {.what = accumulate, .divisor = 3, .next = 1},
    {evaluate}, {.what = accumulate, .divisor = 6, .next = 1, .last = true},
};

constexpr JointOperation velocity_verlet[] = {{drift_saved}, {evaluate}, {kick_mean}};
constexpr JointOperation before_velocity_verlet[] = {{evaluate}, {save}};

// Velocities in the middle of a kick decide velocity-dependent forces: a first half of the kick
// finds them, and a second evaluation with the same matrices the acceleration.
constexpr JointOperation kick_drift_kick[] = {
    {kick_saved, 2}, {drift}, {evaluate}, {kick, 2}, {evaluate_again}, {save}, {kick, 2},
};
constexpr JointOperation baoab[] = {
    {kick_saved, 2}, {drift, 2},       {noise}, {drift, 2}, {evaluate},
    {kick, 2},       {evaluate_again}, {save},  {kick, 2},
};
constexpr JointOperation before_kicks[] = {
    {drift}, {evaluate}, {kick}, {evaluate_again}, {save}, {kick},
};

constexpr JointOperation leapfrog[] = {
    {drift, 2}, {evaluate}, {kick, 2}, {evaluate_again}, {kick}, {drift, 2},
};

}  // namespace

JointProgram program_of(Integrator integrator, bool warm) {
    switch (integrator) {
        case Integrator::rk4:
            return {runge_kutta4};
        case Integrator::velocity_verlet:
            return {velocity_verlet, before_velocity_verlet};
        case Integrator::leapfrog:
            return {leapfrog};
        case Integrator::staggered:
            return {kick_drift_kick, before_kicks};
        case Integrator::baoab:
        case Integrator::implicit_baoab:
            return warm ? JointProgram{baoab, before_kicks}
                        : JointProgram{kick_drift_kick, before_kicks};
        default:
            throw std::logic_error("an integrator without a program");
    }
}

}  // namespace catena
