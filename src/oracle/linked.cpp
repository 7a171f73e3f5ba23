#include "oracle/linked.hpp"

#include <string>

#include "error.hpp"
#include "oracle/rotations.hpp"
#include "terms/force_terms.hpp"

// Link forces of a chain of bodies and beads. They solve T lambda = r, where T is symmetric,
// positive definite and tridiagonal. A link exerts lambda u on its outboard end and -lambda u on
// its inboard end; the tension is -lambda.
namespace catena::oracle {
namespace {

/// Reads body k with the forces on it.
template <class S>
LinkedBody<S> read_body(ChainSpec const& chain, Loads const& loads, std::size_t k) {
    LinkedArrays const& b = chain.linked;
    LinkedBody<S> body;
    body.mass = S(b.mass[k]);
    body.bead = b.is_bead(k);
    body.force = body.mass * lift<S>(loads.gravity) - S(loads.linear_drag) * lift<S>(b.velocity[k]);
    body.force = body.force + lift<S>(terms::constant_wrench(chain, k).second);
    if (!loads.wrenches.empty()) body.force = body.force + lift<S>(loads.wrenches[k].second);
    body.orientation = body.bead ? M3<S>::identity() : matrix(unit<S>(b.orientation[k]));
    body.torque = body.omega = V3<S>::zero();
    body.inertia = M3<S>::identity();
    if (!body.bead) {
        M3<S> inertia;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) inertia(i, j) = S(b.inertia[k](i, j));
        body.inertia = turned(body.orientation, inertia);
        body.omega = body.orientation * lift<S>(b.omega[k]);
        body.end = {body.orientation * lift<S>(b.inboard[k]),
                    body.orientation * lift<S>(b.outboard[k])};
        body.torque =
            -cross(body.omega, body.inertia * body.omega) - S(loads.angular_drag) * body.omega;
        if (!loads.wrenches.empty()) body.torque = body.torque + lift<S>(loads.wrenches[k].first);
    }
    if (loads.bead_forces.empty() || b.carried.offset.empty()) return body;
    for (auto i = static_cast<std::size_t>(b.carried.offset[k]);
         i < static_cast<std::size_t>(b.carried.offset[k + 1]); ++i) {
        V3<S> const force = lift<S>(loads.bead_forces[i]);
        body.force = body.force + force;
        if (!body.bead)
            body.torque =
                body.torque + cross(body.orientation * lift<S>(b.carried.position[i]), force);
    }
    return body;
}

/// Returns z_k(at, from) v: acceleration of the point `at` due to the force v at `from`.
template <class S>
V3<S> mobility(LinkedBody<S> const& body, V3<S> const& at, V3<S> const& from, V3<S> const& v) {
    V3<S> const linear = S(S(1) / body.mass) * v;
    if (body.bead) return linear;
    return linear + cross(Cholesky<S, 3>(body.inertia).solve(cross(from, v)), at);
}
/// Returns the acceleration of an end without link forces.
template <class S>
V3<S> bias(LinkedBody<S> const& body, std::size_t end) {
    V3<S> const linear = S(S(1) / body.mass) * body.force;
    if (body.bead) return linear;
    return linear + cross(Cholesky<S, 3>(body.inertia).solve(body.torque), body.end[end]) +
           body.centripetal(end);
}

}  // namespace

template <class S>
LinkedModel<S> read_linked(ChainSpec const& chain, Loads const& loads) {
    LinkedArrays const& b = chain.linked;
    std::size_t const n = b.size();
    LinkedModel<S> model;
    model.first = chain.base == Base::fixed ? 0 : 1;
    for (std::size_t k = 0; k < n; ++k) {
        model.bodies.push_back(read_body<S>(chain, loads, k));
        LinkedBody<S> const& body = model.bodies.back();
        if (!body.bead && !Cholesky<S, 3>(body.inertia).definite())
            throw ComputationError("inertia is not positive definite (body " +
                                   std::to_string(k + 1) + "): check it, or make it a bead (zero)");
    }
    auto const position = [&](std::size_t k, std::size_t end) {
        return lift<S>(b.position[k]) + model.bodies[k].end[end];
    };
    auto const velocity = [&](std::size_t k, std::size_t end) {
        return lift<S>(b.velocity[k]) + cross(model.bodies[k].omega, model.bodies[k].end[end]);
    };
    model.links.resize(n);
    if (model.first == 0)
        model.links[0] = bead_link(position(0, 0) - lift<S>(b.anchor), velocity(0, 0));
    for (std::size_t k = 1; k < n; ++k)
        model.links[k] =
            bead_link(position(k, 0) - position(k - 1, 1), velocity(k, 0) - velocity(k - 1, 1));
    if (chain.is_ring())
        model.links.push_back(
            bead_link(position(0, 0) - position(n - 1, 1), velocity(0, 0) - velocity(n - 1, 1)));
    else if (chain.tip == Tip::jointed)
        model.links.push_back(
            bead_link(lift<S>(tip_anchor(chain)) - position(n - 1, 1), -velocity(n - 1, 1)));
    for (std::size_t k = 0; k < loads.link_gaps.size(); ++k)
        model.links[k].closure += S(loads.link_gaps[k]);
    return model;
}

template <class S>
void link_compliance(LinkedModel<S> const& model, std::vector<S>& diagonal,
                     std::vector<S>& beside) {
    std::size_t const n = model.bodies.size();
    diagonal.assign(model.links.size(), S(1));
    beside.assign(model.links.size(), S(0));
    for (std::size_t k = model.first; k < model.links.size(); ++k) {
        V3<S> const& u = model.links[k].direction;
        V3<S> soft = V3<S>::zero();
        if (k < n)
            soft =
                soft + mobility(model.bodies[k], model.bodies[k].end[0], model.bodies[k].end[0], u);
        if (k > 0)
            soft = soft + mobility(model.bodies[k - 1], model.bodies[k - 1].end[1],
                                   model.bodies[k - 1].end[1], u);
        diagonal[k] = dot(u, soft);
        if (k + 1 < model.links.size())
            beside[k] = -dot(u, mobility(model.bodies[k], model.bodies[k].end[0],
                                         model.bodies[k].end[1], model.links[k + 1].direction));
    }
}

template <class S>
OracleResult<S> tridiagonal_linked(ChainSpec const& chain, Loads const& loads) {
    LinkedModel<S> const model = read_linked<S>(chain, loads);
    std::size_t const n = model.bodies.size(), links = model.links.size();
    std::vector<S> pivot, beside, lambda(links + 1, S(0));
    link_compliance(model, pivot, beside);
    // Forward elimination.
    for (std::size_t k = model.first; k < links; ++k) {
        V3<S> const& u = model.links[k].direction;
        lambda[k] = model.links[k].closure;
        if (k < n) lambda[k] -= dot(u, bias(model.bodies[k], 0));
        if (k > 0) lambda[k] += dot(u, bias(model.bodies[k - 1], 1));
        if (k > model.first) {
            S const factor = beside[k - 1] / pivot[k - 1];
            pivot[k] -= factor * beside[k - 1];
            lambda[k] -= factor * lambda[k - 1];
        }
        if (!(pivot[k] > S(0)))
            throw ComputationError(
                "the links' matrix is not positive definite (link " + std::to_string(k + 1) +
                "): a chain stretched straight between its ends has no solution");
    }
    // Back substitution; lambda[links] = 0.
    for (std::size_t k = links; k-- > model.first;)
        lambda[k] = (lambda[k] - beside[k] * lambda[k + 1]) / pivot[k];
    // Accelerations under the link forces on both ends of every body.
    OracleResult<S> result;
    for (std::size_t k = 0; k < n; ++k) {
        LinkedBody<S> const& body = model.bodies[k];
        V3<S> const inboard = lambda[k] * model.links[k].direction;
        V3<S> const outboard =
            k + 1 < links ? -(lambda[k + 1] * model.links[k + 1].direction) : V3<S>::zero();
        result.com_acceleration.push_back(S(S(1) / body.mass) * (body.force + inboard + outboard));
        V3<S> const torque =
            body.torque + cross(body.end[0], inboard) + cross(body.end[1], outboard);
        result.alpha.push_back(body.bead ? V3<S>::zero()
                                         : Cholesky<S, 3>(body.inertia).solve(torque));
        result.tension.push_back(-lambda[k]);
        if (k + 1 == n) result.tip_force.force = outboard;
    }
    return result;
}

#define CATENA_ORACLE(S)                                                                       \
    template LinkedModel<S> read_linked<S>(ChainSpec const&, Loads const&);                    \
    template void link_compliance<S>(LinkedModel<S> const&, std::vector<S>&, std::vector<S>&); \
    template OracleResult<S> tridiagonal_linked<S>(ChainSpec const&, Loads const&);
CATENA_ORACLE(double)
CATENA_ORACLE(long double)
CATENA_ORACLE(Quad)
#undef CATENA_ORACLE

}  // namespace catena::oracle
