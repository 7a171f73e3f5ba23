// Filling of a part of the periodic box with chains that have no place: slabs and droplets.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "place/draft.hpp"
#include "scene/node.hpp"

namespace catena::scene {

/// Reads `fill: [a, b, c]` of `box: {periodic: [...]}`: the edges of a region around the middle of
/// the box. Returns nothing without the key. Throws InputError for an edge longer than the box's.
std::optional<Vec3> read_fill(Node const& box);

/// Places the chains in the region as give_places() does in a periodic box of the same size. The
/// centre of each chain lies within the region; parts of chains may extend beyond its sides.
/// `least` and the sentence that is returned are those of give_places(). Throws InputError, at
/// `node`, for chains that have a place or are not free chains of beads, and for such parts that
/// meet across the box.
[[nodiscard]] std::string fill_region(std::vector<Draft>& drafts, Vec3 const& box, Vec3 const& fill,
                                      Node const& node, std::uint64_t seed, double least);

}  // namespace catena::scene
