// Points of a chain that decide its place among other chains.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace catena::scene {

/// Points of a chain: beads; origins, centres of mass and carried beads of rigid bodies; ends of
/// links.
struct Outline {
    std::vector<Vec3> points;
    /// Longest distance between two points that are neighbours along the chain.
    double link = 0;
};
Outline outline_of(ChainSpec const& chain);

}  // namespace catena::scene
