// A run of bodies on revolute joints seen from its two handles (segment.hpp) by way of their
// inertias, host and device: a revolute joint releases one direction, where joining two segments
// eliminates five. Real = double, wider, or several side by side.
//
// Bodies are taken from the first to the last as in the articulated-body algorithm (Featherstone,
// Rigid Body Dynamics Algorithms, 2008, section 7.2), with what a force at the run's first joint
// does carried along (Lilly and Orin, Int. J. Robotics Research 10, 1991: extended force
// propagators), so that the run floats. All of it is in the axes of the run's first body and about
// the outboard handle of the body come to, of the last one (RunsEnd) about its joint and in that
// one's axes:
//   {torque, force} = I {alpha, a} + bias - first f1,   a1 = z f1 + first^T {alpha, a} + e,
// f1 the force at handle 1 along its K = 5 directions (make_handle), a1 the acceleration along
// them, {torque, force} on the body's outboard side, {alpha, a} its accelerations at that point as
// if it turned at rest: without omega x (omega x r) of its handles. Within the run {alpha, a} are
// against what velocities alone make of the run whose first body does not accelerate
// (FloatingRun::swing): so no revolute joint has terms of its own, as in Newton-Euler's way
// outwards (Featherstone 2008, section 5.3).
#pragma once

#include "dca/bead_leaf.hpp"
#include "dca/inertia.hpp"

namespace catena::dca {

/// What the way back needs of a body, in its axes: its handles' axes in the columns of e1 and e2
/// (the revolute joint is the last one of e1), omega x (omega x r) at its two handles, and the
/// velocity terms of its inboard joint along its directions.
template <class Real>
struct RevoluteFrame {
    Vector<Real, 3> r1, r2;
    Matrix<Real, 3, 3> e1, e2;
    Vector<Real, 3> inward1, inward2;
    Vector<Real, 5> bias;

    CATENA_HD Handle<Real, 5> handle1() const { return make_handle<5>(r1, e1, e1); }
    CATENA_HD Handle<Real, 5> handle2() const { return make_handle<5>(r2, e2, e2); }
    /// From this body's axes to those of the one before.
    CATENA_HD Matrix<Real, 3, 3> turn_to(Matrix<Real, 3, 3> const& e2_before) const {
        return orthogonal(e2_before * transpose(e1));
    }
};
/// And the way up, with what acts on it, the gyroscopic torque included.
template <class Real>
struct ArticulatedBody : RevoluteFrame<Real> {
    Real mass;
    Symmetric<Real, 3> inertia;
    Vector<Real, 3> torque, force;
};

template <class Real>
struct BodyAcceleration {
    Vector<Real, 3> alpha, a;  // of the centre of mass, but where another point is named
};
/// A body within a run and the revolute joint that the run comes to it by, in the run's axes: what
/// both ways need.
template <class Real>
struct BodyInRun {
    Vector<Real, 3> axis;    // of the revolute joint
    Vector<Real, 3> across;  // from handle 1 to handle 2
};
/// And the way up.
template <class Real>
struct LoadedBodyInRun : BodyInRun<Real> {
    BodyAcceleration<Real>
        difference;  // of the revolute joint's two sides at the meeting point, by velocities alone
    Vector<Real, 3> centre;  // of mass, from handle 2
    Real mass;
    Symmetric<Real, 3> inertia;
    Vector<Real, 3> torque, force;
};
/// A body on a revolute joint within a run whose motion is found along it (run_kinematics.hpp), in
/// its own axes.
template <class Real>
struct BodyOnRevolute {
    Quaternion<Real> turn;  // to the axes of the body before
    Vector<Real, 3> axis, r1, r2;
    Real rate, mass;
    Symmetric<Real, 3> inertia;
};
template <class Real>
struct FloatingRun {
    SpatialInertia<Real> inertia;
    Wrench<Real> bias, first[5];
    Symmetric<Real, 5> z;
    Vector<Real, 5> e;
    BodyAcceleration<Real> swing;  // by velocities alone, of the body come to at its handle 2
};
/// The end of a run, about its last joint's meeting point and in that joint's axes: the factor
/// (factorize()) of I, first and bias. Rows force, then torque, that about the revolute joint last:
/// light bodies on heavy ones have little more than their own inertia there, which then is added to
/// nothing.
template <class Real>
struct RunsEnd {
    Symmetric<Real, 6> factor;
    Matrix<Real, 6, 5> first;
    Vector<Real, 6> bias;
};

/// What the run's accelerations at its first joint gain by a revolute joint: row j of z, up to its
/// diagonal, and of e.
template <class Real>
CATENA_HD void gain_row(ReleasedRevolute<Real> const& h, Real const& first, int j, Real (&row)[5],
                        Real& e) {
    Real const share = h.inverse * first;
    CATENA_UNROLL
    for (int i = 0; i < 5; ++i)
        if (i <= j) row[i] = fused(h.first[i], share, row[i]);
    e = less_product(share, h.bias, e);
}

/// By what accelerations on the revolute joint's two sides differ: the bias's share. `all`: released.
template <class Real>
CATENA_HD void take_difference(Wrench<Real>& bias, SpatialInertia<Real> const& all, BodyAcceleration<Real> const& d) {
    bias.torque = bias.torque - (all.turning * d.alpha + all.coupling * d.a);
    bias.force = bias.force - (transposed_times(all.coupling, d.alpha) + all.moving * d.a);
}
/// And that of e, by `first` of its row.
template <class Real>
CATENA_HD void take_difference(Real& e, Wrench<Real> const& first, BodyAcceleration<Real> const& d) {
    e = e - (dot(first.torque, d.alpha) + dot(first.force, d.a));
}
/// Of a body, from that of the one before it. `Body`: with difference and across, as LoadedBodyInRun.
template <class Real, class Body>
CATENA_HD void swing_on(BodyAcceleration<Real>& swing, Body const& body) {
    swing.alpha = swing.alpha + body.difference.alpha;
    swing.a = (swing.a + body.difference.a) + cross(swing.alpha, body.across);
}
/// What acts on a body less what its swing takes.
template <class Real>
CATENA_HD Wrench<Real> load_of(LoadedBodyInRun<Real> const& body, BodyAcceleration<Real> const& swing) {
    return {body.torque - body.inertia * swing.alpha, plus_scaled(body.force, -body.mass, swing.a + cross(swing.alpha, body.centre))};
}
/// Past a revolute joint about `axis`.
template <class Real, class Torque>
CATENA_HD ReleasedRevolute<Real> pass_revolute(FloatingRun<Real>& run, Vector<Real, 3> const& axis, Torque const& torque) {
    ReleasedRevolute<Real> h;
    Release<Real> const r = release_revolute(run.inertia, axis, h);
    h.bias = release_driven(run.bias, r, torque);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) h.first[j] = release_revolute(run.first[j], r);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) {
        Real row[5];
        CATENA_UNROLL
        for (int i = 0; i <= j; ++i) row[i] = run.z(j, i);
        gain_row(h, h.first[j], j, row, run.e[j]);
        CATENA_UNROLL
        for (int i = 0; i <= j; ++i) run.z(j, i) = row[i];
    }
    return h;
}
template <class Real>
CATENA_HD void take_difference(FloatingRun<Real>& run, BodyAcceleration<Real> const& d) {
    take_difference(run.bias, run.inertia, d);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) take_difference(run.e[j], run.first[j], d);
}
/// Of one body: its `first` along direction j, and e of that row.
template <class Real>
CATENA_HD Wrench<Real> first_of(ArticulatedBody<Real> const& body, int j) {
    Matrix<Real, 3, 5> const torque = body.handle1().torque;
    Wrench<Real> first{torque.column(j), j < 3 ? body.e1.column(j) : Vector<Real, 3>::zero()};
    move_point(first, body.r2);
    return first;
}
template <class Real>
CATENA_HD Real row_of_first(ArticulatedBody<Real> const& body, int j) {
    return j < 3 ? body.bias[j] + dot(body.e1.column(j), body.inward1) : body.bias[j];
}
template <class Real>
CATENA_HD SpatialInertia<Real> inertia_of(ArticulatedBody<Real> const& body) {
    SpatialInertia<Real> all{Symmetric<Real, 3>::zero(), Symmetric<Real, 3>::zero(), Matrix<Real, 3, 3>::zero()};
    add_body(all, added_body(body.mass, body.inertia, -body.r2));
    return all;
}
template <class Real>
CATENA_HD Wrench<Real> bias_of(ArticulatedBody<Real> const& body) {
    Wrench<Real> bias{Vector<Real, 3>::zero(), Vector<Real, 3>::zero()};
    add_load(bias, about_point({body.torque, body.force}, -body.r2));
    return bias;
}
template <class Real>
CATENA_HD FloatingRun<Real> begin_run(ArticulatedBody<Real> const& body) {
    auto const none = Vector<Real, 3>::zero();
    FloatingRun<Real> run{inertia_of(body), bias_of(body), {}, Symmetric<Real, 5>::zero(), {}, {none, none}};
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) {
        run.first[j] = first_of(body, j);
        run.e[j] = row_of_first(body, j);
    }
    return run;
}
/// Handle 2 of a run's last body as RunsEnd has it.
template <class Real>
CATENA_HD Handle<Real, 5> handle2_of_end(RevoluteFrame<Real> const& last) {
    Matrix<Real, 3, 3> const axes = transposed_times(last.e1, last.e2);
    return make_handle<5>(transposed_times(last.e1, last.r2 - last.r1), axes, axes);
}
/// `body` in the run's axes, to which `turn` leads from its own; `inward`: omega x (omega x r) at handle 2 of the one before, in the run's.
template <class Real>
CATENA_HD LoadedBodyInRun<Real> in_run(ArticulatedBody<Real> const& body, Matrix<Real, 3, 3> const& turn, Vector<Real, 3> const& inward) {
    using Vector3 = Vector<Real, 3>;
    Vector3 const angular = body.bias[3] * body.e1.column(0) + body.bias[4] * body.e1.column(1);
    Vector3 const linear = body.inward1 + body.e1 * Vector3{{body.bias[0], body.bias[1], body.bias[2]}};
    return {{turn * body.e1.column(2), turn * (body.r2 - body.r1)},
            {-(turn * angular), inward - turn * linear},
            -(turn * body.r2),
            body.mass,
            turned(turn, body.inertia),
            turn * body.torque,
            turn * body.force};
}
/// Goes on to a body that is not the last of the run; what it returns is for the way back.
template <class Real, class Torque>
CATENA_HD ReleasedRevolute<Real> go_on(FloatingRun<Real>& run, LoadedBodyInRun<Real> const& body, Torque const& torque) {
    ReleasedRevolute<Real> const revolute = pass_revolute(run, body.axis, torque);
    swing_on(run.swing, body);
    move_point(run.inertia, body.across);
    move_point(run.bias, body.across);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) move_point(run.first[j], body.across);
    add_body(run.inertia, added_body(body.mass, body.inertia, body.centre));
    add_load(run.bias, about_point(load_of(body, run.swing), body.centre));
    return revolute;
}
/// The outboard handle of the body before the last one, in the run's axes.
template <class Real>
struct OutboardHandle {
    Matrix<Real, 3, 3> axes;
    Vector<Real, 3> inward;
};
/// Of the two sides of the run's last revolute joint by velocities alone, in its own axes; `inward`: of the handle inboard of it, in these too.
template <class Real>
CATENA_HD BodyAcceleration<Real> last_difference(RevoluteFrame<Real> const& last, Vector<Real, 3> const& inward) {
    using Vector3 = Vector<Real, 3>;
    return {Vector3{{-last.bias[3], -last.bias[4], Real(0)}},
            inward - (transposed_times(last.e1, last.inward1) + Vector3{{last.bias[0], last.bias[1], last.bias[2]}})};
}
template <class Real>
CATENA_HD Vector<Real, 3> last_axis() {
    return {{Real(0), Real(0), Real(1)}};
}

/// The last body about its joint, in that one's axes.
template <class Real>
struct LastBody {
    Vector<Real, 3> centre;
    Real mass;
    Symmetric<Real, 3> inertia;
    Wrench<Real> load;
};
template <class Real>
CATENA_HD LastBody<Real> last_body(ArticulatedBody<Real> const& last) {
    Matrix<Real, 3, 3> const to_joint = transpose(last.e1);
    Vector<Real, 3> const centre = -(to_joint * last.r1);
    return {centre, last.mass, turned(to_joint, last.inertia), about_point({to_joint * last.torque, to_joint * last.force}, centre)};
}
/// The inertia inboard of the last revolute joint, which is past it: what rounding left about it goes.
template <class Real>
CATENA_HD void leave_revolute(SpatialInertia<Real>& all) {
    CATENA_UNROLL
    for (int j = 0; j < 3; ++j) all.turning(2, j) = all.coupling(2, j) = Real(0);
}
/// Rows of RunsEnd.
template <class Real>
CATENA_HD Vector<Real, 6> six_of(Vector<Real, 3> const& force, Vector<Real, 3> const& torque) {
    return {{force[0], force[1], force[2], torque[0], torque[1], torque[2]}};
}
/// I of RunsEnd, of what is inboard and the last body.
template <class Real>
CATENA_HD Symmetric<Real, 6> inertia_of_end(SpatialInertia<Real> const& inboard, LastBody<Real> const& last) {
    Real const square = dot(last.centre, last.centre);
    Symmetric<Real, 6> all;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        auto unit = Vector<Real, 3>::zero();
        unit[i] = last.mass;
        Vector<Real, 3> const arm = cross(last.centre, unit);  // column i of the last body's coupling
        CATENA_UNROLL
        for (int j = 0; j < 3; ++j) {
            all(3 + j, i) = inboard.coupling(j, i) + arm[j];
            if (j > i) continue;
            all(i, j) = i == j ? inboard.moving(i, j) + last.mass : inboard.moving(i, j);
            Real const apart = less_product(last.centre[i], last.centre[j], i == j ? square : Real(0));
            all(3 + i, 3 + j) = inboard.turning(i, j) + fused(last.mass, apart, last.inertia(i, j));
        }
    }
    return all;
}
template <class Real>
CATENA_HD Vector<Real, 6> bias_of_end(Wrench<Real> const& inboard, LastBody<Real> const& last) {
    return six_of(inboard.force - last.load.force, inboard.torque - last.load.torque);
}
/// Goes on to `last`, the last body, in the joint's axes; `revolute joint`: for the way back, in these axes too.
template <class Real, class Torque>
CATENA_HD RunsEnd<Real> end_run(FloatingRun<Real>& run, OutboardHandle<Real> const& before, ArticulatedBody<Real> const& last,
                                ReleasedRevolute<Real>& revolute, Torque const& torque) {
    take_difference(run, run.swing);
    Matrix<Real, 3, 3> const turn = transpose(before.axes);
    turn_axes(run.inertia, turn);
    turn_axes(run.bias, turn);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) turn_axes(run.first[j], turn);
    revolute = pass_revolute(run, last_axis<Real>(), torque);
    leave_revolute(run.inertia);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) run.first[j].torque[2] = Real(0);
    run.bias.torque[2] = left_along_revolute<Real>(torque);
    take_difference(run, last_difference(last, turn * before.inward));

    LastBody<Real> const body = last_body(last);
    RunsEnd<Real> end;
    end.factor = factorize(inertia_of_end(run.inertia, body), 6);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) end.first.set_column(j, six_of(run.first[j].force, run.first[j].torque));
    end.bias = bias_of_end(run.bias, body);
    return end;
}
/// a^T S^-1 b
template <class Real>
CATENA_HD Real product(Symmetric<Real, 6> const& factor, Vector<Real, 6> const& a, Vector<Real, 6> const& b) {
    Real sum = (factor(0, 0) * a[0]) * b[0];
    CATENA_UNROLL
    for (int i = 1; i < 6; ++i) sum = fused(factor(i, i) * a[i], b[i], sum);
    return sum;
}
/// Column j of handle 2 of a run's last body, as rows of RunsEnd.
template <class Real>
CATENA_HD Vector<Real, 6> second_of(Handle<Real, 5> const& handle2_of_end, int j) {
    Vector<Real, 3> const force = j < 3 ? handle2_of_end.force.column(j < 3 ? j : 0) : Vector<Real, 3>::zero();
    return six_of(force, handle2_of_end.torque.column(j));
}
/// Of the last body by velocities alone, at that handle along its directions.
template <class Real>
CATENA_HD Vector<Real, 5> bias_beyond(Handle<Real, 5> const& handle2_of_end, RevoluteFrame<Real> const& last) {
    return along(handle2_of_end, Vector<Real, 3>::zero(), transposed_times(last.e1, last.inward2));
}
/// The run as the tree joins it to others.
template <class Real>
CATENA_HD BiasedSegment<Real, 5> segment_of(FloatingRun<Real> const& run, RunsEnd<Real> const& end, RevoluteFrame<Real> const& last) {
    Handle<Real, 5> const h = handle2_of_end(last);
    Matrix<Real, 6, 5> first, second;  // L^-1 of them
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) {
        first.set_column(j, solve_lower(end.factor, end.first.column(j)));
        second.set_column(j, solve_lower(end.factor, second_of(h, j)));
    }
    Vector<Real, 6> const bias = solve_lower(end.factor, end.bias);
    BiasedSegment<Real, 5> s{{}, {run.e, bias_beyond(h, last)}};
    CATENA_UNROLL
    for (int i = 0; i < 5; ++i) {
        CATENA_UNROLL
        for (int j = 0; j < 5; ++j) {
            s.matrix.z12(i, j) = product(end.factor, first.column(i), second.column(j));
            if (j > i) continue;
            s.matrix.z11(i, j) = run.z(i, j) + product(end.factor, first.column(i), first.column(j));
            s.matrix.z22(i, j) = product(end.factor, second.column(i), second.column(j));
        }
        s.bias.b1[i] = s.bias.b1[i] - product(end.factor, first.column(i), bias);
        s.bias.b2[i] = s.bias.b2[i] - product(end.factor, second.column(i), bias);
    }
    return s;
}

/// Of the last body at its joint and in that one's axes, from the forces at the run's first joint and at the one after it.
template <class Real>
CATENA_HD BodyAcceleration<Real> last_acceleration(RunsEnd<Real> const& end, RevoluteFrame<Real> const& last, Vector<Real, 5> const& first,
                                                   Vector<Real, 5> const& next) {
    Handle<Real, 5> const h = handle2_of_end(last);
    Vector<Real, 6> const wrench = end.first * first - (six_of(push(h, next), moment(h, next)) + end.bias);
    Vector<Real, 6> const y = solve_upper(end.factor, solve_lower(end.factor, wrench));
    return {{{y[3], y[4], y[5]}}, {{y[0], y[1], y[2]}}};
}
template <class Real>
CATENA_HD BodyAcceleration<Real> operator+(BodyAcceleration<Real> const& a, BodyAcceleration<Real> const& b) {
    return {a.alpha + b.alpha, a.a + b.a};
}
template <class Real>
CATENA_HD BodyAcceleration<Real> operator-(BodyAcceleration<Real> const& a, BodyAcceleration<Real> const& b) {
    return {a.alpha - b.alpha, a.a - b.a};
}
/// A released revolute joint for the way back, when the force at the run's first joint is known: along, what bias and first then have in it.
template <class Real>
struct PushedRevolute {
    Vector<Real, 3> turning, moving;
    Real inverse, along;
};
template <class Real>
CATENA_HD PushedRevolute<Real> pushed(ReleasedRevolute<Real> const& revolute, Vector<Real, 5> const& first) {
    return {revolute.turning, revolute.moving, revolute.inverse, revolute.bias - dot(revolute.first, first)};
}
template <class Real>
CATENA_HD PushedRevolute<Real> const& pushed(PushedRevolute<Real> const& revolute, Vector<Real, 5> const&) {
    return revolute;
}
/// Back past a revolute joint: from `a` on its outboard side at the meeting point, without what velocities add there, to its inboard side. Returns
/// the outboard body's acceleration against the other about the revolute joint.
template <class Real>
CATENA_HD Real pass_back(PushedRevolute<Real> const& revolute, Vector<Real, 3> const& axis, BodyAcceleration<Real>& a) {
    Real const own = dot(revolute.turning, a.alpha) + (dot(revolute.moving, a.a) + revolute.along);
    Real const of_revolute = own * revolute.inverse;
    a.alpha = plus_scaled(a.alpha, -of_revolute, axis);
    return of_revolute;
}
/// Of a body, in axes to which `turn` leads from its own, from its handle `r` to its centre of mass, in its own.
template <class Real>
CATENA_HD BodyAcceleration<Real> own_acceleration(Matrix<Real, 3, 3> const& turn, Vector<Real, 3> const& r,
                                                  BodyAcceleration<Real> const& at_handle) {
    Vector<Real, 3> const alpha = transposed_times(turn, at_handle.alpha);
    return {alpha, transposed_times(turn, at_handle.a) - cross(alpha, r)};
}
/// Of a body about the revolute joints inboard and outboard of it.
template <class Real>
CATENA_HD Real about_inboard_revolute(RevoluteFrame<Real> const& body, BodyAcceleration<Real> const& a) {
    return transposed_times(body.e1, a.alpha)[2];
}
template <class Real>
CATENA_HD Real about_outboard_revolute(RevoluteFrame<Real> const& body, BodyAcceleration<Real> const& a) {
    return transposed_times(body.e2, a.alpha)[2];
}
/// The velocity terms of a revolute joint along its directions: its axes `e1` and `omega` of the body outboard of it, in that body's axes.
template <class Real>
CATENA_HD Vector<Real, 5> revolute_bias(Matrix<Real, 3, 3> const& e1, Vector<Real, 3> const& omega, Real const& rate) {
    Vector<Real, 3> const w = transposed_times(e1, omega);
    return {{Real(0), Real(0), Real(0), -(rate * w[1]), rate * w[0]}};
}
/// The force at a body's inboard joint, from that at its outboard one.
template <class Real>
CATENA_HD Vector<Real, 5> inboard_force(ArticulatedBody<Real> const& body, BodyAcceleration<Real> const& a, Vector<Real, 5> const& outboard) {
    Handle<Real, 5> const h2 = body.handle2();
    Vector<Real, 3> const force = (body.mass * a.a - body.force) + push(h2, outboard);
    Vector<Real, 3> const torque = (body.inertia * a.alpha - body.torque) + moment(h2, outboard) - cross(body.r1, force);
    Vector<Real, 3> const along_force = transposed_times(body.e1, force), along_torque = transposed_times(body.e1, torque);
    return {{along_force[0], along_force[1], along_force[2], along_torque[0], along_torque[1]}};
}

/// Of runs side by side, where one begins later than others: none does.
struct BeginsOnce {
    template <class Real, class Bodies>
    CATENA_HD void operator()(int, FloatingRun<Real>&, Bodies&) const {}
};
/// The bodies of a run on the way up, which turns them to its axes; body(i) is asked for in turn.
template <class Real, class Body>
class BodiesOfRun {
  public:
    CATENA_HD explicit BodiesOfRun(Body const& body) : body_(body) {}
    CATENA_HD_IN_PLACE ArticulatedBody<Real> first() {
        ArticulatedBody<Real> const b = body_(0);
        state = {Matrix<Real, 3, 3>::identity(), b.e2, b.inward2};
        return b;
    }
    CATENA_HD_IN_PLACE LoadedBodyInRun<Real> next(int i) {
        ArticulatedBody<Real> const b = body_(i);
        state.turn = state.turn * b.turn_to(state.axes2);
        LoadedBodyInRun<Real> const in_axes = in_run(b, state.turn, state.inward);
        state.axes2 = b.e2;
        state.inward = state.turn * b.inward2;
        return in_axes;
    }
    /// In its own axes.
    CATENA_HD_IN_PLACE ArticulatedBody<Real> last(int i) { return body_(i); }
    CATENA_HD OutboardHandle<Real> before_last() const { return {state.turn * state.axes2, state.inward}; }

    /// Of the body come to.
    struct State {
        Matrix<Real, 3, 3> turn, axes2;
        Vector<Real, 3> inward;
    } state;

  private:
    Body const& body_;
};

/// A run of `count` bodies, two or more: `bodies` as BodiesOfRun; after all but the first torque(i), of the revolute joint inboard of it: a Real or
/// Undriven. `kept`: for the way back put(i, ReleasedRevolute, BodyInRun, its swing) of those between the first and the last, put(i,
/// ReleasedRevolute) of the last, put(RunsEnd), and put_axes() of the last revolute joint, in the run's axes. `begin(i, run, bodies)`: after body i, but
/// not the last.
template <class Real, class Bodies, class Torque, class Kept, class Begin = BeginsOnce>
CATENA_HD_IN_PLACE BiasedSegment<Real, 5> climb_revolutes(int count, Bodies&& bodies, Torque const& torque, Kept&& kept, Begin&& begin = {}) {
    FloatingRun<Real> run = begin_run(bodies.first());
    begin(0, run, bodies);
    CATENA_NO_UNROLL
    for (int i = 1; i < count - 1; ++i) {
        LoadedBodyInRun<Real> const body = bodies.next(i);
        ReleasedRevolute<Real> const revolute = go_on(run, body, torque(i));
        kept.put(i, revolute, body, run.swing);
        begin(i, run, bodies);
    }
    OutboardHandle<Real> const before = bodies.before_last();
    ArticulatedBody<Real> const last = bodies.last(count - 1);
    ReleasedRevolute<Real> revolute;
    RunsEnd<Real> const end = end_run(run, before, last, revolute, torque(count - 1));
    kept.put(count - 1, revolute);
    kept.put(end);
    kept.put_axes(before.axes);
    return segment_of(run, end, last);
}
/// And back from the forces at the run's first joint and at the one after it. `kept`: revolute joint(i), body(i), end(), axes(), and swing(i) of the
/// last body but one, if it is not the first, and with `all` of all between. frame(i) is asked for of the last two bodies and the first,
/// and with `all` of every body in turn, from the last to the first: accelerate(i, frame(i), BodyAcceleration) of these but the last but
/// one follows it; at(i, acceleration), which it may change, of every body but the last at its handle 2 in the run's axes, against its
/// swing; turn(i, its relative acceleration) of every revolute joint.
template <class Real, class Frame, class Kept, class Accelerate, class At, class Turn>
CATENA_HD_IN_PLACE void descend_revolutes(int count, bool all, Frame const& frame, Kept const& kept, Vector<Real, 5> const& first,
                                       Vector<Real, 5> const& next, Accelerate&& accelerate, At&& at, Turn&& turn) {
    BodyAcceleration<Real> a;
    Matrix<Real, 3, 3> axes;  // of the joint outboard of the next body, in the run's axes
    {
        RevoluteFrame<Real> const last = frame(count - 1);
        a = last_acceleration(kept.end(), last, first, next);
        accelerate(count - 1, last, own_acceleration(transpose(last.e1), last.r1, a));
        RevoluteFrame<Real> const before = frame(count - 2);
        a = a - last_difference(last, transposed_times(before.e2, before.inward2));
        Real const of_revolute = pass_back(pushed(kept.revolute(count - 1), first), last_axis<Real>(), a);
        turn(count - 1, of_revolute);
        axes = count > 2 ? kept.axes() : before.e2;
        a = {axes * a.alpha, axes * a.a};
        if (count > 2) a = a - kept.swing(count - 2);
    }
    CATENA_NO_UNROLL
    for (int i = count - 2; i > 0; --i) {
        at(i, a);
        if (all) {
            RevoluteFrame<Real> const body = frame(i);
            Matrix<Real, 3, 3> const to_run = axes * transpose(body.e2);
            accelerate(i, body, own_acceleration(to_run, body.r2, a + kept.swing(i)));
            axes = to_run * body.e1;
        }
        BodyInRun<Real> const body = kept.body(i);
        a.a = a.a - cross(a.alpha, body.across);
        turn(i, pass_back(pushed(kept.revolute(i), first), body.axis, a));
    }
    at(0, a);
    RevoluteFrame<Real> const begins = frame(0);
    accelerate(0, begins, BodyAcceleration<Real>{a.alpha, a.a - cross(a.alpha, begins.r2)});
}

}  // namespace catena::dca
