// Chains whose state stays on a GPU.
#pragma once

#include "dynamics/joint/joint_dynamics.hpp"

namespace catena::cuda {

// As the functions of these names in catena, on the GPU chosen last; the executor is for what the
// host does besides. Group, executor and communicator must outlive what they make.
std::unique_ptr<AbsoluteDynamics> make_bead_dynamics(ChainGroup const&, Scene const&,
                                                     Executor const&, Communicator const&);
std::unique_ptr<AbsoluteDynamics> make_rigid_dynamics(ChainGroup const&, Scene const&,
                                                      Executor const&, Communicator const&);
std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const&, Scene const&, Executor const&,
                                                   Communicator const&);

}  // namespace catena::cuda
