#include <string>

#include "error.hpp"
#include "joints/joint_models.hpp"
#include "oracle/linked.hpp"

// Articulated-body algorithm. For every body, F = I A + p. F = [torque; force] acts through the
// inboard joint, about the joint's centre; A = [alpha; acceleration of the origin]. I and p belong
// to the body and everything outboard of it. All are in B. The 6 x 6 inertia is stored in blocks:
// [rot, cross; cross^T, lin].
namespace catena::oracle {
namespace {

/// Spatial inertia in blocks.
template <class S>
struct Inertia {
    M3<S> rot = M3<S>::zero(), cross = M3<S>::zero(), lin = M3<S>::zero();
};
/// Wrench for an acceleration.
template <class S>
SpatialForce<S> operator*(Inertia<S> const& i, Motion<S> const& a) {
    return {i.rot * a.angular + i.cross * a.linear,
            transposed_times(i.cross, a.angular) + i.lin * a.linear};
}

/// Coordinate after its elimination: q'' = (rest - carry . A) / inertia. A is the acceleration with
/// this and all outboard coordinates locked.
template <class S>
struct Coordinate {
    SpatialForce<S> carry;
    S inertia = S(0), rest = S(0);
};

/// Articulated-body inertia and bias force of a body.
template <class S>
struct Articulated {
    Inertia<S> inertia;  // inertia with the inboard joint locked
    SpatialForce<S> bias;
    Motion<S> closure;  // velocity-dependent part of A across the joint, B
    // Inertia and bias behind the joint act on the inboard body: F = behind (A carried over from
    // the inboard body) + bias_behind.
    Inertia<S> behind;
    SpatialForce<S> bias_behind;
    std::array<Coordinate<S>, 3> coordinate;
};

/// Throws ComputationError for body k.
[[noreturn]] void not_definite(std::size_t k) {
    throw ComputationError("articulated inertia is not positive definite (body " +
                           std::to_string(k + 1) +
                           "): check the mass and inertia of this body and those outboard of it");
}

/// Adds the rigid body itself, its gyroscopic terms and its loads.
template <class S>
void add_rigid_body(Link<S> const& link, Attitude<S> const& at, V3<S> const& gravity,
                    Articulated<S>& a) {
    V3<S> const& w = at.omega;
    V3<S> const applied =
        transposed_times(at.orientation, link.applied_force + link.mass * gravity);
    V3<S> const net = link.mass * cross(w, cross(w, link.com)) - applied;
    V3<S> const gyroscopic =
        cross(w, link.inertia * w) - transposed_times(at.orientation, link.applied_torque);
    M3<S> const c = skew(link.com);
    a.inertia.rot = plus(a.inertia.rot, plus(link.inertia, scaled(-link.mass, c * c)));
    a.inertia.cross = plus(a.inertia.cross, scaled(link.mass, c));
    a.inertia.lin = plus(a.inertia.lin, scaled(link.mass, M3<S>::identity()));
    a.bias = a.bias + SpatialForce<S>{gyroscopic + cross(link.com, net), net};
}

/// Eliminates the coordinates of a joint one after the other from the outboard side. A universal
/// joint equals two revolute joints with a massless body between them. The inertia becomes I - U
/// D^-1 U^T with U = I P, D = P^T U. The bias behind the joint includes the force along the
/// coordinate.
template <class S>
void pass_coordinates(Link<S> const& link, std::size_t k, Articulated<S>& a) {
    a.behind = a.inertia;
    a.bias_behind = a.bias;
    for (int i = link.unknown(); i-- > 0;) {
        Motion<S> const& p = link.free[static_cast<std::size_t>(i)];
        Coordinate<S>& c = a.coordinate[static_cast<std::size_t>(i)];
        c.carry = a.behind * p;
        c.inertia = power(p, c.carry);
        c.rest = link.effort[i] - power(p, a.bias_behind);
        if (!(c.inertia > S(0))) not_definite(k);
        V3<S> const &u_rot = c.carry.torque, &u_lin = c.carry.force;
        S const scale = S(-1) / c.inertia, acceleration = c.rest / c.inertia;
        a.behind.rot = plus_outer(a.behind.rot, scale, u_rot, u_rot);
        a.behind.cross = plus_outer(a.behind.cross, scale, u_rot, u_lin);
        a.behind.lin = plus_outer(a.behind.lin, scale, u_lin, u_lin);
        a.bias_behind = a.bias_behind + SpatialForce<S>{acceleration * u_rot, acceleration * u_lin};
    }
}

/// Eliminates the three coordinates of a spherical joint together.
template <class S>
void pass_spherical(Link<S> const& link, std::size_t k, Articulated<S>& a) {
    Cholesky<S, 3> const d(a.inertia.rot);
    if (!d.definite()) not_definite(k);
    M3<S> alpha_per_linear;
    for (int j = 0; j < 3; ++j) alpha_per_linear.set_column(j, d.solve(a.inertia.cross.column(j)));
    a.behind.lin =
        plus(a.inertia.lin, scaled(S(-1), transposed_times(a.inertia.cross, alpha_per_linear)));
    a.bias_behind = {link.effort, a.bias.force + transposed_times(alpha_per_linear,
                                                                  link.effort - a.bias.torque)};
}

/// Adds the inertia and bias of `outboard` behind its joint to the inboard body, in the inboard
/// body's axes about its origin.
template <class S>
void hand_inboard(Link<S> const& link, Articulated<S> const& outboard, Articulated<S>& inboard) {
    M3<S> const& r = link.rotation;
    M3<S> const t = skew(link.translation);
    M3<S> const lin = symmetrized(turned(r, outboard.behind.lin)),
                cross_block = turned(r, outboard.behind.cross);
    M3<S> const cross_t = cross_block * t;
    M3<S> const moved = plus(turned(r, outboard.behind.rot),
                             scaled(S(-1), plus(plus(cross_t, transpose(cross_t)), t * (lin * t))));
    inboard.inertia.rot = plus(inboard.inertia.rot, symmetrized(moved));
    inboard.inertia.cross = plus(inboard.inertia.cross, plus(cross_block, t * lin));
    inboard.inertia.lin = plus(inboard.inertia.lin, lin);
    V3<S> const force = r * outboard.bias_behind.force;
    inboard.bias =
        inboard.bias +
        SpatialForce<S>{r * outboard.bias_behind.torque + cross(link.translation, force), force};
}

/// Returns the acceleration of a free body 1.
template <class S>
Motion<S> solve_free(Articulated<S> const& a) {
    Matrix<S, 6, 6> m;
    Vector<S, 6> x;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            m(i, j) = a.inertia.rot(i, j);
            m(i, j + 3) = m(j + 3, i) = a.inertia.cross(i, j);
            m(i + 3, j + 3) = a.inertia.lin(i, j);
        }
        x[i] = -a.bias.torque[i];
        x[i + 3] = -a.bias.force[i];
    }
    Cholesky<S, 6> const factor(m);
    if (!factor.definite()) not_definite(0);
    x = factor.solve(x);
    return {{{x[0], x[1], x[2]}}, {{x[3], x[4], x[5]}}};
}

/// Returns q'' of a joint. `motion` is the acceleration that the body would have at q'' = 0.
template <class S>
V3<S> joint_acceleration(Link<S> const& link, Articulated<S> const& a, Motion<S> motion) {
    if (link.driven) return link.prescribed;
    if (is_ball(link.type))
        return Cholesky<S, 3>(a.inertia.rot)
            .solve(link.effort - a.bias.torque - (a.inertia * motion).torque);
    V3<S> qdd = V3<S>::zero();
    for (int i = 0; i < link.dof; ++i) {
        auto const at = static_cast<std::size_t>(i);
        qdd[i] = (a.coordinate[at].rest - power(motion, a.coordinate[at].carry)) /
                 a.coordinate[at].inertia;
        motion = motion + Motion<S>{qdd[i] * link.free[at].angular, qdd[i] * link.free[at].linear};
    }
    return qdd;
}

/// Inward and outward pass over the bodies of one chain.
template <class S>
class Solver {
  public:
    Solver(std::vector<Link<S>> const& links, V3<S> const& gravity)
        : links_(links), attitude_(attitudes(links_)), bodies_(links_.size()), gravity_(gravity) {
        if (!links_.empty() && floats(links_[0].type)) refer_to_com();
    }

    OracleResult<S> solve() {
        for (std::size_t k = links_.size(); k-- > 0;) gather(k);
        OracleResult<S> result;
        std::vector<Motion<S>> motion;
        for (std::size_t k = 0; k < links_.size(); ++k)
            motion.push_back(release(
                k, links_[k].on_ground() ? Motion<S>{} : motion[links_[k].before()], result));
        return result;
    }

  private:
    /// Refers a free body 1 to its centre of mass. About its origin, m c^2 would mask a small
    /// inertia in the 6 x 6 solve.
    void refer_to_com() {
        from_origin_ = links_[0].com;
        links_[0].com = V3<S>::zero();
        for (Link<S>& link : links_)
            if (link.inboard == 0) link.translation = link.translation - from_origin_;
    }

    /// Inward pass: completes the articulated-body inertia of body k and adds it to the inboard
    /// body.
    void gather(std::size_t k) {
        Articulated<S>& a = bodies_[k];
        Link<S> const& link = links_[k];
        add_rigid_body(link, attitude_[k], gravity_, a);
        if (floats(link.type)) return;
        V3<S> const w = link.on_ground() ? V3<S>::zero() : attitude_[link.before()].omega,
                    w_here = attitude_[k].omega - link.rate;
        a.closure = {cross(w_here, link.rate) + link.drift,
                     transposed_times(link.rotation, cross(w, cross(w, link.translation))) +
                         S(2) * cross(w_here, link.slide)};
        if (link.driven) a.closure = a.closure + along(link, link.prescribed);
        a.closure = a.closure + link.gap;
        if (is_ball(link.type))
            pass_spherical(link, k, a);
        else
            pass_coordinates(link, k, a);
        a.bias_behind = a.bias_behind + a.behind * a.closure;
        if (!link.on_ground()) hand_inboard(link, a, bodies_[link.before()]);
    }

    /// Outward pass: computes the acceleration of body k from that of its inboard body, and stores
    /// the results of body k.
    Motion<S> release(std::size_t k, Motion<S> const& inboard, OracleResult<S>& result) const {
        Link<S> const& link = links_[k];
        Articulated<S> const& a = bodies_[k];
        M3<S> const& to_world = attitude_[k].orientation;
        if (floats(link.type)) {
            Motion<S> const motion = solve_free(a);
            V3<S> const &w = attitude_[k].omega, r = -from_origin_;
            result.base_acceleration =
                to_world * (motion.linear + cross(motion.angular, r) + cross(w, cross(w, r)));
            report(k, motion, motion.angular, result);
            return motion;
        }
        Motion<S> const carried{
            transposed_times(link.rotation, inboard.angular),
            transposed_times(link.rotation,
                             inboard.linear + cross(inboard.angular, link.translation))};
        Motion<S> motion = carried + a.closure;
        V3<S> const qdd = joint_acceleration(link, a, motion);
        if (!link.driven) motion = motion + along(link, qdd);
        report(k, motion, qdd, result);
        SpatialForce<S> const f = a.behind * carried + a.bias_behind;
        SpatialForce<S> const given = spread(link, link.effort),
                              found = spread(link, efforts(link, f));
        bool const held = link.unknown() == 0;
        V3<S> const torque = held ? f.torque : f.torque - found.torque,
                    force = held ? f.force : f.force - found.force;
        result.constraint_force[k] = {to_world * torque, to_world * force};
        result.joint_force[k] = {to_world * (torque + given.torque),
                                 to_world * (force + given.force)};
        return motion;
    }

    void report(std::size_t k, Motion<S> const& motion, V3<S> const& qdd,
                OracleResult<S>& result) const {
        V3<S> const &w = attitude_[k].omega, &c = links_[k].com;
        M3<S> const& to_world = attitude_[k].orientation;
        result.qdd.push_back(qdd);
        result.alpha.push_back(to_world * motion.angular);
        result.com_acceleration.push_back(
            to_world * (motion.linear + cross(motion.angular, c) + cross(w, cross(w, c))));
        result.joint_force.emplace_back();
        result.constraint_force.emplace_back();
    }

    std::vector<Link<S>> links_;
    std::vector<Attitude<S>> attitude_;
    std::vector<Articulated<S>> bodies_;
    V3<S> gravity_;
    /// Free base: vector from the origin of body 1 to its centre of mass, B.
    V3<S> from_origin_ = V3<S>::zero();
};

}  // namespace

template <class S>
OracleResult<S> aba_links(std::vector<Link<S>> const& links, V3<S> const& gravity) {
    return Solver<S>(links, gravity).solve();
}

template <class S>
OracleResult<S> aba(ChainSpec const& chain, Loads const& loads) {
    if (chain.is_beads()) return aba_beads<S>(chain, loads);
    if (chain.is_linked())
        return chain.is_ring() ? dense<S>(chain, loads) : tridiagonal_linked<S>(chain, loads);
    if (chain.is_closed() && chain.size() > 0) return aba_with_closures<S>(chain, loads);
    return aba_links(read_links<S>(chain, loads), lift<S>(loads.gravity));
}

// NOLINTBEGIN(bugprone-macro-parentheses): S is a type
#define CATENA_ORACLE(S)                                                              \
    template OracleResult<S> aba_links<S>(std::vector<Link<S>> const&, V3<S> const&); \
    template OracleResult<S> aba<S>(ChainSpec const&, Loads const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE
// NOLINTEND(bugprone-macro-parentheses)

}  // namespace catena::oracle
