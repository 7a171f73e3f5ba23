// Implements the reader of cross-links.
#include "bodies/crosslinks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "scene/branches.hpp"
#include "scene/fields.hpp"

namespace catena::scene {
namespace {

constexpr char const* example =
    "write pairs of bead numbers, [[3, 9], [1, 12]], or [3, 9, 0.5] with a length";

void refuse_chain(Node const& node, ChainSpec const& chain) {
    if (!chain.is_beads())
        fail(node, "cross-links in a chain that has rigid bodies",
             "leave them out: cross-links join point beads on links");
    if (chain.tip != Tip::free)
        fail(node, "cross-links in a chain whose tip is not free",
             chain.is_ring()
                 ? fmt::format("leave out `tip` and close the ring by the cross-link [1, {}]",
                               chain.size())
                 : std::string("leave out `tip`, or the cross-links"));
}

/// Reads the number of a bead, from 1, and returns it from 0.
std::int64_t bead_of(Node const& number, std::int64_t beads) {
    std::int64_t const bead = whole(number, INT64_MIN);
    if (bead < 1 || bead > beads)
        fail(number, fmt::format("a cross-link ends at bead {} of {}", bead, beads),
             "count the beads of this chain from 1");
    return bead - 1;
}

/// Throws InputError if a link joins the beads already.
void refuse_linked(Node const& item, ChainSpec const& chain, CrossLink const& link) {
    if (link.inboard == link.outboard)
        fail(item, fmt::format("a cross-link joins bead {} to itself", link.inboard + 1),
             "give two beads");
    auto const on = static_cast<std::int64_t>(
        inboard_of(chain.parent, static_cast<std::size_t>(link.outboard)));
    if (on == link.inboard)
        fail(
            item,
            fmt::format("beads {} and {} have a link already", link.inboard + 1, link.outboard + 1),
            "leave this cross-link out");
}

}  // namespace

std::vector<CrossLink> read_crosslinks(Node const& node, ChainSpec const& chain) {
    refuse_chain(node, chain);
    auto const beads = static_cast<std::int64_t>(chain.size());
    std::vector<CrossLink> links;
    std::set<std::pair<std::int64_t, std::int64_t>> joined;
    for (Node const& item : list(node).items) {
        if (item.kind != Node::Kind::list || item.items.size() < 2 || item.items.size() > 3)
            fail(item, "a cross-link is a list of two beads, and a length if it has one", example);
        auto const [low, high] =
            std::minmax({bead_of(item.items[0], beads), bead_of(item.items[1], beads)});
        CrossLink const link{low, high, item.items.size() > 2 ? positive(item.items[2]) : 0};
        refuse_linked(item, chain, link);
        if (!joined.emplace(low, high).second)
            fail(item, fmt::format("beads {} and {} have two cross-links", low + 1, high + 1),
                 "keep one of them");
        links.push_back(link);
    }
    return links;
}

}  // namespace catena::scene
