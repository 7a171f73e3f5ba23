// Implements the filling of slabs and droplets. The region is treated as a periodic box of its own
// size, which also keeps chains apart across its sides.
#include "place/filling.hpp"

#include <fmt/format.h>

#include <cmath>

#include "place/placement.hpp"
#include "scene/fields.hpp"

namespace catena::scene {

namespace {

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

void fill_region(std::vector<Draft>& drafts, Vec3 const& box, Vec3 const& fill, Node const& node,
                 std::uint64_t seed) {
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
    give_places(drafts, fill, seed, "the region to fill");
    for (Draft& draft : drafts) bring_in(draft.chain.beads.position, box, fill);
}

}  // namespace catena::scene
