// The definition behind joint_solver.hpp and the macro that instantiates it.
#pragma once

#include "dca/solvers/joint_solver.hpp"
#include "dca/solvers/tree_solver.hpp"

namespace catena::dca {

template <int K, bool sliding>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const& group, Executor const& executor,
                                               Communicator const& communicator) {
    return std::make_unique<TreeSolver<BodyLeaf<K, JointFrameHandles<K, sliding>>, HostSpace>>(
        group, HostSpace(executor), communicator);
}

}  // namespace catena::dca

#define CATENA_JOINT_SOLVER(K, sliding)                                  \
    template std::unique_ptr<ChainSolver> make_joint_solver<K, sliding>( \
        ChainGroup const&, Executor const&, Communicator const&);
