// Instantiates the tree solver for handles in joint frames with 2 to 6 directions.
#include "cuda/space/device_solver.cuh"

namespace catena::cuda {

template <int K, bool sliding>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const& group, DeviceSpace const& space,
                                               Communicator const& communicator) {
    return make_solver<dca::BodyLeaf<K, dca::JointFrameHandles<K, sliding>>>(group, space,
                                                                             communicator);
}
template std::unique_ptr<ChainSolver> make_joint_solver<2, false>(ChainGroup const&,
                                                                  DeviceSpace const&,
                                                                  Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<3, false>(ChainGroup const&,
                                                                  DeviceSpace const&,
                                                                  Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<4, false>(ChainGroup const&,
                                                                  DeviceSpace const&,
                                                                  Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<5, false>(ChainGroup const&,
                                                                  DeviceSpace const&,
                                                                  Communicator const&);
template std::unique_ptr<ChainSolver> make_joint_solver<6, false>(ChainGroup const&,
                                                                  DeviceSpace const&,
                                                                  Communicator const&);

}  // namespace catena::cuda
