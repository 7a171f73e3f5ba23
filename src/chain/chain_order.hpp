// Order of the chains in a group, chosen so that the chains of one rank lie close together.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "math/linear.hpp"
#include "scene/scene.hpp"
#include "tree/load_balance.hpp"

namespace catena {

/// Chain and its position in space.
struct PlacedChain {
    int chain = 0;
    Vec3 middle =
        Vec3::zero();  // mean position of its points, wrapped into the box if there is one
    std::int64_t bodies = 0;
};

/// Returns the chains rank by rank. Space is cut recursively across its longest side into two
/// parts, each with the bodies of half the ranks. The chains of one rank ascend. `shares`: as in
/// dca::cut_by_shares().
std::vector<int> compact_order(std::vector<PlacedChain> chains, int ranks,
                               dca::Shares const& shares = {});

/// Returns the positions of chains at the start of the scene, for chains whose points are given in
/// W.
std::vector<PlacedChain> placed_chains(Scene const&, std::vector<int> const& chains);

}  // namespace catena
