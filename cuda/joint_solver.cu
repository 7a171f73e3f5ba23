#include "cuda/tree_solver.cuh"

namespace catena::cuda {

template <int K>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const& group, Communicator const& communicator) {
    return std::make_unique<TreeSolver<dca::BodyLeaf<K, dca::MeetingFrames<K, false>>>>(group, communicator);
}
template std::unique_ptr<ChainSolver> make_joint_solver<2>(ChainGroup const&, Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<3>(ChainGroup const&, Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<4>(ChainGroup const&, Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<5>(ChainGroup const&, Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<6>(ChainGroup const&, Communicator const&);

}  // namespace catena::cuda
