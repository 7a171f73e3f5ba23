#include "dca/articulated_sweeps.hpp"
#include "dca/tree_solver.hpp"

namespace catena::dca {

std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const& group, Executor const& executor, Communicator const& communicator) {
    if (group.has_screws) return std::make_unique<TreeSolver<ArticulatedLeaf<true>, HostSpace>>(group, HostSpace(executor), communicator);
    return std::make_unique<TreeSolver<ArticulatedLeaf<false>, HostSpace>>(group, HostSpace(executor), communicator);
}

}  // namespace catena::dca
