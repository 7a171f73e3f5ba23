// Motion of a whole chain to its place.
#pragma once

#include "math/linear.hpp"
#include "math/rotation.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Translates a chain, its anchors included.
void translate(ChainSpec& chain, Vec3 const& by);

/// True if a chain may be rotated: beads, or bodies on links, that nothing attaches to the ground.
bool is_rotatable(ChainSpec const& chain);
/// Rotates a chain about a point, its velocities included. Precondition: is_rotatable().
void rotate(ChainSpec& chain, Quat const& rotation, Vec3 const& about);

}  // namespace catena::scene
