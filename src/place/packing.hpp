// Packing of chains of residues in a periodic box that is too dense for separate coils.
#pragma once

#include <cstdint>
#include <vector>

#include "place/draft.hpp"

namespace catena::scene {

/// Grows all drafts with Regrowth::yes anew in the box, among each other and around all others.
/// Relaxes them until no two beads, other than link neighbours, are closer than the largest
/// Draft::excluded of these drafts. Periodic images count, positions are not wrapped, and links
/// are exact to rounding. Beads of drafts with a region keep within its walls. The result depends
/// on drafts, box and seed alone. Throws InputError if the beads' volume, an edge of the box or a
/// region rules it out, or the relaxation fails. `name` is the box's name in messages.
/// Precondition: at least one draft has Regrowth::yes.
void pack(std::vector<Draft>& drafts, Vec3 const& box, std::uint64_t seed, char const* name);

}  // namespace catena::scene
