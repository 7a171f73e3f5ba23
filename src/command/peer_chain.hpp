// A chain as other programs for multibody dynamics take it, and their answer as Catena gives it.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

/// The table that tests/bench/peers/peer.py describes. Bodies on a fixed base, on revolute and spherical joints; beads on links and a free
/// base, which become a bead that slides along the ground's axes and rods without mass on universal joints, bead at their end.
std::vector<double> peer_table(ChainSpec const&, Vec3 const& gravity);

/// What a peer found for the table, as Solution::acceleration: of beads, their accelerations. Empty where it is of another length.
std::vector<double> accelerations_of_peer(ChainSpec const&, std::vector<double> const& found);

}  // namespace catena::command
