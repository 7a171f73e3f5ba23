// Chains of beads whose state stays on a GPU.
#pragma once

#include "integrate/absolute_dynamics.hpp"

namespace catena::cuda {

/// As catena::make_bead_dynamics, on the GPU chosen last. The group and the communicator must outlive it.
std::unique_ptr<AbsoluteDynamics> make_bead_dynamics(ChainGroup const&, Scene const&, Communicator const&);

}  // namespace catena::cuda
