// Gives a place to the chains that have none: side by side, none within reach of another.
#pragma once

#include <optional>
#include <vector>

#include "scene/chains.hpp"

namespace catena::scene {

/// Moves the movable drafts onto a cubic grid whose cells are as wide as the largest of them (bounding sphere) and a gap of two links more,
/// leaving out cells that reach chains with a place of their own. Without a box the grid is centred on the origin and grows as needed; a
/// lone chain then lies at the origin. In a periodic box (whole chains, not only their middles, stay clear of their images) InputError when
/// they do not fit.
void place_side_by_side(std::vector<Draft>& drafts, std::optional<Vec3> const& box);

}  // namespace catena::scene
