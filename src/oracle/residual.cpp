// Residuals of given accelerations by inverse dynamics.
#include <Eigen/QR>

#include "error.hpp"
#include "joints/joint_models.hpp"
#include "oracle/eigen.hpp"
#include "oracle/inverse.hpp"
#include "scene/branches.hpp"

namespace catena::oracle {
namespace {

/// Returns error / size, and 0 for size 0.
template <class S>
S ratio(S error, S size) {
    return size > S(0) ? S(error / size) : S(0);
}

/// Residual along the coordinates of one joint: required minus given efforts, over the largest term
/// of its balances: of forces if it translates, of moments if it rotates.
template <class S>
S joint_residual(Link<S> const& link, V3<S> const& needed, InverseBody<S> const& body) {
    S size = norm(link.effort);
    for (int i = 0; i < link.dof; ++i) {
        Motion<S> const& p = link.free[static_cast<std::size_t>(i)];
        if (norm(p.angular) > S(0)) size = std::max(size, body.torque.largest);
        if (norm(p.linear) > S(0)) size = std::max(size, S(norm(p.linear) * body.force.largest));
    }
    return ratio(norm(needed - link.effort), size);
}

/// Returns required minus given efforts along all coordinates and, for a free base, the force
/// balance of the whole chain.
template <class S>
std::vector<S> errors(std::vector<Link<S>> const& links, Inverse<S> const& inverse,
                      std::vector<InverseBody<S>> const& bodies) {
    std::vector<S> all;
    for (std::size_t k = 0; k < links.size(); ++k) {
        V3<S> const error = inverse.needed(k, bodies[k]) - links[k].effort;
        for (int i = 0; i < links[k].unknown(); ++i) all.push_back(error[i]);
        for (int i = 0; i < 3 && floats(links[k].type); ++i) all.push_back(bodies[k].force.sum[i]);
    }
    return all;
}

template <class S>
Column<S> as_column(std::vector<S> const& values) {
    return Eigen::Map<Column<S> const>(values.data(), static_cast<Index>(values.size()));
}

/// Sets the wrenches on the end bodies for given components of the tip wrench.
template <class S>
void push(Inverse<S>& inverse, TipClosure<S> const& tip, std::vector<S> const& components) {
    inverse.push_ends(tip_wrench(tip, components, V3<S>::zero()),
                      wrench_on_first(tip, components, tip.first_arm));
}

/// Returns the components of the tip joint's wrench that fit the accelerations best.
template <class S>
std::vector<S> best_tip(TipClosure<S> const& tip, std::vector<Link<S>> const& links,
                        Inverse<S> inverse, std::vector<V3<S>> const& qdd,
                        V3<S> const& base_acceleration) {
    auto const error = [&](std::vector<S> const& components) {
        push(inverse, tip, components);
        return as_column(errors(links, inverse, inverse(qdd, base_acceleration)));
    };
    std::vector<S> const none(tip.locked.size(), S(0));
    Column<S> const open = error(none);
    // The errors depend linearly on the components: column j is the change per unit of component j.
    Dense<S> response(open.size(), static_cast<Index>(none.size()));
    for (std::size_t j = 0; j < none.size(); ++j) {
        std::vector<S> one = none;
        one[j] = S(1);
        response.col(static_cast<Index>(j)) = error(one) - open;
    }
    if (open.size() == 0 || none.empty()) return none;
    // The columns are differences of large numbers. A column below the threshold is rounding error,
    // of a component that affects no coordinate.
    Eigen::ColPivHouseholderQR<Dense<S>> responses;
    responses.setThreshold(S(1e-9));
    Column<S> const found = responses.compute(response).solve(-open);
    return {found.data(), found.data() + found.size()};
}

/// Residual of a chain of rigid bodies.
template <class S>
S residual_of_bodies(ChainSpec const& chain, Loads const& loads, std::vector<V3<S>> const& qdd,
                     V3<S> const& base_acceleration) {
    std::vector<Link<S>> const links = read_links<S>(chain, loads);
    Inverse<S> inverse(links, lift<S>(loads.gravity));
    if (chain.tip == Tip::jointed) {
        TipClosure<S> const tip = read_tip(chain, links, attitudes(links));
        push(inverse, tip, best_tip(tip, links, inverse, qdd, base_acceleration));
    }
    std::vector<InverseBody<S>> const bodies = inverse(qdd, base_acceleration);
    S worst(0);
    for (std::size_t k = 0; k < links.size(); ++k) {
        if (links[k].unknown() > 0)
            worst =
                std::max(worst, joint_residual(links[k], inverse.needed(k, bodies[k]), bodies[k]));
        if (floats(links[k].type))
            worst = std::max(worst, ratio(norm(bodies[k].force.sum), bodies[k].force.largest));
    }
    return worst;
}

/// Returns the force balances of the beads from the last to the first, with the force `pushed` on
/// the last. `left` receives each balance without the component that the bead's link carries.
template <class S>
std::vector<Balance<S>> bead_balances(ChainSpec const& chain, Loads const& loads,
                                      std::vector<V3<S>> const& acceleration, V3<S> const& pushed,
                                      std::vector<V3<S>>& left) {
    std::vector<BeadLink<S>> const links = read_bead_links<S>(chain);
    std::vector<Balance<S>> all;
    /// Forces that each bead exerts on the beads outboard of it.
    std::vector<std::vector<V3<S>>> outboard(chain.size());
    outboard.back().push_back(-pushed);
    left.clear();
    for (std::size_t k = chain.size(); k-- > 0;) {
        Balance<S> force;
        force.add(S(chain.beads.mass[k]) * acceleration[k]);
        force.add(-bead_force<S>(chain, loads, k));
        for (V3<S> const& each : outboard[k]) force.add(each);
        if (k == 0 && chain.is_ring()) force.add(pushed);
        V3<S> const& u = links[k].direction;
        V3<S> const inboard = dot(u, force.sum) * u;
        if (k > 0) outboard[scene::inboard_of(chain.parent, k)].push_back(inboard);
        left.push_back(force.sum - inboard);
        all.push_back(force);
    }
    return all;
}

/// Residual of a chain of beads.
template <class S>
S residual_of_beads(ChainSpec const& chain, Loads const& loads,
                    std::vector<V3<S>> const& acceleration) {
    std::vector<V3<S>> left, with_unit;
    V3<S> pushed = V3<S>::zero();
    std::vector<Balance<S>> balances = bead_balances(chain, loads, acceleration, pushed, left);
    // The tip link's force is the least-squares fit.
    if (chain.tip == Tip::jointed) {
        V3<S> const u = read_bead_links<S>(chain).back().direction;
        bead_balances(chain, loads, acceleration, u, with_unit);
        S against(0), square(0);
        for (std::size_t i = 0; i < left.size(); ++i) {
            V3<S> const change = with_unit[i] - left[i];
            against -= dot(change, left[i]);
            square += dot(change, change);
        }
        if (square > S(0)) pushed = S(against / square) * u;
        balances = bead_balances(chain, loads, acceleration, pushed, left);
    }
    S worst(0);
    for (std::size_t i = 0; i < left.size(); ++i)
        worst = std::max(worst, ratio(norm(left[i]), balances[i].largest));
    return worst;
}

}  // namespace

template <class S>
S rnea_residual(ChainSpec const& chain, Loads const& loads,
                std::vector<Vector<S, 3>> const& accelerations,
                Vector<S, 3> const& base_acceleration) {
    if (chain.is_linked() || chain.has_loops())
        throw ComputationError("no inverse dynamics of linked bodies and of loops (" + chain.name +
                               "): compare with the oracles' accelerations");
    return chain.is_beads() ? residual_of_beads(chain, loads, accelerations)
                            : residual_of_bodies(chain, loads, accelerations, base_acceleration);
}

template double rnea_residual<double>(ChainSpec const&, Loads const&,
                                      std::vector<V3<double>> const&, V3<double> const&);
template long double rnea_residual<long double>(ChainSpec const&, Loads const&,
                                                std::vector<V3<long double>> const&,
                                                V3<long double> const&);
template Quad rnea_residual<Quad>(ChainSpec const&, Loads const&, std::vector<V3<Quad>> const&,
                                  V3<Quad> const&);

}  // namespace catena::oracle
