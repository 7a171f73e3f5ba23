// Motions that the joints of a loop allow, and how many directions the joint that closes it
// restricts.
#pragma once

#include "scene/scene.hpp"

namespace catena::scene {

/// Number of directions that the tip's joint restricts. Motions that the other joints of the loop
/// never make do not count: planar chains lack three, chains with parallel axes that also slide
/// along them lack two. The other joints' motions are those of the smallest group that contains
/// them all, so a singular position at the start does not change the number. Mechanisms that
/// move by their dimensions alone (inputs/bricard.yaml) count as generic ones. Precondition: a
/// chain of bodies with a jointed tip.
int restricted_by_tip(ChainSpec const& chain);

}  // namespace catena::scene
