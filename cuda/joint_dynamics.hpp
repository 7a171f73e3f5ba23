// Chains of bodies in joint coordinates whose state stays on a GPU.
#pragma once

#include "integrate/joint_dynamics.hpp"

namespace catena::cuda {

/// As catena::make_joint_dynamics, on the GPU chosen last. The group and the communicator must outlive it.
std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const&, Scene const&, Communicator const&);

}  // namespace catena::cuda
