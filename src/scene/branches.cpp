// Implements properties of branched chains.
#include "scene/branches.hpp"

#include <algorithm>

namespace catena::scene {

std::vector<std::int64_t> as_parents(std::vector<std::int64_t> inboard) {
    std::int64_t before = -1;
    for (std::int64_t const parent : inboard)
        if (parent != before++) return inboard;
    return {};
}

std::vector<std::array<std::int64_t, 2>> ends_of_crosslinks(ChainSpec const& chain) {
    std::vector<std::array<std::int64_t, 2>> ends;
    for (CrossLink const& link : chain.crosslinks) ends.push_back({link.inboard, link.outboard});
    return ends;
}

std::int64_t height_of(ChainSpec const& chain) {
    std::vector<std::int64_t> height(chain.size(), 0);
    std::int64_t most = 0;
    for (std::size_t k = 1; k < chain.size(); ++k) {
        height[k] = height[inboard_of(chain.parent, k)] + 1;
        most = std::max(most, height[k]);
    }
    return most;
}

std::int64_t ends_of(ChainSpec const& chain) {
    std::vector<bool> carries(chain.size(), false);
    for (std::size_t k = 1; k < chain.size(); ++k) carries[inboard_of(chain.parent, k)] = true;
    return std::count(carries.begin(), carries.end(), false);
}

}  // namespace catena::scene
