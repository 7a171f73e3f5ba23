// Converts a chain to the form that other programs for multibody dynamics read, and their answers
// to Catena's form.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace catena::command {

/// Returns why the table cannot hold a scene; empty if it can.
std::string not_for_peers(Scene const&);

/// Returns the table that tests/bench/peers/peer.py describes. Bodies on revolute and spherical
/// joints are written as they are. A free base becomes a massless body that slides along the
/// ground's axes, and a ball joint. Springs and dampers become their present torques. A chain of
/// beads becomes a sliding bead and massless rods on universal joints with a bead at their ends.
std::vector<double> peer_table(ChainSpec const&, Vec3 const& gravity);

/// Converts a peer's accelerations to Solution::acceleration; for beads to their accelerations.
/// Returns an empty list if the length is wrong.
std::vector<double> accelerations_of_peer(ChainSpec const&, std::vector<double> const& found);

}  // namespace catena::command
