// Motions that the joints of a loop allow, and how many directions the joint that closes it
// restricts.
#pragma once

#include "scene/scene.hpp"

namespace catena::scene {

/// Number of directions that the tip's joint restricts. Motions that the loop's other joints never
/// make do not count: loops in a plane lack three, loops with parallel axes that also slide along
/// them two. The loop is cut into two parts, each of which moves in the smallest group that
/// contains its joints, so a singular position at the start does not change the number. Loops of
/// more than 32 bodies are cut at the tip only. Mechanisms that move by their dimensions alone
/// (inputs/bricard.yaml) count as generic ones. Precondition: a chain of bodies with a jointed tip.
int restricted_by_tip(ChainSpec const& chain);

}  // namespace catena::scene
