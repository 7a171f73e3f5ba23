// The points of a chain that count where chains are given their places.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace catena::scene {

/// Beads; origins, centres of mass and carried beads of rigid bodies; ends of links in them.
struct Outline {
    std::vector<Vec3> points;
    double link = 0;  // the longest stretch between two of them along the chain
};
Outline outline_of(ChainSpec const& chain);

}  // namespace catena::scene
