// Links between beads, and forces on beads.
#include "error.hpp"
#include "joints/joint_models.hpp"
#include "oracle/joint.hpp"
#include "scene/branches.hpp"
#include "terms/force_terms.hpp"

namespace catena::oracle {

Vec3 tip_anchor(ChainSpec const& chain) {
    if (!is_rod(chain.tip_joint.type) || !chain.tip_joint.anchor)
        throw ComputationError("a chain of links ends in a link to an anchor only (" + chain.name +
                               ": tip): give it type link and an anchor");
    return *chain.tip_joint.anchor;
}

template <class S>
BeadLink<S> bead_link(V3<S> const& along, V3<S> const& relative_velocity) {
    S const length = norm(along);
    V3<S> const u = S(S(1) / length) * along;
    V3<S> const across = relative_velocity - dot(relative_velocity, u) * u;
    return {u, -dot(across, across) / length};
}

template <class S>
std::vector<BeadLink<S>> read_bead_links(ChainSpec const& chain) {
    BeadArrays const& b = chain.beads;
    std::vector<BeadLink<S>> links(b.size());
    auto const x = [&](std::size_t k) { return lift<S>(b.position[k]); };
    auto const v = [&](std::size_t k) { return lift<S>(b.velocity[k]); };
    if (chain.base == Base::fixed) links[0] = bead_link(x(0) - lift<S>(b.anchor), v(0));
    for (std::size_t k = 1; k < b.size(); ++k) {
        std::size_t const p = scene::inboard_of(chain.parent, k);
        links[k] = bead_link(x(k) - x(p), v(k) - v(p));
    }
    std::size_t const last = b.size() - 1;
    if (chain.is_ring())
        links.push_back(bead_link(x(0) - x(last), v(0) - v(last)));
    else if (chain.tip == Tip::jointed)
        links.push_back(bead_link(lift<S>(tip_anchor(chain)) - x(last), -v(last)));
    return links;
}

template <class S>
std::vector<BeadLink<S>> read_crosslinks(ChainSpec const& chain) {
    BeadArrays const& b = chain.beads;
    std::vector<BeadLink<S>> links;
    for (CrossLink const& link : chain.crosslinks) {
        auto const from = static_cast<std::size_t>(link.inboard),
                   to = static_cast<std::size_t>(link.outboard);
        links.push_back(bead_link(lift<S>(b.position[to]) - lift<S>(b.position[from]),
                                  lift<S>(b.velocity[to]) - lift<S>(b.velocity[from])));
    }
    return links;
}

template <class S>
V3<S> bead_force(ChainSpec const& chain, Loads const& loads, std::size_t k) {
    V3<S> const weight = S(chain.beads.mass[k]) * lift<S>(loads.gravity) +
                         lift<S>(terms::constant_wrench(chain, k).second);
    V3<S> const drag = S(loads.linear_drag) * lift<S>(chain.beads.velocity[k]);
    return loads.bead_forces.empty() ? weight - drag
                                     : weight + lift<S>(loads.bead_forces[k]) - drag;
}

// NOLINTBEGIN(bugprone-macro-parentheses): S is a type
#define CATENA_ORACLE(S)                                                    \
    template BeadLink<S> bead_link<S>(V3<S> const&, V3<S> const&);          \
    template std::vector<BeadLink<S>> read_bead_links<S>(ChainSpec const&); \
    template std::vector<BeadLink<S>> read_crosslinks<S>(ChainSpec const&); \
    template V3<S> bead_force<S>(ChainSpec const&, Loads const&, std::size_t);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace catena::oracle
