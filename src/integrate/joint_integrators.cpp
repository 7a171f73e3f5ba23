// Choice of the integrator in joint coordinates and its numbers of sweeps.
#include "integrate/joint_integrators.hpp"

#include <algorithm>

#include "integrate/joint_program.hpp"

namespace catena {

bool has_closures(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(),
                       [](ChainSpec const& c) { return c.is_closed(); });
}

SweepsAStep sweeps_a_step(DynamicsSpec const& d, bool tips) {
    if (!uses_joint_coordinates(d.integrator)) return {0, 0, 0};
    if (!traits_of(d.integrator).adaptive) return program_of(d.integrator, d.friction > 0).sweeps();
    // The corrections of tips change the state, so the next step cannot take over the last
    // evaluation.
    int const evaluations = EmbeddedStage::stages + (tips ? 1 : 0);
    return {evaluations, evaluations};
}

std::unique_ptr<JointIntegrator> make_joint_integrator(ChainSystem& system, DynamicsSpec const& d) {
    IntegratorTraits const& traits = traits_of(d.integrator);
    if (traits.adaptive) return make_dormand_prince(system, d.tolerance, d.step);
    if (!traits.langevin) return make_program(system, program_of(d.integrator, false));
    return make_program(system, program_of(d.integrator, d.friction > 0),
                        {d.friction, system.scene().boltzmann() * d.temperature, d.seed});
}

void make_ghosts(ChainSystem& system) {
    if (system.openmm() && system.openmm()->ghosts_are_due()) system.evaluate();
}

}  // namespace catena
