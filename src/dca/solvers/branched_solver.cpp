// The host's solver of branched chains of point beads.
#include "dca/solvers/branched_solver.hpp"

namespace catena::dca {

/// Returns the host solver of branched chains of point beads.
std::unique_ptr<ChainSolver> make_branched_solver(ChainGroup const& group, Executor const& executor,
                                                  Communicator const& communicator) {
    return std::make_unique<BranchedSolver<HostSpace>>(group, HostSpace(executor), communicator);
}

}  // namespace catena::dca
