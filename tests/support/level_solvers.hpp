// The tree cut at every level: each cut must leave the bits of the backend `serial`.
#pragma once

#include "dca/level_solver.hpp"

namespace catena::test {

/// One evaluation of the scene by `serial`'s solver; on the very same inputs every cut of the tree
/// into `lower` and the host's levels must give the same bits, and refuse with the same words what
/// is refused. `many`: each pair of UP and DOWN, else equal ones and some pairs. Collective.
void expect_same_bits_at_every_cut(Scene const&, Axes, Handles, dca::LevelPartMaker const& lower,
                                   Communicator const&, bool many = false);

}  // namespace catena::test
