// Instantiates the tree solver for beads and for bodies whose forces are kept in ground axes.
#include "cuda/space/device_solver.cuh"

namespace catena::cuda {

using namespace dca;

std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const& group, DeviceSpace const& space,
                                              Communicator const& communicator) {
    return group.directions == 1 ? make_solver<BeadLeaf<1>>(group, space, communicator)
                                 : make_solver<BeadLeaf<3>>(group, space, communicator);
}

std::unique_ptr<ChainSolver> make_absolute_solver(ChainGroup const& group, DeviceSpace const& space,
                                                  Communicator const& communicator) {
    if (group.linked && group.directions == 1)
        return make_solver<BodyLeaf<1, LinkFrames<1>>>(group, space, communicator);
    if (group.linked) return make_solver<BodyLeaf<3, LinkFrames<3>>>(group, space, communicator);
    if (group.directions == 3)
        return make_solver<BodyLeaf<3, GroundFrames<3>>>(group, space, communicator);
    return make_solver<BodyLeaf<6, GroundFrames<6>>>(group, space, communicator);
}

}  // namespace catena::cuda
