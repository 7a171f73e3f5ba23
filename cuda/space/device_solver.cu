// Selects the tree solver by the group's handles, axes and number of directions.
#include "cuda/space/device_solver.cuh"
#include "math/with_number.hpp"

namespace catena::cuda {

std::unique_ptr<ChainSolver> make_device_solver(ChainGroup const& group, DeviceSpace const& space,
                                                Communicator const& communicator) {
    if (group.handles == Handles::articulated)
        return make_articulated_solver(group, space, communicator);
    if (group.beads) return make_bead_solver(group, space, communicator);
    if (group.axes == Axes::world) return make_absolute_solver(group, space, communicator);
    return with_number<2, 6>(
        group.directions, [&](auto directions) -> std::unique_ptr<ChainSolver> {
            constexpr int K = decltype(directions)::value;
            if constexpr (K >= 5)  // Handles of joints that translate carry five directions or six.
                if (group.joints.has_screws)
                    return make_joint_solver<K, true>(group, space, communicator);
            return make_joint_solver<K, false>(group, space, communicator);
        });
}

}  // namespace catena::cuda
