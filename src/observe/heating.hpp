// What loads from outside add to the kinetic energy of chains under a thermostat.
#pragma once

#include <string>

#include "scene/scene.hpp"

namespace catena {

/// Gravity, constant wrenches and joint torques do work on chains, which friction carries away.
/// Friction takes kinetic energy at the rate 2 friction (K - K_equilibrium), so that work of power
/// P raises the mean of K by P / (2 friction). A constant load f, seen from the coordinates, gives
/// at most P = f M^-1 f / friction: exactly that to a free body, less where potentials or joints
/// hold it back.
struct Heating {
    bool is_pushed = false;  // there are such loads
    double excess = 0;  // K: the most by which they raise the mean kinetic temperature; gravity
                        // counts where `with_gravity` says so
    std::string
        unknown;  // why no bound can be given, e.g. "motions are prescribed"; empty where one can
};
/// How much faster than by load / friction a step drifts under a constant load: (x / tanh x), x =
/// friction * step / 2, of schemes that drift in halves about an exact thermostat (BAOAB;
/// Leimkuhler & Matthews, Molecular Dynamics, 2015, ch. 7). 1 in the limit of short steps.
double drift_of_step(DynamicsSpec const&);
/// Of a scene whose integrator has a thermostat with friction. `with_gravity`: frames do not tell
/// gravity's potential energy.
Heating heating_of(Scene const&, bool with_gravity);

}  // namespace catena
