#include "cuda/solver.hpp"

namespace catena::cuda {

std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const&, Communicator const&);
std::unique_ptr<ChainSolver> make_absolute_solver(ChainGroup const&, Communicator const&);
template <int K>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const&, Communicator const&);
template <int K>
std::unique_ptr<ChainSolver> make_sliding_solver(ChainGroup const&, Communicator const&);

std::unique_ptr<ChainSolver> make_tree_solver(ChainGroup const& group, Communicator const& communicator) {
    if (group.beads) return make_bead_solver(group, communicator);
    if (group.axes == Axes::world) return make_absolute_solver(group, communicator);
    switch (group.directions) {
        case 2:
            return make_joint_solver<2>(group, communicator);
        case 3:
            return make_joint_solver<3>(group, communicator);
        case 4:
            return make_joint_solver<4>(group, communicator);
        case 5:
            return group.has_screws ? make_sliding_solver<5>(group, communicator) : make_joint_solver<5>(group, communicator);
        default:
            return group.has_screws ? make_sliding_solver<6>(group, communicator) : make_joint_solver<6>(group, communicator);
    }
}

}  // namespace catena::cuda
