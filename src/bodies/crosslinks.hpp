// Reader of the cross-links of a chain of point beads.
#pragma once

#include <vector>

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Reads the list `crosslinks` of a chain whose beads and tip are known. A length of 0 stands for
/// the distance at the start. Throws InputError for chains of other bodies or with a tip that is
/// not free, for beads that the chain does not have, and for two links between the same beads.
std::vector<CrossLink> read_crosslinks(Node const&, ChainSpec const&);

}  // namespace catena::scene
