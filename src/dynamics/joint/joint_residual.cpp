// Local backward residual of forward dynamics in joint coordinates (src/dca/README.md,
// "Residuals").
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <span>

#include "dynamics/joint/joint_solution.hpp"
#include "kinematics/ring_ends.hpp"
#include "math/executor.hpp"
#include "mpi/collectives.hpp"

namespace catena {

/// Forces on a body and moments about its centre of mass, B: applied, of the inboard joint, of the
/// outboard joint.
struct JointSolution::Terms {
    std::array<Vec3, 3> forces;
    std::array<Vec3, 5> moments;
    /// Sum of |r| |f| over joint forces. The rounding of a moment is proportional to it, however
    /// small the moment is.
    double moment_sizes = 0;
    /// Sum of |f| over the outboard joints of a branched body, whose forces are added up. A sum may
    /// be small although its terms are not.
    double force_sizes = 0;
};

namespace {

/// |inertial - sum of terms| divided by the sum of their sizes and of `more`. `more` is the size of
/// what cancelled within the terms or was subtracted from them.
double balance(Vec3 const& inertial, std::span<Vec3 const> terms, double more) {
    Vec3 difference = inertial;
    double size = norm(inertial) + more;
    for (Vec3 const& t : terms) {
        difference = difference - t;
        size += norm(t);
    }
    return relative(norm(difference), size);
}

Vec3 sum_of(std::span<Vec3 const> terms) {
    Vec3 sum = Vec3::zero();
    for (Vec3 const& t : terms) sum = sum + t;
    return sum;
}

/// Radius of gyration of body k.
double radius_of(ChainGroup const& group, std::int64_t k) {
    return radius_of_gyration(as_symmetric(group.bodies.inertia[k]),
                              group.bodies.mass.view().at(k, 0));
}

}  // namespace

JointSolution::Pair JointSolution::outboard_pair(std::int64_t k) const {
    if (group.ends.has_jointed_tip(k)) return along_axes(tip_force, k, outboard_screw(k));
    if (group.ends.is_last[k]) return {Vec3::zero(), Vec3::zero()};
    return along_axes(joint_force, k + 1, outboard_screw(k));
}

void JointSolution::add_reaction(std::int64_t handle_of, Pair const& outboard, Terms& t) const {
    Mat3 const e2 = axes2(handle_of);
    Vec3 const push = -(e2 * outboard.force);
    t.forces[2] = t.forces[2] + push;
    t.moments[3] = t.moments[3] + cross(r2(handle_of), push);
    t.moments[4] = t.moments[4] - e2 * outboard.torque;
    t.moment_sizes += norm(r2(handle_of)) * norm(push) + norm(outboard.torque);
    t.force_sizes += norm(push);
}

JointSolution::Terms JointSolution::terms(std::int64_t k) const {
    Mat3 const e1 = axes1(k);
    Pair const inboard = along_axes(joint_force, k, screw(k));
    Vec3 const force1 = e1 * inboard.force, none = Vec3::zero();
    Terms t{{{force.origin ? force.load(k) : none, force1, none}},
            {{torque.load(k), cross(group.bodies.r1[k], force1), e1 * inboard.torque, none, none}},
            norm(group.bodies.r1[k]) * norm(force1)};
    if (levels.levels() > 0) {
        for (std::int64_t const c : levels.children(k))
            add_reaction(c, along_axes(joint_force, c, screw(c)), t);
        return t;
    }
    Pair const outboard = outboard_pair(k);
    Mat3 const e2 = axes2(k);
    Vec3 const force2 = -(e2 * outboard.force);
    t.forces[2] = force2;
    t.moments[3] = cross(r2(k), force2);
    t.moments[4] = -(e2 * outboard.torque);
    t.moment_sizes += norm(r2(k)) * norm(force2);
    return t;
}

/// Acceleration of a handle along its joint's axes (linear, angular), and the sizes of its terms
/// (linear, angular). Terms are the contributions of each force and moment on the body and of its
/// rotation (chapter, eqs 2.1-2.2).
Vector<double, 8> JointSolution::handle(std::int64_t k, Vec3 const& r, Mat3 const& axes) const {
    Terms const t = terms(k);
    Vec3 const w = omega.load(k), centripetal = cross(w, cross(w, r));
    double linear = norm(centripetal) + norm(given.gravity), angular = 0;
    for (Vec3 const& f : t.forces) linear += group.bodies.inverse_mass.view().at(k, 0) * norm(f);
    linear += group.bodies.inverse_mass.view().at(k, 0) * t.force_sizes;
    for (Vec3 const& m : t.moments) {
        Vec3 const part = as_symmetric(group.bodies.inverse_inertia[k]) * m;
        angular += norm(part);
        linear += norm(cross(part, r));
    }
    Vec3 const a =
        transposed_times(axes, acceleration.load(k) + cross(alpha.load(k), r) + centripetal);
    Vec3 const turning = transposed_times(axes, alpha.load(k));
    return {{a[0], a[1], a[2], turning[0], turning[1], turning[2], linear, angular}};
}

JointSolution::Terms JointSolution::terms_solved_for(std::int64_t k) const {
    Terms t = terms(k);
    if (!group.planar) return t;
    Vec3 const axis = axes1(k).column(2);
    for (Vec3& moment : t.moments) moment = dot(axis, moment) * axis;
    return t;
}
Vec3 JointSolution::inertial_moment(std::int64_t k) const {
    Vec3 const moment = as_symmetric(group.bodies.inertia[k]) * alpha.load(k);
    if (!group.planar) return moment;
    Vec3 const axis = axes1(k).column(2);
    return dot(axis, moment) * axis;
}

Vector<double, 8> JointSolution::handle_before_first(Communicator const& communicator) const {
    Vector<double, 8> before = Vector<double, 8>::zero();
    if (group.neighbours.inboard < 0 && group.neighbours.outboard < 0) return before;
    Vector<double, 8> const last =
        group.neighbours.outboard >= 0
            ? handle(group.size - 1, r2(group.size - 1), axes2(group.size - 1))
            : before;
    exchange(communicator, last.data, group.neighbours.outboard, before.data,
             group.neighbours.inboard);
    return before;
}

std::vector<Vector<double, 8>> JointSolution::handles_at_tips(
    Communicator const& communicator) const {
    return beyond_tips_of<8>(group, communicator, [&](std::int64_t k) {
        return handle(k, group.bodies.r1[k], axes1(k));
    });
}

/// D^T (outboard - inboard) + bias; 0 along directions that are not restricted.
Vector<double, 6> JointSolution::opening(Vector<double, 8> const& out, Vector<double, 8> const& in,
                                         Vector<double, 6> const& bias, Screw<double> const& s,
                                         int restricted) {
    Vector<double, 8> const d = out - in;
    Vector<double, 6> e = dca::along_directions(
        s, dca::AlongAxes<double>{{{d[0], d[1], d[2]}}, {{d[3], d[4], d[5]}}});
    for (int i = 0; i < 6; ++i) e[i] = i < restricted ? e[i] + bias[i] : 0.0;
    return e;
}

Vec3 JointSolution::yielded(std::int64_t k) const {
    if (!group.joints.is_implicit(k)) return Vec3::zero();
    Vector<double, 6> const f = load_first(joint_force, k, group.directions);
    return as_symmetric(compliance.load(k)) * Vec3{{f[3], f[4], f[5]}};
}

/// |opening| divided by the sizes of its terms. It is one spatial equation: angles are multiplied
/// by the body's `size`, so that the measure does not depend on the unit of length.
double JointSolution::closing(Vector<double, 8> const& out, Vector<double, 8> const& in,
                              Vector<double, 6> const& bias, Screw<double> const& s, int restricted,
                              double size, Vec3 const& yielded_by_it) {
    Vector<double, 6> b = bias;
    auto yields = Vector<double, 6>::zero();
    for (int i = 0; i < 3; ++i) yields[3 + i] = yielded_by_it[i];
    for (int i = restricted; i < 6; ++i) b[i] = 0.0;
    Vector<double, 6> const e = opening(out, in, b + yields, s, restricted);
    auto const sizes = [&](Vector<double, 6> const& v) {
        dca::AlongAxes<double> const parts = dca::along_axes(s, v);
        return norm(parts.linear) + size * norm(parts.angular);
    };
    return relative(sizes(e), out[6] + in[6] + size * (out[7] + in[7]) + sizes(b) + sizes(yields));
}

Vector<double, 8> JointSolution::handle_before(std::int64_t k,
                                               Vector<double, 8> const& before_first) const {
    if (group.ends.is_first[k]) return Vector<double, 8>::zero();
    if (levels.levels() > 0)
        return handle(group.branching.inboard[static_cast<std::size_t>(k)], r2(k), axes2(k));
    return k == 0 ? before_first : handle(k - 1, r2(k - 1), axes2(k - 1));
}

std::pair<Vector<double, 8>, Vector<double, 8>> JointSolution::handles_of_loop(
    std::size_t l) const {
    auto const at = [&](std::int64_t body, LoopEnd const& end) {
        return body == LoopClosure::ground ? Vector<double, 8>::zero()
                                           : handle(body, end.arm, end.axes);
    };
    LoopEnds const& ends = loops->ends()[l];
    return {at(group.loops.own[l].outboard, ends.outboard),
            at(group.loops.own[l].inboard, ends.inboard)};
}

double JointSolution::residual_of_loops() const {
    double worst = 0;
    for (std::size_t l = 0; loops && l < group.loops.own.size(); ++l) {
        LocalLoop const& loop = group.loops.own[l];
        LoopEnds const& ends = loops->ends()[l];
        auto const size_at = [&](std::int64_t body, LoopEnd const& end) {
            return body == LoopClosure::ground ? 0.0 : norm(end.arm) + radius_of(group, body);
        };
        auto const [outboard, inboard] = handles_of_loop(l);
        worst = larger(worst, closing(outboard, inboard, loops->bias()[l],
                                      dca::as_screw(loop.screw), loop.restricted,
                                      std::max(size_at(loop.outboard, ends.outboard),
                                               size_at(loop.inboard, ends.inboard)),
                                      Vec3::zero()));
    }
    return worst;
}

double JointSolution::residual(Communicator const& communicator, Executor const& executor) const {
    Vector<double, 8> const before_first = handle_before_first(communicator);
    auto const at_tips = handles_at_tips(communicator);
    auto const of_body = [&](std::int64_t k) {
        double worst = 0;
        Terms const t = terms_solved_for(k);
        // The acceleration of the ground replaces the weight of bodies. In free fall, therefore,
        // only the rounding of the weight is left in the terms.
        double const mass = group.bodies.mass.view().at(k, 0), weight = mass * norm(given.gravity);
        worst =
            larger(worst, balance(mass * acceleration.load(k), t.forces, weight + t.force_sizes));
        worst = larger(worst, balance(inertial_moment(k), t.moments,
                                      t.moment_sizes + weight * norm(group.bodies.r1[k])));
        double const size = norm(group.bodies.r1[k]) + radius_of(group, k);
        Vector<double, 8> const before = handle_before(k, before_first);
        worst = larger(worst, closing(handle(k, group.bodies.r1[k], axes1(k)), before,
                                      load_first(bias, k, group.directions), screw(k),
                                      group.restricted(k), size, yielded(k)));
        if (!group.ends.has_jointed_tip(k)) return worst;
        return larger(worst, closing(at_tips[group.ends.tip_index(k)], handle(k, r2(k), axes2(k)),
                                     load_first(tip_bias, k, group.directions), outboard_screw(k),
                                     group.ends.tip_of(k).restricted,
                                     norm(r2(k)) + radius_of(group, k), Vec3::zero()));
    };
    double worst = 0;
    std::mutex one_at_a_time;
    executor.for_ranges(group.size, 1, [&](std::int64_t begin, std::int64_t end) {
        double of_range = 0;
        for (std::int64_t k = begin; k < end; ++k) of_range = larger(of_range, of_body(k));
        std::lock_guard const lock(one_at_a_time);
        worst = larger(worst, of_range);
    });
    return communicator.max(larger(worst, residual_of_loops()));
}

JointDefect JointSolution::defect(Communicator const& communicator,
                                  Executor const& executor) const {
    std::int64_t const tips = group.ends.has_tips() ? group.size : 0;
    JointDefect d{Field<3>(group.size),
                  Field<3>(group.size),
                  DirectionsField(group.size + 1, group.directions),
                  DirectionsField(tips, group.directions),
                  {}};
    for (std::size_t l = 0; loops && l < group.loops.own.size(); ++l) {
        auto const [outboard, inboard] = handles_of_loop(l);
        d.loop_bias.push_back(opening(outboard, inboard, loops->bias()[l],
                                      dca::as_screw(group.loops.own[l].screw),
                                      group.loops.own[l].restricted));
    }
    Vector<double, 8> const before_first = handle_before_first(communicator);
    auto const at_tips = handles_at_tips(communicator);
    executor.for_each(group.size, [&](std::int64_t k) {
        Terms const t = terms_solved_for(k);
        d.torque.set(k, sum_of(t.moments) - inertial_moment(k));
        d.force.set(k, sum_of(t.forces) - group.bodies.mass.view().at(k, 0) * acceleration.load(k));
        store_first(d.bias.view(), k, group.directions,
                    opening(handle(k, group.bodies.r1[k], axes1(k)), handle_before(k, before_first),
                            load_first(bias, k, group.directions), screw(k), group.restricted(k)));
        if (group.ends.has_jointed_tip(k))
            store_first(d.tip_bias.view(), k, group.directions,
                        opening(at_tips[group.ends.tip_index(k)], handle(k, r2(k), axes2(k)),
                                load_first(tip_bias, k, group.directions), outboard_screw(k),
                                group.ends.tip_of(k).restricted));
    });
    return d;
}

}  // namespace catena
