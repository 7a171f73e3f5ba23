// Host solvers of chains in joint coordinates, and the selection of the host solver of a group.
#include "dca/solvers/tree_solver.hpp"

namespace catena {
namespace dca {

// Host solvers that are compiled in other files of this folder.
std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const&, Executor const&,
                                              Communicator const&);
std::unique_ptr<ChainSolver> make_absolute_solver(ChainGroup const&, Executor const&,
                                                  Communicator const&);
std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const&, Executor const&,
                                                     Communicator const&);

namespace {

/// Returns the host solver with K directions per handle. `sliding`: some joint is prismatic or
/// helical.
template <int K, bool sliding = false>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const& group, Executor const& executor,
                                               Communicator const& communicator) {
    return std::make_unique<TreeSolver<BodyLeaf<K, JointFrameHandles<K, sliding>>, HostSpace>>(
        group, HostSpace(executor), communicator);
}

}  // namespace
}  // namespace dca

/// Selects the host solver by handles, coordinates and number of directions.
std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const& group, Executor const& executor,
                                              Communicator const& communicator) {
    if (group.handles == Handles::articulated)
        return dca::make_articulated_solver(group, executor, communicator);
    if (group.beads) return dca::make_bead_solver(group, executor, communicator);
    if (group.axes == Axes::world) return dca::make_absolute_solver(group, executor, communicator);
    if (group.directions == 2) return dca::make_joint_solver<2>(group, executor, communicator);
    if (group.directions == 3) return dca::make_joint_solver<3>(group, executor, communicator);
    if (group.directions == 4) return dca::make_joint_solver<4>(group, executor, communicator);
    if (group.directions == 5)
        return group.has_screws ? dca::make_joint_solver<5, true>(group, executor, communicator)
                                : dca::make_joint_solver<5>(group, executor, communicator);
    return group.has_screws ? dca::make_joint_solver<6, true>(group, executor, communicator)
                            : dca::make_joint_solver<6>(group, executor, communicator);
}

}  // namespace catena
