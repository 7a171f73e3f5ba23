// A part of the periodic box that chains without a place are put into: slabs and droplets.
#pragma once

#include <optional>
#include <vector>

#include "reader/chains.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// `fill: [a, b, c]` of `box: {periodic: [...]}`: edges of a region around the middle of the box;
/// nothing where there is none. InputError where an edge is longer than the box's.
std::optional<Vec3> read_fill(Node const& box);

/// As give_places(), into the region: chains stand or are packed as in a periodic box of its size,
/// the centre of each within the region; what of a chain is beyond its sides stands out of it.
/// InputError, at `box`, for chains that have a place or are not of free beads.
void fill_region(std::vector<Draft>& drafts, Vec3 const& box, Vec3 const& fill, Node const& node,
                 std::uint64_t seed);

}  // namespace catena::scene
