// Reader of one entry of `chains:` with all its copies.
#pragma once

#include <vector>

#include "place/draft.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

class WrittenSystem;

/// Reads the entry `index` (from 0) of `chains` into `count` chains and appends them. `scene` holds
/// all sections except the chains. `warm` is true if the scene names a temperature; chains without
/// velocities then start thermal. `system` is the System named together with the chains, or
/// nullptr. Throws InputError.
void read_chain(Node const& entry, std::size_t index, Scene& scene, bool warm,
                WrittenSystem const* system, std::vector<Draft>& drafts);

}  // namespace catena::scene
