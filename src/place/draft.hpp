// Chains of a scene before they have a place.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "generate/conformation.hpp"
#include "place/region.hpp"
#include "scene/node.hpp"
#include "scene/scene.hpp"

namespace catena::scene {

/// Permission to replace the shape of a movable chain, to find a place for it. `yes`: a free chain
/// of residues or nucleotides that is self-avoiding, or one of several copies without a given
/// shape. `if_asked`: other free chains of residues, which may be regrown only if the scene asks
/// for self-avoidance. `no`: all other chains.
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
    /// Region in which `place` puts the chain; none without `place`.
    std::optional<Region> region = std::nullopt;
    /// Distance that beads without a common link keep in packings, nm. The largest of all chains
    /// that grow in a box holds for all of them.
    double excluded = excluded_distance;
    /// For each cross-link, true if its length is the distance of the start; empty if all have
    /// lengths of their own.
    std::vector<bool> open_crosslinks = {};
};

}  // namespace catena::scene
