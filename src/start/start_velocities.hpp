// The state a run starts from, where its velocities are drawn.
#pragma once

#include "mpi/communicator.hpp"
#include "scene/scene.hpp"

namespace catena {

/// The scene with the thermal velocities of its chains drawn (temperature and seed of its dynamics)
/// and written in as given ones: for link and spherical chains in absolute coordinates the very
/// draw of a run. Scenes without thermal chains come back as they are. Collective.
Scene with_start_velocities(Scene, Communicator const&);

}  // namespace catena
