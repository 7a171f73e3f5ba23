// Integrators in joint coordinates as programs: sequences of operators (joint_operation.hpp). A new
// one is a row of IntegratorTraits (src/scene/integrator.hpp), a program in joint_programs.cpp, and
// its name among the keys (src/keys/section_keys.cpp).
#pragma once

#include <span>

#include "dynamics/joint/joint_operation.hpp"
#include "integrate/joint_integrators.hpp"

namespace catena {

/// Operators of one step, and of the preparation of the first one, which is a step of length 0.
/// Programs that save accelerations take them over from step to step.
struct JointProgram {
    std::span<JointOperation const> step, prepare = {};

    /// True if accelerations are saved from step to step.
    bool saves() const { return !prepare.empty(); }
    /// Sweeps of a step, jointed tips left out.
    SweepsAStep sweeps() const;
};

/// Returns the program of an integrator in joint coordinates with steps of fixed length; `warm`:
/// with friction, which Langevin integrators alone have. Throws std::logic_error for the others.
JointProgram program_of(Integrator, bool warm);

/// Makes the integrator that runs a program. Noise has the thermostat's temperature.
std::unique_ptr<JointIntegrator> make_program(ChainSystem&, JointProgram const&,
                                              JointThermostat const& = {});

}  // namespace catena
