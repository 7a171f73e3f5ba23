#include "cuda/tree_solver.cuh"

namespace catena::cuda {

std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const& group, Communicator const& communicator) {
    if (group.directions == 1) return std::make_unique<TreeSolver<dca::BeadLeaf<1>>>(group, communicator);
    return std::make_unique<TreeSolver<dca::BeadLeaf<3>>>(group, communicator);
}

std::unique_ptr<ChainSolver> make_absolute_solver(ChainGroup const& group, Communicator const& communicator) {
    using namespace dca;
    if (group.linked && group.directions == 1) return std::make_unique<TreeSolver<BodyLeaf<1, LinkFrames<1>>>>(group, communicator);
    if (group.linked) return std::make_unique<TreeSolver<BodyLeaf<3, LinkFrames<3>>>>(group, communicator);
    if (group.directions == 3) return std::make_unique<TreeSolver<BodyLeaf<3, GroundFrames<3>>>>(group, communicator);
    return std::make_unique<TreeSolver<BodyLeaf<6, GroundFrames<6>>>>(group, communicator);
}

}  // namespace catena::cuda
