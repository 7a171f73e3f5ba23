#include "oracle/linked.hpp"
#include "oracle/system.hpp"
#include "scene/branches.hpp"

// Dense systems of chains on links: Newton's (and Euler's) equations of every body, and the second
// time derivative of every link's length.
namespace catena::oracle {

// Unknowns are three accelerations per bead, then one force per link.
template <class S>
OracleResult<S> dense_beads(ChainSpec const& chain, Loads const& loads) {
    std::vector<BeadLink<S>> const links = read_bead_links<S>(chain);
    auto const n = static_cast<Index>(chain.size()), count = static_cast<Index>(links.size());
    Index const first = chain.base == Base::fixed ? 0 : 1;
    std::vector<BeadLink<S>> const crosslinks = read_crosslinks<S>(chain);
    Index const across = 3 * n + count - first;
    System<S> s(across + static_cast<Index>(crosslinks.size()));
    for (Index k = 0; k < n; ++k) {
        auto const at = static_cast<std::size_t>(k);
        s.add(3 * k, 3 * k, scaled(S(chain.beads.mass[at]), M3<S>::identity()));
        s.add(3 * k, bead_force<S>(chain, loads, at));
    }
    for (Index k = first; k < count; ++k) {
        Index const row = 3 * n + k - first;
        BeadLink<S> const& link = links[static_cast<std::size_t>(k)];
        s.right[row] = link.closure;
        if (k < n) s.add_constraint(3 * k, row, S(1), link.direction);
        // The tip's link begins at the last bead.
        Index const inboard =
            k == n ? n - 1
                   : static_cast<Index>(
                         k == 0 ? 0 : scene::inboard_of(chain.parent, static_cast<std::size_t>(k)));
        if (k > 0) s.add_constraint(3 * inboard, row, S(-1), link.direction);
        if (k == n && chain.is_ring()) s.add_constraint(0, row, S(1), link.direction);
    }
    for (std::size_t c = 0; c < crosslinks.size(); ++c) {
        Index const row = across + static_cast<Index>(c);
        s.right[row] = crosslinks[c].closure;
        s.add_constraint(3 * chain.crosslinks[c].outboard, row, S(1), crosslinks[c].direction);
        s.add_constraint(3 * chain.crosslinks[c].inboard, row, S(-1), crosslinks[c].direction);
    }
    Column<S> const x = solve(s);
    OracleResult<S> result;
    for (Index row = across; row < x.size(); ++row) result.crosslink_tension.push_back(-x[row]);
    for (Index k = 0; k < n; ++k) {
        result.com_acceleration.push_back(segment(x, 3 * k));
        result.tension.push_back(k < first ? S(0) : S(-x[3 * n + k - first]));
    }
    if (count > n) result.tip_force.force = -x[3 * n + n - first] * links.back().direction;
    if (chain.is_ring()) result.tension.front() = -x[3 * n + n - first];
    return result;
}

// Unknowns are six accelerations per body, then one force per link.
template <class S>
OracleResult<S> dense_linked(ChainSpec const& chain, Loads const& loads) {
    LinkedModel<S> const model = read_linked<S>(chain, loads);
    auto const n = static_cast<Index>(chain.size()), count = static_cast<Index>(model.links.size()),
               first = static_cast<Index>(model.first);
    System<S> s(6 * n + count - first);
    for (Index k = 0; k < n; ++k) {
        LinkedBody<S> const& body = model.bodies[static_cast<std::size_t>(k)];
        s.add(6 * k, 6 * k, scaled(body.mass, M3<S>::identity()));
        s.add(6 * k + 3, 6 * k + 3, body.inertia);  // a bead has zero angular acceleration
        s.add(6 * k, body.force);
        s.add(6 * k + 3, body.torque);
    }
    for (Index k = first; k < count; ++k) {
        Index const row = 6 * n + k - first;
        BeadLink<S> const& link = model.links[static_cast<std::size_t>(k)];
        s.right[row] += link.closure;
        auto const add_end = [&](Index of, std::size_t end, S sign) {
            LinkedBody<S> const& body = model.bodies[static_cast<std::size_t>(of)];
            s.add_constraint(6 * of, row, sign, link.direction);
            s.add_constraint(6 * of + 3, row, sign, cross(body.end[end], link.direction));
            s.right[row] -= sign * dot(link.direction, body.centripetal(end));
        };
        if (k < n) add_end(k, 0, S(1));
        if (k > 0) add_end(k - 1, 1, S(-1));
        if (k == n && chain.is_ring()) add_end(0, 0, S(1));
    }
    Column<S> const x = solve(s);
    OracleResult<S> result;
    for (Index k = 0; k < n; ++k) {
        result.com_acceleration.push_back(segment(x, 6 * k));
        result.alpha.push_back(segment(x, 6 * k + 3));
        result.tension.push_back(k < first ? S(0) : S(-x[6 * n + k - first]));
    }
    if (count > n) result.tip_force.force = -x[6 * n + n - first] * model.links.back().direction;
    if (chain.is_ring()) result.tension.front() = -x[6 * n + n - first];
    return result;
}

#define CATENA_ORACLE(S)                                                     \
    template OracleResult<S> dense_beads<S>(ChainSpec const&, Loads const&); \
    template OracleResult<S> dense_linked<S>(ChainSpec const&, Loads const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE

}  // namespace catena::oracle
