// Placement of movable chains: next to each other, out of each other's reach, or packed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "generate/conformation.hpp"
#include "place/draft.hpp"

namespace catena::scene {

/// Moves the movable drafts onto a cubic grid. The width of its cells is that of the largest draft
/// (bounding sphere) plus a gap of two links. Cells in reach of chains with a place are left out.
/// Without a box the grid is centred on the origin and grows as needed; a single chain then lies at
/// the origin. In a periodic box whole chains, not only their centres, stay clear of their images.
/// If they do not fit, drafts with Regrowth::yes are packed (packing.hpp) around the others, and
/// those of beads and bodies on links that keep their shape are inserted at random places
/// (insertion.hpp): `least` is the smallest distance of their beads from those of other chains, or
/// the longest link if that is longer. Returns a sentence on random places, empty without any.
/// Throws InputError if that is impossible; `name` is the box's name in messages.
[[nodiscard]] std::string give_places(std::vector<Draft>& drafts, std::optional<Vec3> const& box,
                                      std::uint64_t seed, double least = excluded_distance,
                                      char const* name = "the box");

}  // namespace catena::scene
