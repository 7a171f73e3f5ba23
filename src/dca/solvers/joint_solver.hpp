// The host's tree solvers of chains in joint coordinates, one per kind of handle.
#pragma once

#include <memory>

#include "dca/solver.hpp"

namespace catena::dca {

/// Makes the tree solver of floating runs whose handles carry K directions. `sliding`: some
/// joints translate. Instantiated for K = 2 to 6, `sliding` for 5 and 6, in one source per group of
/// kinds, so that compilers work on them side by side.
template <int K, bool sliding>
std::unique_ptr<ChainSolver> make_joint_solver(ChainGroup const& group, Executor const& executor,
                                               Communicator const& communicator);

}  // namespace catena::dca
