// Collection of body data from all ranks on rank 0, in the order of the scene (all chains one after
// the other).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chain/chain_group.hpp"

namespace catena {

/// Gathers `width` numbers for each body of the group. `own` has those of this rank's bodies. Rank
/// 0 receives them in `in_scene_order`, which has `width` numbers for every body of the scene;
/// entries of other groups are unchanged. Collective.
void gather_to_scene(Communicator const&, ChainGroup const&, int width, std::span<double const> own,
                     std::vector<double>& in_scene_order);

}  // namespace catena
