// Implements the filling of slabs and droplets. The region is treated as a periodic box of its own
// size, which also keeps chains apart across its sides.
#include "place/filling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "generate/nearest.hpp"
#include "place/placement.hpp"
#include "scene/fields.hpp"

namespace catena::scene {

namespace {

/// Distance of beads of two chains that overlap, relative to the longest link.
double constexpr touching = 0.75;

/// Moves a chain by whole edges of the region. Its centre then lies in the region in the middle of
/// the box.
void bring_in(std::vector<Vec3>& positions, Vec3 const& box, Vec3 const& fill) {
    Vec3 centre = Vec3::zero(), shift;
    for (Vec3 const& position : positions) centre = centre + position;
    centre = (1 / static_cast<double>(positions.size())) * centre;
    for (int i = 0; i < 3; ++i)
        shift[i] = 0.5 * (box[i] - fill[i]) - fill[i] * std::floor(centre[i] / fill[i]);
    for (Vec3& position : positions) position = position + shift;
}

/// Throws InputError for beads of different chains that meet outside the region: ends that stand
/// out at one side and, across the box, at the other.
void refuse_meeting(std::vector<Draft> const& drafts, Vec3 const& box, Node const& node) {
    std::vector<Vec3> points;
    std::vector<std::size_t> chain;
    double link = 0;
    for (std::size_t d = 0; d < drafts.size(); ++d) {
        for (double const length : drafts[d].chain.beads.length) link = std::max(link, length);
        for (Vec3 const& position : drafts[d].chain.beads.position)
            points.push_back(position), chain.push_back(d);
    }
    if (link == 0) return;
    auto const met = nearest_pair(points, box, touching * link, [&](std::size_t i, std::size_t j) {
        return chain[i] != chain[j];
    });
    if (met)
        fail(node,
             fmt::format("ends of chains `{}` and `{}` stand out of the region and meet across the "
                         "box, {:.3g} nm apart",
                         shown(drafts[chain[met->first]].chain.name),
                         shown(drafts[chain[met->second]].chain.name), met->distance),
             "write `place: {region: ...}`, which keeps all beads inside, or give a longer box");
}

}  // namespace

std::optional<Vec3> read_fill(Node const& box) {
    Node const* const fill = box.kind == Node::Kind::map ? box.find("fill") : nullptr;
    if (!fill) return std::nullopt;
    Vec3 const region = vector3(*fill), edges = vector3(*box.find("periodic"));
    for (int i = 0; i < 3; ++i) {
        if (!(region[i] > 0))
            fail(*fill, fmt::format("edge {} is not positive", region[i]),
                 "give three edges above 0");
        if (region[i] > edges[i])
            fail(*fill, fmt::format("edge {} is longer than the box's, {}", region[i], edges[i]),
                 "give edges within the box");
    }
    return region;
}

std::string fill_region(std::vector<Draft>& drafts, Vec3 const& box, Vec3 const& fill,
                        Node const& node, std::uint64_t seed, double least) {
    for (Draft const& draft : drafts)
        if (!draft.movable || !draft.chain.is_beads() || draft.chain.base == Base::fixed ||
            draft.chain.tip != Tip::free)
            fail(
                node,
                fmt::format(
                    "`fill` is for free chains of beads without positions, which chain `{}` is not",
                    shown(draft.chain.name)),
                "leave `fill` out, or leave the placement of every chain to the scene");
    // The region is packed as a periodic box of its own, then its chains are moved into the middle.
    std::string note = give_places(drafts, fill, seed, least, "the region to fill");
    for (Draft& draft : drafts) bring_in(draft.chain.beads.position, box, fill);
    refuse_meeting(drafts, box, node);
    return note;
}

}  // namespace catena::scene
