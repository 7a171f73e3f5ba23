#include "cuda/tree_solver.cuh"

namespace catena::cuda {

template <int K>
std::unique_ptr<ChainSolver> make_sliding_solver(ChainGroup const& group, Communicator const& communicator) {
    return std::make_unique<TreeSolver<dca::BodyLeaf<K, dca::MeetingFrames<K, true>>>>(group, communicator);
}
template std::unique_ptr<ChainSolver> make_sliding_solver<5>(ChainGroup const&, Communicator const&);
template std::unique_ptr<ChainSolver> make_sliding_solver<6>(ChainGroup const&, Communicator const&);

}  // namespace catena::cuda
