// Factories of chain dynamics whose state stays on a GPU from step to step.
#pragma once

#include "dynamics/joint/joint_dynamics.hpp"

namespace catena::cuda {

/// Makes the dynamics of a group of beads, unbranched or branched, on the GPU chosen last, as
/// catena::make_bead_dynamics()
// does on the host. The executor runs the work that remains on the host. Group, executor and
// communicator must outlive the returned object.
std::unique_ptr<AbsoluteDynamics> make_bead_dynamics(ChainGroup const&, Scene const&,
                                                     Executor const&, Communicator const&);
std::unique_ptr<AbsoluteDynamics> make_branched_dynamics(ChainGroup const&, Scene const&,
                                                         Executor const&, Communicator const&);
/// Makes the dynamics of a group of rigid bodies in absolute coordinates, with the same
/// preconditions.
std::unique_ptr<AbsoluteDynamics> make_rigid_dynamics(ChainGroup const&, Scene const&,
                                                      Executor const&, Communicator const&);
/// Makes the dynamics of a group in joint coordinates, with the same preconditions.
std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const&, Scene const&, Executor const&,
                                                   Communicator const&);

}  // namespace catena::cuda
