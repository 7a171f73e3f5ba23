// Reader of the joints that close loops of rigid bodies.
#pragma once

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Most directions that the loops of one chain may restrict: the solver factorises a square matrix
/// of that size in every evaluation.
inline constexpr std::int64_t most_loop_directions = 2000;

/// Reads the list `loops` of a chain whose bodies and tip are known, fixes the frames G where the
/// start puts them, and counts redundant directions. A loop that is open at its `end` within
/// `closable` is noted in the scene; a wider opening throws InputError. So do chains of other
/// bodies or with a tip that is not free, bodies that the chain does not have, and too many loops.
void close_loops(ChainSpec&, Node const& loops, Scene& scene);

}  // namespace catena::scene
