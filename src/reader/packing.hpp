// Chains of residues in a periodic box that is too full for whole coils side by side.
#pragma once

#include <cstdint>
#include <vector>

#include "reader/chains.hpp"

namespace catena::scene {

/// Grows the drafts that may be regrown anew in the box, among each other and around all others,
/// and relaxes them until no two beads, other than link neighbours, are nearer than the excluded
/// distance of self-avoiding chains, periodic images included. Positions come out unwrapped, links
/// exact to rounding. A function of drafts, box and seed alone. InputError when the beads' volume
/// or an edge of the box says that it cannot be, or relaxation came to no end; it calls the box by
/// its `name`. Precondition: one draft or more may be regrown.
void pack(std::vector<Draft>& drafts, Vec3 const& box, std::uint64_t seed, char const* name);

}  // namespace catena::scene
