// Reader of one entry of `chains:` with all its copies.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Permission to replace the shape of a movable chain, to find a place for it. `yes`: a free chain
/// of residues that is self-avoiding, or one of several copies without a given shape. `if_asked`:
/// other free chains of residues, which may be regrown only if the scene asks for self-avoidance.
/// `no`: all other chains.
enum class Regrowth : std::uint8_t { no, if_asked, yes };

/// A chain of the scene before it has a place.
struct Draft {
    /// The chain, at a preliminary place if it is movable.
    ChainSpec chain;
    Node const* node = nullptr;  // entry in `chains`
    /// True if the scene gives no place for the chain.
    bool movable = false;
    /// Permission to grow the chain into a new shape.
    Regrowth regrown = Regrowth::no;
    /// Number of the chain's first bead in the System that the scene names.
    std::int64_t particle = 0;
    /// Estimated memory of all chains up to this one, bytes; set for the last chain of an entry
    /// only.
    double bytes = 0;
};

class WrittenSystem;

/// Reads the entry `index` (from 0) of `chains` into `count` chains and appends them. `scene` holds
/// all sections except the chains. `warm` is true if the scene names a temperature; chains without
/// velocities then start thermal. `system` is the System named together with the chains, or
/// nullptr. Throws InputError.
void read_chain(Node const& entry, std::size_t index, Scene& scene, bool warm,
                WrittenSystem const* system, std::vector<Draft>& drafts);

}  // namespace catena::scene
