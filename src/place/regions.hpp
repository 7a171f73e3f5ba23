// Placement of chains in the regions that `place` names.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "place/draft.hpp"

namespace catena::scene {

/// Returns the first `place` that applies to a draft, or nullptr.
Node const* first_place(std::vector<Draft> const& drafts);

/// Places all movable drafts in their regions, or anywhere in the box where no `place` applies.
/// Chains with a shape of their own are inserted first (insertion.hpp), then the others grow around
/// them (packing.hpp). Drafts with positions stay where they are. Throws InputError where chains do
/// not fit, for chains of bodies on joints, for a `place` that moves nothing, and without a box.
void place_in_regions(std::vector<Draft>& drafts, std::optional<Vec3> const& box,
                      std::uint64_t seed);

}  // namespace catena::scene
