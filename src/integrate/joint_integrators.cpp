// Choice of the integrator in joint coordinates and its numbers of sweeps.
#include "integrate/joint_integrators.hpp"

#include <algorithm>

namespace catena {

bool has_jointed_tips(Scene const& scene) {
    return std::any_of(scene.chains.begin(), scene.chains.end(),
                       [](ChainSpec const& c) { return c.tip == Tip::jointed; });
}

SweepsAStep sweeps_a_step(DynamicsSpec const& d, bool tips) {
    if (d.integrator == Integrator::rk4) return {4, 4};
    if (d.integrator == Integrator::dormand_prince)
        return tips ? SweepsAStep{7, 7} : SweepsAStep{6, 6};
    if (d.integrator == Integrator::velocity_verlet) return {1, 1};
    return is_langevin(d.integrator) && d.friction > 0 ? SweepsAStep{2, 3} : SweepsAStep{1, 2};
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
