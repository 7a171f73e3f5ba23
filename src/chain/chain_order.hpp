// In which order a group takes its chains, so that those of a rank lie together.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "math/linear.hpp"
#include "scene/scene.hpp"
#include "tree/load_balance.hpp"

namespace catena {

struct PlacedChain {
    int chain = 0;
    Vec3 middle = Vec3::zero();  // in the box, where there is one
    std::int64_t bodies = 0;
};

/// The chains rank by rank: space is cut across its longest side into two parts with the bodies of
/// half the ranks each, and so on; a rank's own chains ascend. `shares`: as dca::cut_by_shares()
/// has them.
std::vector<int> compact_order(std::vector<PlacedChain> chains, int ranks,
                               dca::Shares const& shares = {});

/// Where the chains of a scene stand at its start; for those of points in W.
std::vector<PlacedChain> placed_chains(Scene const&, std::vector<int> const& chains);

}  // namespace catena
