// Choice of the integrator in joint coordinates and its numbers of sweeps.
#include "integrate/joint_integrators.hpp"

#include <algorithm>

namespace catena {

bool has_jointed_tips(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(),
                       [](ChainSpec const& c) { return c.tip == Tip::jointed; });
}

SweepsAStep sweeps_a_step(DynamicsSpec const& d, bool tips) {
    IntegratorTraits const& traits = traits_of(d.integrator);
    if (traits.refined) {
        // The corrections of tips change the state, so the next step cannot take over the last
        // evaluation.
        int const evaluations = traits.evaluations + (traits.adaptive && tips ? 1 : 0);
        return {evaluations, evaluations};
    }
    return traits.langevin && d.friction > 0 ? SweepsAStep{2, 3} : SweepsAStep{1, 2};
}

std::unique_ptr<JointIntegrator> make_joint_integrator(ChainSystem& system, DynamicsSpec const& d) {
    switch (d.integrator) {
        case Integrator::rk4:
            return make_runge_kutta4(system);
        case Integrator::dormand_prince:
            return make_dormand_prince(system, d.tolerance, d.step);
        case Integrator::velocity_verlet:
            return make_velocity_verlet(system);
        case Integrator::staggered:
            return make_kicks(system, {});
        default:
            return make_kicks(system,
                              {d.friction, system.scene().boltzmann() * d.temperature, d.seed});
    }
}

void make_ghosts(ChainSystem& system) {
    if (system.openmm() && system.openmm()->ghosts_are_due()) system.evaluate();
}

}  // namespace catena
