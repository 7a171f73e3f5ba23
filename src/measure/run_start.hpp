// What a run looks at before its first step: the error of its accelerations, and its time step.
#pragma once

#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Throws InputError for what making a run's system and integrator would refuse: hardware and
/// threads that are not there, and handles, refinement and ranks that the scene's chains and
/// integrator do not have. Makes nothing, so that `catena check` answers as a run does. Collective.
void refuse_before_run(Scene const& scene, Communicator const& communicator);

/// Prepares a scene for a run. Estimates the error of the first accelerations, and refines
/// articulated handles if they need it. Adds notes about errors that remain and about a step near
/// the limit of the joints' springs. Throws InputError for a step beyond it, and as
/// refuse_before_run() does. Collective.
void look_before_run(Scene& scene, Communicator const& communicator);

}  // namespace catena
