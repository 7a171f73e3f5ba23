#include "dca/oracle/inverse.hpp"

namespace catena::oracle {
namespace {

template <class S>
S ratio(S error, S size) {
    return size > S(0) ? S(error / size) : S(0);
}

/// Along the coordinates of one joint: what is needed less what is given, over the largest term of its balance (a sliding
/// coordinate: of the forces; a helical one: of both).
template <class S>
S joint_residual(Link<S> const& link, V3<S> const& needed, InverseBody<S> const& body) {
    S size = norm(link.effort);
    if (norm(link.free[0].angular) > S(0)) size = std::max(size, body.torque.largest);
    if (norm(link.free[0].linear) > S(0)) size = std::max(size, S(norm(link.free[0].linear) * body.force.largest));
    return ratio(norm(needed - link.effort), size);
}

template <class S>
S residual_of_bodies(ChainSpec const& chain, Loads const& loads, std::vector<V3<S>> const& qdd, V3<S> const& base_acceleration) {
    using std::abs;
    std::vector<Link<S>> const links = read_links<S>(chain, loads);
    Inverse<S> const inverse(links, lift<S>(loads.gravity));
    std::vector<InverseBody<S>> const bodies = inverse(qdd, base_acceleration);
    S worst(0);
    for (std::size_t k = 0; k < links.size(); ++k) {
        if (links[k].unknown() > 0) worst = std::max(worst, joint_residual(links[k], inverse.needed(k, bodies[k]), bodies[k]));
        if (links[k].type == JointType::free) worst = std::max(worst, ratio(norm(bodies[k].force.sum), bodies[k].force.largest));
    }
    return worst;
}

template <class S>
S residual_of_beads(ChainSpec const& chain, Loads const& loads, std::vector<V3<S>> const& acceleration) {
    std::vector<BeadLink<S>> const links = read_bead_links<S>(chain);
    V3<S> outboard = V3<S>::zero();
    S worst(0);
    for (std::size_t k = links.size(); k-- > 0;) {
        Balance<S> force;
        force.add(S(chain.beads.mass[k]) * acceleration[k]);
        force.add(-bead_force<S>(chain, loads, k));
        force.add(outboard);
        V3<S> const& u = links[k].direction;
        outboard = dot(u, force.sum) * u;
        worst = std::max(worst, ratio(norm(force.sum - outboard), force.largest));
    }
    return worst;
}

}  // namespace

template <class S>
S rnea_residual(ChainSpec const& chain, Loads const& loads, std::vector<Vector<S, 3>> const& accelerations,
                Vector<S, 3> const& base_acceleration) {
    return chain.is_beads() ? residual_of_beads(chain, loads, accelerations)
                            : residual_of_bodies(chain, loads, accelerations, base_acceleration);
}

template double rnea_residual<double>(ChainSpec const&, Loads const&, std::vector<V3<double>> const&, V3<double> const&);
template long double rnea_residual<long double>(ChainSpec const&, Loads const&, std::vector<V3<long double>> const&,
                                                V3<long double> const&);
template Quad rnea_residual<Quad>(ChainSpec const&, Loads const&, std::vector<V3<Quad>> const&, V3<Quad> const&);

}  // namespace catena::oracle
