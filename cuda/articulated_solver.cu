// Instantiates the tree solver for articulated handles.
#include "cuda/space/device_solver.cuh"
#include "dca/leaf_choice.hpp"

namespace catena::cuda {

std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const& group,
                                                     DeviceSpace const& space,
                                                     Communicator const& communicator) {
    return dca::with_articulated_leaf(group, [&](auto leaf) {
        return make_solver<typename decltype(leaf)::type>(group, space, communicator);
    });
}

}  // namespace catena::cuda
