#include "cuda/device_solver.cuh"
#include "dca/articulated_sweeps.hpp"

namespace catena::cuda {

std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const& group, DeviceSpace const& space, Communicator const& communicator) {
    if (group.has_screws) return make_solver<dca::ArticulatedLeaf<true>>(group, space, communicator);
    return make_solver<dca::ArticulatedLeaf<false>>(group, space, communicator);
}

}  // namespace catena::cuda
