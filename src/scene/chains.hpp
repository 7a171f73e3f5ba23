// One entry of `chains:` with all its copies.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// A chain of the scene before it has its place.
struct Draft {
    ChainSpec chain;
    Node const* node = nullptr;  // its entry in `chains`
    bool movable = false;        // the scene does not say where it stands
};

/// Reads the entry `index` (from 0) of `chains` into `count` chains and appends them. `scene` holds everything but the chains; `warm`: it
/// names a temperature, so that chains without velocities of their own start thermal. Throws InputError.
void read_chain(Node const& entry, std::size_t index, Scene const& scene, bool warm, std::vector<Draft>& drafts);

}  // namespace catena::scene
