// What no single section can say: do chains, forces and dynamics go together?
#pragma once

#include <vector>

#include "reader/chains.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Throws InputError for combinations that cannot be computed. `scene` has everything but the
/// chains, which are in `drafts`.
void check_together(Node const& root, Scene const& scene, std::vector<Draft> const& drafts);

}  // namespace catena::scene
