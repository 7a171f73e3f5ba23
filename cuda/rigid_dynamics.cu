// Instantiates the dynamics of rigid bodies in absolute coordinates on a GPU.
#include "cuda/dynamics.hpp"
#include "cuda/space/device_solver.cuh"
#include "dynamics/rigid/rigid_dynamics.hpp"

namespace catena::cuda {

std::unique_ptr<AbsoluteDynamics> make_rigid_dynamics(ChainGroup const& group, Scene const& scene,
                                                      Executor const& on_host,
                                                      Communicator const& communicator) {
    DeviceSpace const space(on_host, communicator);
    return std::make_unique<RigidDynamics<DeviceSpace>>(
        group, scene, space, communicator, make_device_solver(group, space, communicator));
}

}  // namespace catena::cuda
