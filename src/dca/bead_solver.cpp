#include "dca/tree_solver.hpp"

namespace catena::dca {

std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const& group, Executor const& executor, Communicator const& communicator) {
    if (group.directions == 1) return std::make_unique<TreeSolver<BeadLeaf<1>>>(group, executor, communicator);
    return std::make_unique<TreeSolver<BeadLeaf<3>>>(group, executor, communicator);
}

}  // namespace catena::dca
