// Forward kinematics and energies of beads, rigid bodies and linked bodies.
#include "oracle/linked.hpp"

namespace catena::oracle {
namespace {

/// Kinematics of a chain of beads.
template <class S>
Kinematics<S> of_beads(ChainSpec const& chain, Loads const& loads) {
    Kinematics<S> result;
    BeadArrays const& b = chain.beads;
    for (std::size_t k = 0; k < b.size(); ++k) {
        V3<S> const x = lift<S>(b.position[k]), v = lift<S>(b.velocity[k]);
        result.origin.push_back(x);
        result.com_position.push_back(x);
        result.com_velocity.push_back(v);
        result.kinetic_energy += S(b.mass[k]) * dot(v, v) / S(2);
        result.potential_energy -= S(b.mass[k]) * dot(lift<S>(loads.gravity), x);
    }
    return result;
}

/// Kinematics of a chain of rigid bodies.
template <class S>
Kinematics<S> of_bodies(ChainSpec const& chain, Loads const& loads) {
    Kinematics<S> result;
    std::vector<Link<S>> const links = read_links<S>(chain, loads);
    std::vector<Attitude<S>> const attitude = attitudes(links);
    for (std::size_t k = 0; k < links.size(); ++k) {
        Link<S> const& link = links[k];
        Attitude<S> const& at = attitude[k];
        V3<S> const omega = at.orientation * at.omega, to_com = at.orientation * link.com;
        V3<S> const velocity = at.velocity + cross(omega, to_com), position = at.origin + to_com;
        result.orientation.push_back(at.orientation);
        result.origin.push_back(at.origin);
        result.com_position.push_back(position);
        result.com_velocity.push_back(velocity);
        result.omega.push_back(omega);
        result.kinetic_energy +=
            (link.mass * dot(velocity, velocity) + dot(at.omega, link.inertia * at.omega)) / S(2);
        result.potential_energy -= link.mass * dot(lift<S>(loads.gravity), position);
        result.spring_energy += link.spring_energy;
    }
    return result;
}

/// Kinematics of a chain of linked bodies.
template <class S>
Kinematics<S> of_linked(ChainSpec const& chain, Loads const& loads) {
    Kinematics<S> result;
    LinkedModel<S> const model = read_linked<S>(chain, loads);
    for (std::size_t k = 0; k < model.bodies.size(); ++k) {
        LinkedBody<S> const& body = model.bodies[k];
        V3<S> const x = lift<S>(chain.linked.position[k]), v = lift<S>(chain.linked.velocity[k]);
        result.orientation.push_back(body.orientation);
        result.origin.push_back(x);
        result.com_position.push_back(x);
        result.com_velocity.push_back(v);
        result.omega.push_back(body.omega);
        result.kinetic_energy +=
            (body.mass * dot(v, v) + dot(body.omega, body.inertia * body.omega)) / S(2);
        result.potential_energy -= body.mass * dot(lift<S>(loads.gravity), x);
    }
    return result;
}

}  // namespace

template <class S>
Kinematics<S> kinematics(ChainSpec const& chain, Loads const& loads) {
    if (chain.is_linked()) return of_linked<S>(chain, loads);
    return chain.is_beads() ? of_beads<S>(chain, loads) : of_bodies<S>(chain, loads);
}

template Kinematics<double> kinematics<double>(ChainSpec const&, Loads const&);
template Kinematics<long double> kinematics<long double>(ChainSpec const&, Loads const&);
template Kinematics<Quad> kinematics<Quad>(ChainSpec const&, Loads const&);

}  // namespace catena::oracle
