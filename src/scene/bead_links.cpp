// Implements the links between beads.
#include "scene/bead_links.hpp"

#include <algorithm>

#include "scene/branches.hpp"

namespace catena::scene {
namespace {

/// Returns the carried bead at a point of body k (relative to its centre of mass, body axes); -1 if
/// there is none.
std::int64_t bead_at(LinkedArrays const& linked, std::size_t k, Vec3 const& point) {
    // Relative rounding of positions that a file holds as decimals, rotated into body axes.
    double constexpr rounding = 1e-9;
    for (std::int64_t i = linked.carried.offset[k]; i < linked.carried.offset[k + 1]; ++i) {
        Vec3 const at = linked.carried.position[static_cast<std::size_t>(i)];
        if (norm(at - point) <= rounding * (norm(at) + norm(point))) return i;
    }
    return -1;
}

std::vector<BeadLink> links_of_bodies(ChainSpec const& chain) {
    LinkedArrays const& bodies = chain.linked;
    std::vector<BeadLink> links;
    if (bodies.carried.offset.size() != chain.size() + 1) return links;
    for (std::size_t k = chain.is_ring() ? 0 : 1; k < chain.size(); ++k) {
        std::size_t const before = k == 0 ? chain.size() - 1 : k - 1;
        std::int64_t const from = bead_at(bodies, before, bodies.outboard[before]),
                           to = bead_at(bodies, k, bodies.inboard[k]);
        if (from >= 0 && to >= 0)
            links.push_back({std::min(from, to), std::max(from, to),
                             k == 0 ? chain.tip_joint.length : bodies.length[k]});
    }
    return links;
}

}  // namespace

std::vector<BeadLink> bead_links(ChainSpec const& chain) {
    if (chain.is_linked()) return links_of_bodies(chain);
    std::vector<BeadLink> links;
    if (!chain.is_beads()) return links;
    for (std::size_t k = 1; k < chain.size(); ++k)
        links.push_back({static_cast<std::int64_t>(inboard_of(chain.parent, k)),
                         static_cast<std::int64_t>(k), chain.beads.length[k]});
    for (CrossLink const& link : chain.crosslinks)
        links.push_back({link.inboard, link.outboard, link.length});
    if (chain.is_ring())
        links.push_back({0, static_cast<std::int64_t>(chain.size()) - 1, chain.tip_joint.length});
    return links;
}

}  // namespace catena::scene
