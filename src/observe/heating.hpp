// Kinetic energy that external loads add to chains under a thermostat.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace catena {

/// Upper bound on the heating by external loads: gravity, constant wrenches and joint torques,
/// whose work on chains is removed by friction. Friction removes kinetic energy at the rate 2
/// friction (K - K_equilibrium), so that work of power P raises the mean of K by P / (2 friction).
/// The power of a constant load f in coordinates is at most P = f M^-1 f / friction. A free body
/// reaches exactly that; potentials and joints reduce it.
struct Heating {
    bool is_pushed = false;  // external loads exist
    /// Largest rise of the mean kinetic temperature, K; includes the work of gravity and of other
    /// potentials with `with_potentials`.
    double excess = 0;
    std::string unknown;  // reason why no bound can be computed, e.g. "motions are prescribed";
                          // empty if there is one
};
/// Ratio of the drift of a step under a constant load to load / friction: x / tanh x with x =
/// friction * step / 2. It holds for schemes that drift in halves about an exact thermostat (BAOAB;
/// Leimkuhler & Matthews, Molecular Dynamics, 2015, ch. 7). The limit for short steps is 1.
double drift_of_step(DynamicsSpec const&);
/// Computes the heating of a scene whose integrator has a thermostat with friction.
/// `with_potentials`: frames do not contain potential energies, so that the work of gravity and of
/// constant forces counts as heating.
Heating heating_of(Scene const&, bool with_potentials);

}  // namespace catena
