#include "dca/oracle/joint.hpp"

#include <string>

#include "error.hpp"

namespace catena::oracle {
namespace {

/// Arrays of BodyArrays that may be empty, which means zero.
template <class T>
T entry(std::vector<T> const& values, std::size_t k) {
    return values.empty() ? T{} : values[k];
}

template <class S>
Quaternion<S> unit(std::array<double, 4> const& q) {
    using std::sqrt;
    S const w(q[0]), x(q[1]), y(q[2]), z(q[3]);
    S const n = sqrt(w * w + x * x + y * y + z * z);
    return {w / n, x / n, y / n, z / n};
}

/// 1 + sine [a]x + versine [a]x^2 (Rodrigues).
template <class S>
M3<S> rodrigues(V3<S> const& a, S sine, S versine) {
    M3<S> const ax = skew(a);
    return plus(M3<S>::identity(), plus(scaled(sine, ax), scaled(versine, ax * ax)));
}
template <class S>
M3<S> matrix(Quaternion<S> const& q) {
    return rodrigues(V3<S>{{q.x, q.y, q.z}}, S(2) * q.w, S(2));
}
template <class S>
M3<S> turn_about(V3<S> const& axis, S angle) {
    using std::cos;
    using std::sin;
    S const half = sin(angle / S(2));
    return rodrigues(axis, S(sin(angle)), S(S(2) * half * half));
}

/// The rotation nearest to r, which is one to about double precision: Newton's iteration for the polar factor, so that the
/// transpose is the inverse in wider scalars too.
template <class S>
M3<S> orthonormal(Mat3 const& r) {
    M3<S> m;
    for (int i = 0; i < 9; ++i) m.data[i] = S(r.data[i]);
    for (int step = 0; step < 2; ++step) {
        M3<S> const defect = plus(M3<S>::identity(), scaled(S(-1), transpose(m) * m));
        m = plus(m, scaled(S(1) / S(2), m * defect));
    }
    return m;
}

/// Rotation vector (length at most pi) of rest^-1 q; its components are the same in B and in the rest frame.
template <class S>
V3<S> deflection(Quaternion<S> const& rest, Quaternion<S> const& q) {
    using std::atan2;
    V3<S> const a{{rest.x, rest.y, rest.z}}, b{{q.x, q.y, q.z}};
    S w = rest.w * q.w + dot(a, b);
    V3<S> v = rest.w * b - q.w * a - cross(a, b);
    if (w < S(0)) {
        w = -w;
        v = -v;
    }
    S const s = norm(v);
    return s > S(0) ? S(S(2) * atan2(s, w) / s) * v : v;
}

/// Torque (B) of the potential 1/2 sum k_i e_i^2 in the rotation vector e, moment = K e: - J^-T K e with J^-1 the matrix of
/// e' = J^-1(e) omega_B (inverse right Jacobian of the rotation group). For equal k_i it is - k e.
template <class S>
V3<S> spring_torque(V3<S> const& e, V3<S> const& moment) {
    using std::cos;
    using std::sin;
    S const angle = norm(e), half = angle / S(2);
    S const c = angle > S(0) ? S((S(1) - half * cos(half) / sin(half)) / (angle * angle)) : S(0);
    V3<S> const turned_moment = cross(e, moment);
    return S(1) / S(2) * turned_moment - c * cross(e, turned_moment) - moment;
}

template <class S>
void read_revolute(BodyArrays const& b, std::size_t k, Link<S>& link) {
    V3<S> const axis = lift<S>(b.axis[k]);
    link.axis = S(S(1) / norm(axis)) * axis;
    link.rotation = orthonormal<S>(b.rotation[k]) * turn_about(link.axis, S(b.q[k][0]));
    link.rate = S(b.qd[k][0]) * link.axis;
    S const stretch = S(b.q[k][0]) - S(entry(b.rest, k)[0]);
    S const stiffness(entry(b.stiffness, k)[0]), damping(entry(b.damping, k)[0]);
    link.torque = S(S(entry(b.torque, k)[0]) - stiffness * stretch - damping * S(b.qd[k][0])) * link.axis;
    link.spring_energy = stiffness * stretch * stretch / S(2);
}

template <class S>
void read_spherical(BodyArrays const& b, std::size_t k, Link<S>& link) {
    Quaternion<S> const q = unit<S>(b.q[k]);
    link.rotation = orthonormal<S>(b.rotation[k]) * matrix(q);
    V3<S> const damping = lift<S>(entry(b.damping, k)), stiffness = lift<S>(entry(b.stiffness, k));
    link.torque = lift<S>(entry(b.torque, k));
    for (int i = 0; i < 3; ++i) link.torque[i] -= damping[i] * link.rate[i];
    if (norm(stiffness) == S(0)) return;
    Quaternion<S> const rest = b.rest.empty() ? Quaternion<S>::identity() : unit<S>(b.rest[k]);
    V3<S> const e = deflection(rest, q);
    V3<S> const moment{{stiffness[0] * e[0], stiffness[1] * e[1], stiffness[2] * e[2]}};
    link.torque = link.torque + spring_torque(e, moment);
    link.spring_energy = dot(e, moment) / S(2);
}

template <class S>
Link<S> read_link(ChainSpec const& chain, std::size_t k) {
    BodyArrays const& b = chain.bodies;
    Link<S> link;
    link.type = b.joint[k];
    link.translation = link.type == JointType::free ? lift<S>(b.free_position) : lift<S>(b.translation[k]);
    link.rate = lift<S>(b.qd[k]);
    if (link.type == JointType::revolute)
        read_revolute(b, k, link);
    else if (link.type == JointType::spherical)
        read_spherical(b, k, link);
    else if (link.type == JointType::free && k == 0)
        link.rotation = matrix(unit<S>(b.q[k]));
    else
        throw ComputationError("the oracles know revolute, spherical and (body 1) free joints only (joint " + std::to_string(k + 1) +
                               "): compare such a chain with another backend");
    link.mass = S(b.mass[k]);
    link.com = lift<S>(b.com[k]);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) link.inertia(i, j) = S(b.inertia[k](i, j));
    auto const wrench = entry(b.wrench, k);
    link.applied_torque = lift<S>(wrench.first);
    link.applied_force = lift<S>(wrench.second);
    return link;
}

}  // namespace

template <class S>
std::vector<Link<S>> read_links(ChainSpec const& chain) {
    std::vector<Link<S>> links;
    for (std::size_t k = 0; k < chain.bodies.size(); ++k) links.push_back(read_link<S>(chain, k));
    return links;
}

template <class S>
std::vector<Attitude<S>> attitudes(std::vector<Link<S>> const& links) {
    std::vector<Attitude<S>> all;
    Attitude<S> a{M3<S>::identity(), V3<S>::zero()};
    for (Link<S> const& link : links) {
        a.orientation = a.orientation * link.rotation;
        a.omega = transposed_times(link.rotation, a.omega) + link.rate;
        all.push_back(a);
    }
    return all;
}

template <class S>
std::vector<BeadLink<S>> read_bead_links(ChainSpec const& chain) {
    BeadArrays const& b = chain.beads;
    std::vector<BeadLink<S>> links(b.size());
    for (std::size_t k = chain.base == Base::free ? 1 : 0; k < b.size(); ++k) {
        V3<S> const along = lift<S>(b.position[k]) - lift<S>(k == 0 ? b.anchor : b.position[k - 1]);
        V3<S> const relative = k == 0 ? lift<S>(b.velocity[k]) : lift<S>(b.velocity[k]) - lift<S>(b.velocity[k - 1]);
        S const length = norm(along);
        V3<S> const u = S(S(1) / length) * along;
        V3<S> const across = relative - dot(relative, u) * u;
        links[k] = {u, -dot(across, across) / length};
    }
    return links;
}

template <class S>
V3<S> bead_force(ChainSpec const& chain, Loads const& loads, std::size_t k) {
    V3<S> const weight = S(chain.beads.mass[k]) * lift<S>(loads.gravity);
    return loads.bead_forces.empty() ? weight : weight + lift<S>(loads.bead_forces[k]);
}

template std::vector<Link<double>> read_links<double>(ChainSpec const&);
template std::vector<Attitude<double>> attitudes<double>(std::vector<Link<double>> const&);
template std::vector<BeadLink<double>> read_bead_links<double>(ChainSpec const&);
template V3<double> bead_force<double>(ChainSpec const&, Loads const&, std::size_t);
template std::vector<Link<long double>> read_links<long double>(ChainSpec const&);
template std::vector<Attitude<long double>> attitudes<long double>(std::vector<Link<long double>> const&);
template std::vector<BeadLink<long double>> read_bead_links<long double>(ChainSpec const&);
template V3<long double> bead_force<long double>(ChainSpec const&, Loads const&, std::size_t);
template std::vector<Link<Quad>> read_links<Quad>(ChainSpec const&);
template std::vector<Attitude<Quad>> attitudes<Quad>(std::vector<Link<Quad>> const&);
template std::vector<BeadLink<Quad>> read_bead_links<Quad>(ChainSpec const&);
template V3<Quad> bead_force<Quad>(ChainSpec const&, Loads const&, std::size_t);

}  // namespace catena::oracle
