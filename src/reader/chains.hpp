// One entry of `chains:` with all its copies.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Whether a chain without a place may take another shape to find one: a free chain of residues may
/// where it is self-avoiding or one of several copies whose shape the scene does not say; others of
/// them may if the scene asks for self-avoidance instead.
enum class Regrowth : std::uint8_t { no, if_asked, yes };

/// A chain of the scene before it has its place.
struct Draft {
    ChainSpec chain;
    Node const* node = nullptr;  // its entry in `chains`
    bool movable = false;        // the scene does not say where it stands
    Regrowth regrown = Regrowth::no;
    std::int64_t particle = 0;  // of its first bead in the System that the scene names
    double bytes = 0;           // of the last of an entry: estimate for all chains up to it
};

class WrittenSystem;

/// Reads the entry `index` (from 0) of `chains` into `count` chains and appends them. `scene` holds
/// everything but the chains; `warm`: it names a temperature, so that chains without velocities of
/// their own start thermal. `system`: beside which they are written, or nullptr. Throws InputError.
void read_chain(Node const& entry, std::size_t index, Scene& scene, bool warm,
                WrittenSystem const* system, std::vector<Draft>& drafts);

}  // namespace catena::scene
