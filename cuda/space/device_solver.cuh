// Construction of tree solvers that work on a device's views.
#pragma once

#include <memory>

#include "cuda/space/device_space.cuh"
#include "dca/solvers/tree_solver.hpp"

namespace catena::cuda {

/// Makes the solver for any group. The group and the communicator must outlive it.
std::unique_ptr<ChainSolver> make_device_solver(ChainGroup const&, DeviceSpace const&,
                                                Communicator const&);

// Solvers by kind of handles; each is compiled in a file of its own to limit compile time.
std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const&, DeviceSpace const&,
                                              Communicator const&);
std::unique_ptr<ChainSolver> make_absolute_solver(ChainGroup const&, DeviceSpace const&,
                                                  Communicator const&);
std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const&, DeviceSpace const&,
                                                     Communicator const&);
template <int K, bool sliding>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const&, DeviceSpace const&,
                                               Communicator const&);

/// Makes the tree solver for one leaf type.
template <class Leaf>
std::unique_ptr<ChainSolver> make_solver(ChainGroup const& group, DeviceSpace const& space,
                                         Communicator const& communicator) {
    return std::make_unique<dca::TreeSolver<Leaf, DeviceSpace>>(group, space, communicator);
}

}  // namespace catena::cuda
