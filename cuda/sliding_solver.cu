// Instantiates the tree solver for chains with joints that translate (5 or 6 directions).
#include "cuda/space/device_solver.cuh"

namespace catena::cuda {

template <int K, bool sliding>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const& group, DeviceSpace const& space,
                                               Communicator const& communicator) {
    return make_solver<dca::BodyLeaf<K, dca::JointFrameHandles<K, sliding>>>(group, space,
                                                                             communicator);
}
template std::unique_ptr<ChainSolver> make_joint_solver<5, true>(ChainGroup const&,
                                                                 DeviceSpace const&,
                                                                 Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<6, true>(ChainGroup const&,
                                                                 DeviceSpace const&,
                                                                 Communicator const&);

}  // namespace catena::cuda
