// From the bodies of the ranks to arrays in the order of the scene (all chains one after the
// other), on rank 0.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "chain/chain_group.hpp"

namespace catena {

/// `own`: `width` numbers for each of this rank's bodies. On rank 0 they land in `in_scene_order`
/// (width numbers for every body of the scene; entries of other groups are left alone). Collective.
void gather_to_scene(Communicator const&, ChainGroup const&, int width, std::span<double const> own,
                     std::vector<double>& in_scene_order);

}  // namespace catena
