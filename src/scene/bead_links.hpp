// Rigid links between the beads of a chain.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.hpp"

namespace catena::scene {

/// A link between two beads, counted from 0 within their chain.
struct BeadLink {
    std::int64_t inboard, outboard;
    /// Length, nm.
    double length;
};

/// Returns the links of a chain that begin and end at beads: those to inboard beads, cross-links,
/// and the link that closes a ring last or, for bodies, first. Links of bodies that begin or end
/// elsewhere are left out.
std::vector<BeadLink> bead_links(ChainSpec const& chain);

}  // namespace catena::scene
