// The tree solver whose views are of a device.
#pragma once

#include <memory>

#include "cuda/space/device_space.cuh"
#include "dca/solvers/tree_solver.hpp"

namespace catena::cuda {

/// For any group. The group and the communicator must outlive it.
std::unique_ptr<ChainSolver> make_device_solver(ChainGroup const&, DeviceSpace const&,
                                                Communicator const&);

// Its parts, compiled one by one.
std::unique_ptr<ChainSolver> make_bead_solver(ChainGroup const&, DeviceSpace const&,
                                              Communicator const&);
std::unique_ptr<ChainSolver> make_absolute_solver(ChainGroup const&, DeviceSpace const&,
                                                  Communicator const&);
std::unique_ptr<ChainSolver> make_articulated_solver(ChainGroup const&, DeviceSpace const&,
                                                     Communicator const&);
template <int K, bool sliding>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const&, DeviceSpace const&,
                                               Communicator const&);

template <class Leaf>
std::unique_ptr<ChainSolver> make_solver(ChainGroup const& group, DeviceSpace const& space,
                                         Communicator const& communicator) {
    return std::make_unique<dca::TreeSolver<Leaf, DeviceSpace>>(group, space, communicator);
}

}  // namespace catena::cuda
