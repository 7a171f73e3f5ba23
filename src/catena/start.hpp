// The start of a scene, as `solve` and `run` prepare it.
#pragma once

#include "catena/own_forces.hpp"
#include "start/start_check.hpp"
#include "start/start_relaxation.hpp"
#include "start/start_velocities.hpp"

namespace catena {

/// Returns the scene relaxed if it asks for that. In joint coordinates its thermal velocities are
/// drawn; in absolute coordinates steppers draw them. With `own_force`, its bodies carry the points
/// of own forces. Throws InputError for beads that coincide.
inline Scene start_of(Scene const& given, Axes axes, bool own_force, Communicator const& alone) {
    std::optional<RelaxedScene> relaxed = relaxed_where_asked(given, alone);
    if (!relaxed) refuse_coinciding(given, alone);
    Scene start = relaxed ? std::move(relaxed->scene) : given;
    if (axes == Axes::joint) start = with_start_velocities(std::move(start), alone);
    return own_force ? with_force_points(std::move(start)) : start;
}

}  // namespace catena
