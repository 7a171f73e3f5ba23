// Gives a place to the chains that have none: side by side, none within reach of another, or
// packed.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reader/chains.hpp"

namespace catena::scene {

/// Moves the movable drafts onto a cubic grid whose cells are as wide as the largest of them
/// (bounding sphere) and a gap of two links more, leaving out cells that reach chains with a place
/// of their own. Without a box the grid is centred on the origin and grows as needed; a lone chain
/// then lies at the origin. In a periodic box whole chains, not only their middles, stay clear of
/// their images; where they do not fit, those that may be regrown are packed (packing.hpp) around
/// the others. InputError when that is impossible, which calls the box by its `name`.
void give_places(std::vector<Draft>& drafts, std::optional<Vec3> const& box, std::uint64_t seed,
                 char const* name = "the box");

}  // namespace catena::scene
