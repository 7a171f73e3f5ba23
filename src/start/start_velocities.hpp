// Initial state of a run whose velocities are drawn at random.
#pragma once

#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

/// Returns the scene with the thermal velocities of its chains drawn (temperature and seed of its
/// dynamics) and stored as given velocities. For chains of links and spherical joints in absolute
/// coordinates they equal those that a run draws. Scenes without thermal chains are returned
/// unchanged. Collective.
Scene with_start_velocities(Scene, Communicator const&);

}  // namespace catena
