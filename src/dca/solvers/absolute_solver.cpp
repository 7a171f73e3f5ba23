// Host solvers of chains in absolute coordinates: beads, and bodies on links or spherical joints.
#include "dca/solvers/tree_solver.hpp"

namespace catena::dca {

/// Returns the host solver of beads on links.
std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const& group, Executor const& executor,
                                              Communicator const& communicator) {
    if (group.directions == 1)
        return std::make_unique<TreeSolver<BeadLeaf<1>, HostSpace>>(group, HostSpace(executor),
                                                                    communicator);
    return std::make_unique<TreeSolver<BeadLeaf<3>, HostSpace>>(group, HostSpace(executor),
                                                                communicator);
}

/// Returns the host solver of bodies in absolute coordinates, on links or on spherical joints.
std::unique_ptr<ChainSolver> make_absolute_solver(ChainGroup const& group, Executor const& executor,
                                                  Communicator const& communicator) {
    if (group.linked && group.directions == 1)
        return std::make_unique<TreeSolver<BodyLeaf<1, LinkFrames<1>>, HostSpace>>(
            group, HostSpace(executor), communicator);
    if (group.linked)
        return std::make_unique<TreeSolver<BodyLeaf<3, LinkFrames<3>>, HostSpace>>(
            group, HostSpace(executor), communicator);
    if (group.directions == 3)
        return std::make_unique<TreeSolver<BodyLeaf<3, GroundFrames<3>>, HostSpace>>(
            group, HostSpace(executor), communicator);
    return std::make_unique<TreeSolver<BodyLeaf<6, GroundFrames<6>>, HostSpace>>(
        group, HostSpace(executor), communicator);
}

}  // namespace catena::dca
