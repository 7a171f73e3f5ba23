// Instantiates the dynamics of chains in joint coordinates on a GPU.
#include "cuda/dynamics.hpp"
#include "cuda/space/device_solver.cuh"
#include "dynamics/joint/joint_dynamics_in.hpp"

namespace catena::cuda {

std::unique_ptr<JointDynamics> make_joint_dynamics(ChainGroup const& group, Scene const& scene,
                                                   Executor const& on_host,
                                                   Communicator const& communicator) {
    DeviceSpace const space(on_host, communicator);
    return std::make_unique<JointDynamicsIn<DeviceSpace>>(
        group, scene, space, communicator, make_device_solver(group, space, communicator));
}

}  // namespace catena::cuda
