// A chain as other programs for multibody dynamics take it, and their answer as Catena gives it.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

/// Why the table cannot hold a scene; empty: it can.
std::string not_for_peers(Scene const&);

/// The table that tests/bench/peers/peer.py describes. Bodies on revolute and spherical joints; a
/// free base becomes a body without mass that slides along the ground's axes and a ball joint;
/// springs and dampers become the torques that they have now. Beads on links and a free base, which
/// become a bead that slides and rods without mass on universal joints, bead at their end.
std::vector<double> peer_table(ChainSpec const&, Vec3 const& gravity);

/// What a peer found for the table, as Solution::acceleration: of beads, their accelerations. Empty
/// where it is of another length.
std::vector<double> accelerations_of_peer(ChainSpec const&, std::vector<double> const& found);

}  // namespace catena::command
