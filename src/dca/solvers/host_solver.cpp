// The selection of the host solver of a group of chains.
#include "dca/solvers/crosslinked_solver.hpp"
#include "dca/solvers/joint_solver.hpp"
#include "dca/solvers/looped_solver.hpp"

namespace catena {
namespace dca {

// Host solvers that are compiled in other files of this folder.
std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const&, Executor const&,
                                              Communicator const&);
std::unique_ptr<ChainSolver> make_branched_solver(ChainGroup const&, Executor const&,
                                                  Communicator const&);
std::unique_ptr<ChainSolver> make_absolute_solver(ChainGroup const&, Executor const&,
                                                  Communicator const&);
std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const&, Executor const&,
                                                     Communicator const&);
std::unique_ptr<ChainSolver> make_body_tree_solver(ChainGroup const&, Executor const&,
                                                   Communicator const&);

}  // namespace dca

namespace {

/// Selects the host solver of chains without loops, or with their loops open.
std::unique_ptr<ChainSolver> make_open_solver(ChainGroup const& group, Executor const& executor,
                                              Communicator const& communicator) {
    if (group.is_branched() && !group.beads)
        return dca::make_body_tree_solver(group, executor, communicator);
    if (group.handles == Handles::articulated)
        return dca::make_articulated_solver(group, executor, communicator);
    if (!group.branching.crosslinks.empty())
        return std::make_unique<dca::CrossLinkedSolver>(
            group, executor, dca::make_branched_solver(group, executor, communicator));
    if (group.is_branched()) return dca::make_branched_solver(group, executor, communicator);
    if (group.beads) return dca::make_bead_solver(group, executor, communicator);
    if (group.axes == Axes::world) return dca::make_absolute_solver(group, executor, communicator);
    if (group.directions == 2)
        return dca::make_joint_solver<2, false>(group, executor, communicator);
    if (group.directions == 3)
        return dca::make_joint_solver<3, false>(group, executor, communicator);
    if (group.directions == 4)
        return dca::make_joint_solver<4, false>(group, executor, communicator);
    if (group.directions == 5)
        return group.joints.has_screws
                   ? dca::make_joint_solver<5, true>(group, executor, communicator)
                   : dca::make_joint_solver<5, false>(group, executor, communicator);
    return group.joints.has_screws
               ? dca::make_joint_solver<6, true>(group, executor, communicator)
               : dca::make_joint_solver<6, false>(group, executor, communicator);
}

}  // namespace

/// Selects the host solver by handles, coordinates, number of directions and loops.
std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const& group, Executor const& executor,
                                              Communicator const& communicator) {
    auto open = make_open_solver(group, executor, communicator);
    if (!group.loops.in_scene) return open;
    return std::make_unique<dca::LoopedSolver>(group, std::move(open));
}

}  // namespace catena
