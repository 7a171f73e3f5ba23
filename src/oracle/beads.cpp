#include <string>

#include "error.hpp"
#include "oracle/full_pivoting.hpp"
#include "oracle/joint.hpp"
#include "scene/branches.hpp"

// Articulated masses of point beads on rigid links. A bead and everything outboard of it respond to
// the force lambda u of the inboard link by M a + p = lambda u. The link exerts -lambda u on the
// inboard bead; the tension is -lambda.
namespace catena::oracle {
namespace {

/// Articulated mass M and bias force p of a bead, and the terms that eliminate its inboard link.
template <class S>
struct ArticulatedBead {
    M3<S> mass;
    V3<S> bias;
    /// Terms of lambda = (closure + drive + u . a_inboard) / compliance.
    S compliance = S(0), drive = S(0);
};

/// Factors the articulated mass of bead k. Throws ComputationError if it is not positive definite.
template <class S>
Cholesky<S, 3> factor(ArticulatedBead<S> const& bead, std::size_t k) {
    Cholesky<S, 3> const f(bead.mass);
    if (!f.definite())
        throw ComputationError("articulated mass is not positive definite (bead " +
                               std::to_string(k + 1) + "): check the beads' masses");
    return f;
}

/// Solves the chain without its tip link under `forces`.
template <class S>
OracleResult<S> open_chain(ChainSpec const& chain, std::vector<BeadLink<S>> const& links,
                           std::vector<V3<S>> const& forces) {
    std::size_t const n = chain.size(), first = chain.base == Base::fixed ? 0 : 1;
    std::vector<ArticulatedBead<S>> beads(n);
    for (std::size_t k = 0; k < n; ++k)
        beads[k] = {scaled(S(chain.beads.mass[k]), M3<S>::identity()), -forces[k], S(0), S(0)};
    // Inward pass: eliminate each link and add the outboard mass and bias to the inboard bead.
    for (std::size_t k = n; k-- > first;) {
        V3<S> const& u = links[k].direction;
        V3<S> const softness = factor(beads[k], k).solve(u);
        beads[k].compliance = dot(u, softness);
        beads[k].drive = dot(softness, beads[k].bias);
        if (k == 0) break;
        ArticulatedBead<S>& inboard = beads[scene::inboard_of(chain.parent, k)];
        inboard.mass = plus_outer(inboard.mass, S(S(1) / beads[k].compliance), u, u);
        inboard.bias = plus_scaled(inboard.bias,
                                   S((links[k].closure + beads[k].drive) / beads[k].compliance), u);
    }
    // Outward pass: link force, then acceleration, from the inboard bead's acceleration.
    OracleResult<S> result;
    for (std::size_t k = 0; k < n; ++k) {
        V3<S> const& u = links[k].direction;
        V3<S> a =
            k == 0 ? V3<S>::zero() : result.com_acceleration[scene::inboard_of(chain.parent, k)];
        S const lambda =
            k < first ? S(0)
                      : S((links[k].closure + beads[k].drive + dot(u, a)) / beads[k].compliance);
        a = factor(beads[k], k).solve(lambda * u - beads[k].bias);
        result.com_acceleration.push_back(a);
        result.tension.push_back(-lambda);
    }
    return result;
}

/// Acceleration of the last bead relative to the other end of the tip link.
template <class S>
V3<S> apart_at_tip(ChainSpec const& chain, OracleResult<S> const& r) {
    return chain.is_ring() ? r.com_acceleration.back() - r.com_acceleration.front()
                           : r.com_acceleration.back();
}

/// Compliance of the tip: acceleration along u per unit force along u on the last bead; in a ring,
/// the opposite force acts on the first bead.
template <class S>
S tip_compliance(ChainSpec const& chain, std::vector<BeadLink<S>> links) {
    V3<S> const u = links.back().direction;
    for (BeadLink<S>& link : links) link.closure = S(0);
    std::vector<V3<S>> push(chain.size(), V3<S>::zero());
    push.back() = u;
    if (chain.is_ring()) push.front() = -u;
    S const yields = dot(u, apart_at_tip(chain, open_chain(chain, links, push)));
    if (!(yields > S(0)))
        throw ComputationError("the tip link cannot move (bead " + std::to_string(chain.size()) +
                               "): a chain stretched straight between its ends has no solution");
    return yields;
}

/// Adds a pair of forces along a cross-link to those on its beads.
template <class S>
void push(CrossLink const& link, V3<S> const& force, std::vector<V3<S>>& forces) {
    V3<S>&to = forces[static_cast<std::size_t>(link.outboard)],
    &from = forces[static_cast<std::size_t>(link.inboard)];
    to = to + force, from = from - force;
}

/// Acceleration of a cross-link's ends along it, towards each other negative.
template <class S>
S apart(CrossLink const& link, V3<S> const& along, OracleResult<S> const& r) {
    return dot(along, r.com_acceleration[static_cast<std::size_t>(link.outboard)] -
                          r.com_acceleration[static_cast<std::size_t>(link.inboard)]);
}

/// Solves the chain with its cross-links by their Schur complement.
template <class S>
OracleResult<S> with_crosslinks(ChainSpec const& chain, std::vector<BeadLink<S>> const& links,
                                std::vector<V3<S>> forces) {
    std::vector<BeadLink<S>> const across = read_crosslinks<S>(chain);
    auto const count = static_cast<Index>(across.size());
    std::vector<BeadLink<S>> still = links;
    for (BeadLink<S>& link : still) link.closure = S(0);
    Dense<S> matrix(count, count);
    auto const at = [](Index i) { return static_cast<std::size_t>(i); };
    for (Index j = 0; j < count; ++j) {
        std::vector<V3<S>> pair(chain.size(), V3<S>::zero());
        push(chain.crosslinks[at(j)], across[at(j)].direction, pair);
        OracleResult<S> const r = open_chain(chain, still, pair);
        for (Index i = 0; i < count; ++i)
            matrix(i, j) = apart(chain.crosslinks[at(i)], across[at(i)].direction, r);
    }
    FullPivoting<S> const lu(matrix, S(0x1p-33));
    OracleResult<S> result = open_chain(chain, links, forces);
    result.crosslink_tension.assign(across.size(), S(0));
    // The second pass corrects the rounding errors of the first.
    for (int pass = 0; pass < 2; ++pass) {
        Column<S> open(count);
        for (Index i = 0; i < count; ++i)
            open[i] = across[at(i)].closure -
                      apart(chain.crosslinks[at(i)], across[at(i)].direction, result);
        Column<S> const force = lu.solve(open);
        std::vector<S> tension = result.crosslink_tension;
        for (Index i = 0; i < count; ++i) {
            tension[at(i)] -= force[i];
            push(chain.crosslinks[at(i)], S(force[i]) * across[at(i)].direction, forces);
        }
        result = open_chain(chain, links, forces);
        result.crosslink_tension = std::move(tension);
    }
    return result;
}

}  // namespace

template <class S>
OracleResult<S> aba_beads(ChainSpec const& chain, Loads const& loads) {
    std::vector<BeadLink<S>> links = read_bead_links<S>(chain);
    for (std::size_t k = 0; k < loads.link_gaps.size(); ++k)
        links[k].closure += S(loads.link_gaps[k]);
    std::vector<V3<S>> forces;
    for (std::size_t k = 0; k < chain.size(); ++k) forces.push_back(bead_force<S>(chain, loads, k));
    if (chain.is_cross_linked()) return with_crosslinks(chain, links, forces);
    OracleResult<S> result = open_chain(chain, links, forces);
    if (chain.tip != Tip::jointed) return result;
    V3<S> const u = links.back().direction, applied = forces.back(), on_first = forces.front();
    S const yields = tip_compliance(chain, links);
    S lambda(0);
    // The second pass corrects the rounding errors of the first.
    for (int pass = 0; pass < 2; ++pass) {
        lambda += (links.back().closure + dot(u, apart_at_tip(chain, result))) / yields;
        forces.back() = applied - lambda * u;
        if (chain.is_ring()) forces.front() = on_first + lambda * u;
        result = open_chain(chain, links, forces);
    }
    if (chain.is_ring()) result.tension.front() = -lambda;
    result.tip_force.force = -lambda * u;
    return result;
}

template OracleResult<double> aba_beads<double>(ChainSpec const&, Loads const&);
template OracleResult<long double> aba_beads<long double>(ChainSpec const&, Loads const&);
template OracleResult<Quad> aba_beads<Quad>(ChainSpec const&, Loads const&);

}  // namespace catena::oracle
