#include "dca/tree_solver.hpp"

namespace catena {
namespace dca {

std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const&, Executor const&, Communicator const&);

namespace {

template <int K>
std::unique_ptr<ChainSolver> make_body_solver(ChainGroup const& group, Executor const& executor, Communicator const& communicator) {
    if (group.axes == Axes::joint) return std::make_unique<TreeSolver<BodyLeaf<K, Axes::joint>>>(group, executor, communicator);
    return std::make_unique<TreeSolver<BodyLeaf<K, Axes::world>>>(group, executor, communicator);
}

}  // namespace
}  // namespace dca

std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const& group, Executor const& executor, Communicator const& communicator) {
    if (group.beads) return dca::make_bead_solver(group, executor, communicator);
    if (group.directions == 3) return dca::make_body_solver<3>(group, executor, communicator);
    if (group.directions == 5) return dca::make_body_solver<5>(group, executor, communicator);
    return dca::make_body_solver<6>(group, executor, communicator);
}

}  // namespace catena
