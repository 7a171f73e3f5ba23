// Reader of one entry of `chains:` with all its copies.
#pragma once

#include <vector>

#include "place/draft.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

class WrittenSystem;

/// Statements of other sections on all chains.
struct ChainContext {
    /// True if the scene names a temperature; chains without velocities then start thermal.
    bool warm = false;
    /// True if `start` replaces all positions by those of a frame.
    bool from_frame = false;
    /// The System named together with the chains, or nullptr.
    WrittenSystem const* system = nullptr;
};

/// Reads the entry `index` (from 0) of `chains` into `count` chains and appends them. `scene` holds
/// all sections except the chains. Throws InputError.
void read_chain(Node const& entry, std::size_t index, Scene& scene, ChainContext const&,
                std::vector<Draft>& drafts);

}  // namespace catena::scene
