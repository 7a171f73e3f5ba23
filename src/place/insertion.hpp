// Random places for chains that keep their shape.
#pragma once

#include <cstdint>
#include <vector>

#include "place/draft.hpp"

namespace catena::scene {

/// Places the movable drafts without Regrowth::yes at random places of their regions, the largest
/// first. Those that nothing attaches to the ground get random orientations. No bead comes nearer
/// to another chain, an image included, than 0.56 nm or the longest link. All points of a draft
/// keep within the walls of its region. The result depends on drafts, box and seed alone. Throws
/// InputError if a draft finds no place; for a slab the message gives a thickness that would do.
/// Precondition: every movable draft has a region and consists of beads or of bodies on links.
void insert_shapes(std::vector<Draft>& drafts, Vec3 const& box, std::uint64_t seed);

/// Does the same in the whole box, whatever the regions, and returns the number of drafts that
/// found a place. If not all of them did, it moves none. `least`: distance in place of 0.56 nm.
std::size_t insert_if_all_fit(std::vector<Draft>& drafts, Vec3 const& box, std::uint64_t seed,
                              double least);

}  // namespace catena::scene
