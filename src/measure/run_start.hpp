// What a run looks at before its first step: the error of its accelerations, and its time step.
#pragma once

#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Prepares a scene for a run. Estimates the error of the first accelerations, and refines
/// articulated handles if they need it. Adds notes about errors that remain and about a step near
/// the limit of the joints' springs. Throws InputError for a step beyond it. Collective.
void look_before_run(Scene& scene, Communicator const& communicator);

}  // namespace catena
