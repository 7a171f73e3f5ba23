// Checks of the whole scene: compatibility of chains, forces and dynamics. Checks of single values
// are in the readers of their sections.
#pragma once

#include <vector>

#include "reader/chains.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Throws InputError for combinations that cannot be computed, and notes what output leaves out.
/// `scene` has all sections except the chains, which are in `drafts`.
void check_together(Node const& root, Scene& scene, std::vector<Draft> const& drafts);

}  // namespace catena::scene
