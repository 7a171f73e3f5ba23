// Host solver of chains with articulated handles (articulated.hpp).
#include "dca/leaf_choice.hpp"
#include "dca/solvers/tree_solver.hpp"

namespace catena::dca {

/// Returns the host solver of bodies held at their inboard joints.
std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const& group,
                                                     Executor const& executor,
                                                     Communicator const& communicator) {
    return with_articulated_leaf(group, [&](auto leaf) -> std::unique_ptr<ChainSolver> {
        return std::make_unique<TreeSolver<typename decltype(leaf)::type, HostSpace>>(
            group, HostSpace(executor), communicator);
    });
}

}  // namespace catena::dca
