// Integrators in joint coordinates by name, for tests.
#pragma once

#include <memory>

#include "integrate/joint_program.hpp"

namespace catena::test {

inline std::unique_ptr<JointIntegrator> make_joint(ChainSystem& system, Integrator integrator) {
    return make_program(system, program_of(integrator, false));
}
inline std::unique_ptr<JointIntegrator> make_runge_kutta4(ChainSystem& system) {
    return make_joint(system, Integrator::rk4);
}

}  // namespace catena::test
