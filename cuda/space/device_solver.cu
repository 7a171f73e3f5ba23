// Selects the tree solver by the group's handles, axes and number of directions.
#include "cuda/space/device_solver.cuh"

namespace catena::cuda {

std::unique_ptr<ChainSolver> make_device_solver(ChainGroup const& group, DeviceSpace const& space,
                                                Communicator const& communicator) {
    if (group.handles == Handles::articulated)
        return make_articulated_solver(group, space, communicator);
    if (group.beads) return make_bead_solver(group, space, communicator);
    if (group.axes == Axes::world) return make_absolute_solver(group, space, communicator);
    switch (group.directions) {
        case 2:
            return make_joint_solver<2, false>(group, space, communicator);
        case 3:
            return make_joint_solver<3, false>(group, space, communicator);
        case 4:
            return make_joint_solver<4, false>(group, space, communicator);
        case 5:
            return group.has_screws ? make_joint_solver<5, true>(group, space, communicator)
                                    : make_joint_solver<5, false>(group, space, communicator);
        default:
            return group.has_screws ? make_joint_solver<6, true>(group, space, communicator)
                                    : make_joint_solver<6, false>(group, space, communicator);
    }
}

}  // namespace catena::cuda
