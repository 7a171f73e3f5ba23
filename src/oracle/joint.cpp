// Reading of bodies and joints, and projections on the directions of a joint.
#include "oracle/joint.hpp"

#include <algorithm>
#include <string>

#include "error.hpp"
#include "oracle/rotations.hpp"
#include "scene/branches.hpp"
#include "terms/force_terms.hpp"

namespace catena::oracle {
namespace {

/// Entry k of an array of BodyArrays; an empty array means zero.
template <class T>
T entry(std::vector<T> const& values, std::size_t k) {
    return values.empty() ? T{} : values[k];
}
/// Unit vector along axis i.
template <class S>
V3<S> unit_direction(int i) {
    V3<S> e = V3<S>::zero();
    e[i] = S(1);
    return e;
}

/// Coordinate of a prescribed motion and its derivatives at one time.
template <class S>
struct PrescribedMotionAt {
    S q, rate, acceleration;
};
/// Evaluates a prescribed motion.
template <class S>
PrescribedMotionAt<S> at(PrescribedMotion const& c, double time) {
    using std::atan2;
    using std::cos;
    using std::sin;
    S const t(time), turns = S(2) * S(atan2(S(0), S(-1))) * S(c.frequency),
                     phase = turns * t + S(c.phase), a(c.amplitude);
    return {S(c.offset) + S(c.rate) * t + a * S(sin(phase)), S(c.rate) + a * turns * S(cos(phase)),
            -a * turns * turns * S(sin(phase))};
}

/// Coordinates of joint k and their derivatives; prescribed motion determines them if the joint has
/// one.
template <class S>
struct JointState {
    std::array<S, 3> q;
    V3<S> rates, accelerations = V3<S>::zero();
};
/// Returns the state of joint k, and sets `driven` of its link.
template <class S>
JointState<S> state_of(BodyArrays const& b, std::size_t k, double time, Link<S>& link) {
    JointState<S> state{{S(b.q[k][0]), S(b.q[k][1]), S(b.q[k][2])}, lift<S>(b.qd[k])};
    auto const by_body = [](DrivenJoint const& d, std::size_t body) {
        return static_cast<std::size_t>(d.body) < body;
    };
    auto const driven = std::lower_bound(b.driven.begin(), b.driven.end(), k, by_body);
    link.driven = driven != b.driven.end() && static_cast<std::size_t>(driven->body) == k;
    if (!link.driven) return state;
    for (int i = 0; i < 2; ++i) {
        PrescribedMotionAt<S> const course =
            at<S>(driven->course[static_cast<std::size_t>(i)], time);
        state.q[static_cast<std::size_t>(i)] = course.q;
        state.rates[i] = course.rate;
        state.accelerations[i] = course.acceleration;
    }
    return state;
}

/// Sets effort and spring energy of a joint with scalar coordinates.
template <class S>
void read_springs(BodyArrays const& b, std::size_t k, JointState<S> const& state, Link<S>& link) {
    V3<S> const stiffness = lift<S>(entry(b.stiffness, k)), damping = lift<S>(entry(b.damping, k));
    auto const rest = entry(b.rest, k);
    for (int i = 0; i < link.dof; ++i) {
        auto const at = static_cast<std::size_t>(i);
        S const stretch = state.q[at] - S(rest[at]);
        link.effort[i] =
            S(entry(b.torque, k)[i]) - stiffness[i] * stretch - damping[i] * state.rates[i];
        link.spring_energy += stiffness[i] * stretch * stretch / S(2);
    }
}

/// Sets effort and spring energy of a spherical joint.
template <class S>
void read_spherical_springs(BodyArrays const& b, std::size_t k, Link<S>& link) {
    V3<S> const damping = lift<S>(entry(b.damping, k)), stiffness = lift<S>(entry(b.stiffness, k));
    link.effort = lift<S>(entry(b.torque, k));
    for (int i = 0; i < 3; ++i) link.effort[i] -= damping[i] * link.rate[i];
    if (norm(stiffness) == S(0)) return;
    Quaternion<S> const rest = b.rest.empty() ? Quaternion<S>::identity() : unit<S>(b.rest[k]);
    V3<S> const e = deflection(rest, unit<S>(b.q[k]));
    V3<S> const moment{{stiffness[0] * e[0], stiffness[1] * e[1], stiffness[2] * e[2]}};
    link.effort = link.effort + spring_torque(e, moment);
    link.spring_energy = dot(e, moment) / S(2);
}

/// Reads joint k: geometry, rates, and forces along its coordinates.
template <class S>
void read_joint(ChainSpec const& chain, Loads const& loads, std::size_t k, Link<S>& link) {
    BodyArrays const& b = chain.bodies;
    bool const base = b.joint[k] == JointType::free;
    JointState<S> const state = state_of(b, k, loads.time, link);
    bool const several =
        base || b.joint[k] == JointType::spherical || b.joint[k] == JointType::planar3;
    if (base != (k == 0 && chain.base == Base::free) || (several && link.driven) ||
        (b.joint[k] == JointType::weld && link.driven))
        throw ComputationError(
            "a free joint beyond body 1, or a driven joint of a type that cannot be driven "
            "(joint " +
            std::to_string(k + 1) + "): choose another type");
    JointShape<S> shape{b.joint[k],
                        lift<S>(b.axis[k]),
                        lift<S>(entry(b.first_axis, k)),
                        S(entry(b.pitch, k)),
                        M3<S>::identity(),
                        lift<S>(base ? b.free_base.position : b.translation[k]),
                        state.q,
                        b.q[k]};
    if (!base) shape.rotation = orthonormal<S>(b.rotation[k]);
    place(shape, "joint " + std::to_string(k + 1), link);
    Motion<S> const velocity = along(link, state.rates);
    link.rate = velocity.angular;
    link.slide = base ? lift<S>(b.free_base.velocity) : velocity.linear;
    if (link.type == JointType::universal)
        link.drift =
            S(state.rates[0] * state.rates[1]) * cross(link.free[0].angular, link.free[1].angular);
    if (link.driven)
        for (int i = 0; i < link.dof; ++i) link.prescribed[i] = state.accelerations[i];
    else if (link.type == JointType::spherical)
        read_spherical_springs(b, k, link);
    else if (!base)
        read_springs(b, k, state, link);
}

/// Adds the forces on the beads that a body carries, referred to its centre of mass.
template <class S>
void add_bead_forces(CarriedBeads const& beads, std::size_t k, Loads const& loads,
                     M3<S> const& orientation, Link<S>& link) {
    if (loads.bead_forces.empty() || beads.offset.empty()) return;
    for (auto i = static_cast<std::size_t>(beads.offset[k]);
         i < static_cast<std::size_t>(beads.offset[k + 1]); ++i) {
        V3<S> const force = lift<S>(loads.bead_forces[i]);
        link.applied_force = link.applied_force + force;
        link.applied_torque = link.applied_torque +
                              cross(orientation * (lift<S>(beads.position[i]) - link.com), force);
    }
}

/// Reads external wrenches, drag, forces on carried beads, and closure errors.
template <class S>
void read_loads(ChainSpec const& chain, Loads const& loads, std::vector<Link<S>>& links) {
    BodyArrays const& b = chain.bodies;
    std::vector<Attitude<S>> const attitude = attitudes(links);
    for (std::size_t k = 0; k < links.size(); ++k) {
        Link<S>& link = links[k];
        M3<S> const& r = attitude[k].orientation;
        auto const wrench = terms::constant_wrench(chain, k);
        auto const drag = b.drag.empty()
                              ? std::array<double, 2>{loads.linear_drag, loads.angular_drag}
                              : b.drag[k];
        V3<S> const omega = r * attitude[k].omega,
                    velocity = attitude[k].velocity + cross(omega, r * link.com);
        link.applied_torque = lift<S>(wrench.first) - S(drag[1]) * omega;
        link.applied_force = lift<S>(wrench.second) - S(drag[0]) * velocity;
        add_bead_forces(b.carried, k, loads, r, link);
        auto const gap = entry(loads.gaps, k);
        link.gap = {transposed_times(r, lift<S>(gap.first)),
                    transposed_times(r, lift<S>(gap.second))};
    }
}

/// True if the directions of a joint are those of a rotation about every axis.
template <class S>
bool rotates_about_all(Link<S> const& link) {
    return link.type == JointType::spherical || link.type == JointType::free;
}
/// Returns (P^T P)^-1 x, with P the directions of a joint. Those of cylindrical and planar3 joints
/// are orthonormal.
template <class S>
V3<S> over_gram(Link<S> const& link, V3<S> x) {
    Motion<S> const &p = link.free[0], &p2 = link.free[1];
    if (link.dof == 1) x[0] = x[0] / (dot(p.angular, p.angular) + dot(p.linear, p.linear));
    if (link.type != JointType::universal) return x;
    V3<S> const normal =
        // The directions are rotations: Cramer's rule with determinant |a1 x a2|^2.
        cross(p.angular, p2.angular);
    S const a = dot(p.angular, p.angular), b = dot(p.angular, p2.angular),
            c = dot(p2.angular, p2.angular), det = dot(normal, normal);
    return {{(c * x[0] - b * x[1]) / det, (a * x[1] - b * x[0]) / det, S(0)}};
}

/// Returns unit vectors perpendicular to all of the given ones, which are linearly independent.
template <class S>
std::vector<V3<S>> across_all(std::vector<V3<S>> const& vectors) {
    if (vectors.empty()) return {unit_direction<S>(0), unit_direction<S>(1), unit_direction<S>(2)};
    if (vectors.size() == 1) {
        auto const two = across(unit(vectors[0]));
        return {two.begin(), two.end()};
    }
    if (vectors.size() == 2) return {unit(cross(vectors[0], vectors[1]))};
    return {};
}

}  // namespace

template <class S>
void set_inboard_directions(JointShape<S> const& j, Link<S>& link) {
    auto const in_body = [&](V3<S> const& v) {
        return transposed_times(link.rotation, j.rotation * v);
    };
    if (link.type == JointType::universal) link.free[0].angular = in_body(j.first_axis);
    if (link.type != JointType::planar3) return;
    V3<S> const normal = unit(j.axis), y = unit(cross(normal, j.first_axis));
    link.free[0].linear = in_body(cross(y, normal));
    link.free[1].linear = in_body(y);
}

template <class S>
void place(JointShape<S> const& j, std::string const& where, Link<S>& link) {
    link.type = j.type;
    link.rotation = j.rotation;
    link.translation = j.translation;
    V3<S> const axis =
        link.type == JointType::weld || rotates_about_all(link) ? V3<S>::zero() : unit(j.axis);
    auto const turn = [&](S by) { link.rotation = link.rotation * turn_about(axis, by); };
    auto const shift = [&](S by) {
        link.translation = link.translation + j.rotation * (by * axis);
    };
    link.dof = 1;
    if (link.type == JointType::revolute) {
        turn(j.q[0]);
        link.free[0].angular = axis;
    } else if (link.type == JointType::prismatic) {
        shift(j.q[0]);
        link.free[0].linear = axis;
    } else if (link.type == JointType::helical) {
        turn(j.q[0]);
        shift(j.pitch * j.q[0]);
        link.free[0] = {axis, j.pitch * axis};
    } else if (link.type == JointType::cylindrical) {
        turn(j.q[0]);
        shift(j.q[1]);
        link.free[0].angular = link.free[1].linear = axis;
        link.dof = 2;
    } else if (link.type == JointType::planar3) {
        V3<S> const y = unit(cross(axis, j.first_axis)), x = cross(y, axis);
        turn(j.q[2]);
        link.translation = link.translation + j.rotation * (j.q[0] * x + j.q[1] * y);
        set_inboard_directions(j, link);
        link.free[2].angular = axis;
        link.dof = 3;
    } else if (link.type == JointType::universal) {
        V3<S> const first = unit(j.first_axis);
        M3<S> const second = turn_about(axis, j.q[1]);
        link.rotation = j.rotation * (turn_about(first, j.q[0]) * second);
        link.free[0].angular = transposed_times(second, first);
        link.free[1].angular = axis;
        link.dof = 2;
    } else if (rotates_about_all(link)) {
        link.rotation = j.rotation * matrix(unit<S>(j.quaternion));
        for (int i = 0; i < 3; ++i)
            link.free[static_cast<std::size_t>(i)].angular = unit_direction<S>(i);
        link.dof = 3;
    } else if (link.type == JointType::weld) {
        link.dof = 0;
    } else {
        throw ComputationError("the oracles do not support this joint between rigid bodies (" +
                               where + "): choose another type");
    }
}

template <class S>
Motion<S> along(Link<S> const& link, V3<S> const& coordinates) {
    if (rotates_about_all(link)) return {coordinates, V3<S>::zero()};
    Motion<S> m;
    for (int i = 0; i < link.dof; ++i) {
        Motion<S> const& p = link.free[static_cast<std::size_t>(i)];
        m = m + Motion<S>{coordinates[i] * p.angular, coordinates[i] * p.linear};
    }
    return m;
}

template <class S>
V3<S> efforts(Link<S> const& link, SpatialForce<S> const& wrench) {
    if (rotates_about_all(link)) return wrench.torque;
    V3<S> x = V3<S>::zero();
    for (int i = 0; i < link.dof; ++i) x[i] = power(link.free[static_cast<std::size_t>(i)], wrench);
    return x;
}

template <class S>
V3<S> coordinates(Link<S> const& link, Motion<S> const& motion) {
    return over_gram(link, efforts(link, SpatialForce<S>{motion.angular, motion.linear}));
}

template <class S>
SpatialForce<S> spread(Link<S> const& link, V3<S> const& effort) {
    Motion<S> const m = along(link, over_gram(link, effort));
    return {m.angular, m.linear};
}

template <class S>
std::vector<Motion<S>> restricted(Link<S> const& link) {
    std::vector<Motion<S>> d;
    V3<S> const none = V3<S>::zero();
    std::vector<V3<S>> turning, shifting;
    for (int i = 0; i < link.unknown(); ++i) {
        Motion<S> const& p = link.free[static_cast<std::size_t>(i)];
        if (norm(p.angular) > S(0)) turning.push_back(p.angular);
        if (norm(p.linear) > S(0)) shifting.push_back(p.linear);
    }
    bool const screw = link.unknown() == 1 && !turning.empty() && !shifting.empty();
    for (V3<S> const& e : across_all(turning)) d.push_back({e, none});
    for (V3<S> const& e : across_all(screw ? turning : shifting)) d.push_back({none, e});
    if (screw)  // translation coupled to the rotation
        d.push_back({-link.free[0].linear, unit(link.free[0].angular)});
    return d;
}

template <class S>
std::vector<Link<S>> read_links(ChainSpec const& chain, Loads const& loads) {
    BodyArrays const& b = chain.bodies;
    std::vector<Link<S>> links(b.size());
    for (std::size_t k = 0; k < b.size(); ++k) {
        Link<S>& link = links[k];
        if (k > 0) link.inboard = static_cast<std::ptrdiff_t>(scene::inboard_of(chain.parent, k));
        read_joint(chain, loads, k, link);
        link.mass = S(b.mass[k]);
        link.com = lift<S>(b.com[k]);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) link.inertia(i, j) = S(b.inertia[k](i, j));
    }
    read_loads(chain, loads, links);
    return links;
}

template <class S>
std::vector<Attitude<S>> attitudes(std::vector<Link<S>> const& links) {
    std::vector<Attitude<S>> all;
    Attitude<S> const ground{M3<S>::identity(), V3<S>::zero(), V3<S>::zero(), V3<S>::zero()};
    for (Link<S> const& link : links) {
        Attitude<S> a = link.on_ground() ? ground : all[link.before()];
        V3<S> const to_origin = a.orientation * link.translation,
                    carried = cross(a.orientation * a.omega, to_origin);
        a.origin = a.origin + to_origin;
        a.orientation = a.orientation * link.rotation;
        a.omega = transposed_times(link.rotation, a.omega) + link.rate;
        a.velocity = link.type == JointType::free
                         ? link.slide
                         : a.velocity + carried + a.orientation * link.slide;
        all.push_back(a);
    }
    return all;
}

// NOLINTBEGIN(bugprone-macro-parentheses): S is a type
#define CATENA_ORACLE(S)                                                         \
    template void set_inboard_directions<S>(JointShape<S> const&, Link<S>&);     \
    template void place<S>(JointShape<S> const&, std::string const&, Link<S>&);  \
    template Motion<S> along<S>(Link<S> const&, V3<S> const&);                   \
    template V3<S> coordinates<S>(Link<S> const&, Motion<S> const&);             \
    template V3<S> efforts<S>(Link<S> const&, SpatialForce<S> const&);           \
    template SpatialForce<S> spread<S>(Link<S> const&, V3<S> const&);            \
    template std::vector<Motion<S>> restricted<S>(Link<S> const&);               \
    template std::vector<Link<S>> read_links<S>(ChainSpec const&, Loads const&); \
    template std::vector<Attitude<S>> attitudes<S>(std::vector<Link<S>> const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace catena::oracle
