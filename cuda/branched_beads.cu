// Instantiates the solver and the dynamics of branched chains of beads on a GPU.
#include "cuda/dynamics.hpp"
#include "cuda/space/device_space.cuh"
#include "dca/solvers/branched_solver.hpp"
#include "dynamics/bead_dynamics.hpp"

namespace catena::cuda {

std::unique_ptr<AbsoluteDynamics> make_branched_dynamics(ChainGroup const& group,
                                                         Scene const& scene,
                                                         Executor const& on_host,
                                                         Communicator const& communicator) {
    DeviceSpace const space(on_host, communicator);
    return std::make_unique<BeadDynamics<DeviceSpace, BranchedFields>>(
        group, scene, space, communicator,
        std::make_unique<dca::BranchedSolver<DeviceSpace>>(group, space, communicator));
}

}  // namespace catena::cuda
