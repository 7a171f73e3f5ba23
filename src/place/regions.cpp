// Implements the placement in regions.
#include "place/regions.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "place/insertion.hpp"
#include "place/packing.hpp"

namespace catena::scene {

namespace {

/// Throws InputError for a chain of its own place that cannot move, or whose kind has no place.
void refuse_unplaced(Draft const& draft) {
    Node const* const own = draft.node->find("place");
    if (own && !draft.movable)
        fail(*own,
             fmt::format("chain `{}` stands where its positions put it", shown(draft.chain.name)),
             "leave `place` out, or leave its positions out");
    bool const links = draft.chain.is_beads() || draft.chain.is_linked();
    Node const* const place = place_of(*draft.node);
    if (draft.movable && !links)
        fail(place ? *place : *draft.node,
             fmt::format("`place` moves chains of beads and of bodies on links, which chain `{}` "
                         "is not",
                         shown(draft.chain.name)),
             "leave `place` out, or give that chain a place by its `bodies`");
}

/// True if the chain may take any shape: it is free to regrow and no shape is asked for.
bool grows(Draft const& draft) {
    bool const shaped = draft.node->find("conformation") || draft.node->find("positions");
    return draft.regrown == Regrowth::yes || (draft.regrown == Regrowth::if_asked && !shaped);
}

}  // namespace

Node const* first_place(std::vector<Draft> const& drafts) {
    Node const* previous = nullptr;
    for (Draft const& draft : drafts) {
        // Copies of one entry share their node.
        if (draft.node == previous) continue;
        previous = draft.node;
        if (Node const* const place = place_of(*draft.node)) return place;
    }
    return nullptr;
}

void place_in_regions(std::vector<Draft>& drafts, std::optional<Vec3> const& box,
                      std::uint64_t seed) {
    Draft const* previous = nullptr;
    bool any = false, flexible = false;
    for (Draft& draft : drafts) {
        bool const copy = previous && previous->node == draft.node;
        if (!copy) refuse_unplaced(draft);
        if (draft.movable) {
            draft.region =
                copy && previous->region ? previous->region : region_of(*draft.node, box);
            any = any || draft.region->node;
            if (grows(draft)) draft.regrown = Regrowth::yes, flexible = true;
            if (draft.regrown == Regrowth::if_asked) draft.regrown = Regrowth::no;
        }
        previous = &draft;
    }
    if (!any)
        fail(*first_place(drafts), "`place` has no chain to place: all have positions",
             "leave it out");
    insert_shapes(drafts, *box, seed);
    if (flexible) pack(drafts, *box, seed, "the box");
}

}  // namespace catena::scene
