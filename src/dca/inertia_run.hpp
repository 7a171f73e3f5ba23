// A run of bodies on hinges seen from its two handles (segment.hpp) by way of their inertias, host and device: a hinge releases one
// direction, where joining two segments eliminates five. Real = double, wider, or several side by side.
//
// Bodies are taken from the first to the last as in the articulated-body algorithm (Featherstone, Rigid Body Dynamics Algorithms, 2008,
// section 7.2), with what a force at the run's first joint does carried along (Lilly and Orin, Int. J. Robotics Research 10, 1991: extended
// force propagators), so that the run floats. All of it is about a body's centre of mass and in its axes, of the last body (RunsEnd) about
// its joint and in that one's:
//   {torque, force} = I {alpha, a} + bias - first f1,   a1 = z f1 + first^T {alpha, a} + e,
// f1 the force at handle 1 along its K = 5 directions (make_handle), a1 the acceleration along them, {torque, force} on the body's
// outboard side, {alpha, a} its accelerations.
#pragma once

#include "dca/leaf.hpp"
#include "dca/moving_beads.hpp"

namespace catena::dca {

/// What the way back needs of a body, in its axes: its handles' axes in the columns of e1 and e2 (the hinge is the last one of e1), omega x
/// (omega x r) at its two handles, and the velocity terms of its inboard joint along its directions.
template <class Real>
struct HingedFrame {
    Vector<Real, 3> r1, r2;
    Matrix<Real, 3, 3> e1, e2;
    Vector<Real, 3> inward1, inward2;
    Vector<Real, 5> bias;

    CATENA_HD Handle<Real, 5> handle1() const { return make_handle<5>(r1, e1, e1); }
    CATENA_HD Handle<Real, 5> handle2() const { return make_handle<5>(r2, e2, e2); }
    /// Of this body's axes against those of the one before.
    CATENA_HD Matrix<Real, 3, 3> turn_from(Matrix<Real, 3, 3> const& e2_before) const { return e1 * transpose(e2_before); }
};
/// And the way up, with what acts on it, the gyroscopic torque included.
template <class Real>
struct HingedBody : HingedFrame<Real> {
    Real mass;
    Symmetric<Real, 3> inertia;
    Vector<Real, 3> torque, force;
};

template <class Real>
struct SpatialInertia {
    Symmetric<Real, 3> turning, moving;  // I = {{turning, coupling}, {coupling^T, moving}}
    Matrix<Real, 3, 3> coupling;
};
template <class Real>
struct Wrench {
    Vector<Real, 3> torque, force;
};
template <class Real>
struct InertiaRun {
    SpatialInertia<Real> inertia;
    Wrench<Real> bias, first[5];
    Symmetric<Real, 5> z;
    Vector<Real, 5> e;
};
/// A hinge when it was released: I along it, its own share's inverse, and the parts that bias and first have in it. At the meeting point,
/// in the outboard body's axes, of the run's last one in the joint's.
template <class Real>
struct ReleasedHinge {
    Vector<Real, 3> turning, moving;
    Real inverse, bias;
    Vector<Real, 5> first;
};
/// The end of a run, about its last joint's meeting point and in that joint's axes: the factor (factorize()) of I, first and bias. Rows
/// force, then torque, that about the hinge last: light bodies on heavy ones have little more than their own inertia there, which then is
/// added to nothing.
template <class Real>
struct RunsEnd {
    Symmetric<Real, 6> factor;
    Matrix<Real, 6, 5> first;
    Vector<Real, 6> bias;
};
template <class Real>
struct BodyAcceleration {
    Vector<Real, 3> alpha, a;  // of the centre of mass
};

/// About the point r away.
template <class Real>
CATENA_HD void move_point(SpatialInertia<Real>& all, Vector<Real, 3> const& r) {
    Matrix<Real, 3, 3> moved;
    CATENA_UNROLL
    for (int j = 0; j < 3; ++j)
        moved.set_column(j, all.coupling.column(j) - cross(r, Vector<Real, 3>{{all.moving(0, j), all.moving(1, j), all.moving(2, j)}}));
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        Vector<Real, 3> const before{{all.coupling(i, 0), all.coupling(i, 1), all.coupling(i, 2)}};
        Vector<Real, 3> const after{{moved(i, 0), moved(i, 1), moved(i, 2)}};
        Vector<Real, 3> const along = cross(before, r), across = cross(after, r);
        CATENA_UNROLL
        for (int j = 0; j <= i; ++j) all.turning(i, j) = all.turning(i, j) + along[j];
        CATENA_UNROLL
        for (int j = i; j < 3; ++j) all.turning(j, i) = all.turning(j, i) + across[j];
    }
    all.coupling = moved;
}
template <class Real>
CATENA_HD void move_point(Wrench<Real>& w, Vector<Real, 3> const& r) {
    w.torque = w.torque - cross(r, w.force);
}
/// q s q^T
template <class Real>
CATENA_HD Symmetric<Real, 3> turned(Matrix<Real, 3, 3> const& q, Symmetric<Real, 3> const& s) {
    Matrix<Real, 3, 3> const half = q * full(s);
    Symmetric<Real, 3> t;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i)
        CATENA_UNROLL
        for (int j = 0; j <= i; ++j) t(i, j) = fused(half(i, 2), q(j, 2), fused(half(i, 1), q(j, 1), half(i, 0) * q(j, 0)));
    return t;
}
template <class Real>
CATENA_HD void turn_axes(SpatialInertia<Real>& all, Matrix<Real, 3, 3> const& q) {
    all.turning = turned(q, all.turning);
    all.moving = turned(q, all.moving);
    all.coupling = q * all.coupling * transpose(q);
}
template <class Real>
CATENA_HD void turn_axes(Wrench<Real>& w, Matrix<Real, 3, 3> const& q) {
    w = {q * w.torque, q * w.force};
}
/// What a hinge that is released takes away, for a unit of what `along` it there is.
template <class Real>
struct Release {
    Vector<Real, 3> axis, turning, moving;
};
/// No torque acts about `axis`, through the point that I is about, from here on. Of ReleasedHinge all but what the wrenches have.
template <class Real>
CATENA_HD Release<Real> release_hinge(SpatialInertia<Real>& all, Vector<Real, 3> const& axis, ReleasedHinge<Real>& h) {
    h.turning = all.turning * axis;
    h.moving = transposed_times(all.coupling, axis);
    h.inverse = Real(1) / dot(axis, h.turning);
    Release<Real> const r{axis, h.inverse * h.turning, h.inverse * h.moving};
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i)
        CATENA_UNROLL
        for (int j = 0; j < 3; ++j) {
            if (j <= i) all.turning(i, j) = less_product(h.turning[i], r.turning[j], all.turning(i, j));
            if (j <= i) all.moving(i, j) = less_product(h.moving[i], r.moving[j], all.moving(i, j));
            all.coupling(i, j) = less_product(h.turning[i], r.moving[j], all.coupling(i, j));
        }
    return r;
}
template <class Real>
CATENA_HD void take_away(Wrench<Real>& w, Release<Real> const& r, Real const& along) {
    w = {plus_scaled(w.torque, -along, r.turning), plus_scaled(w.force, -along, r.moving)};
}
/// Returns what the wrench had along the hinge.
template <class Real>
CATENA_HD Real release_hinge(Wrench<Real>& w, Release<Real> const& r) {
    Real const along = dot(r.axis, w.torque);
    take_away(w, r, along);
    return along;
}
/// What a hinge does about its axis on the body outboard of it: nothing, or a torque, which then is in no body's own.
struct Undriven {};
template <class Real>
CATENA_HD Real release_driven(Wrench<Real>& bias, Release<Real> const& r, Undriven) {
    return release_hinge(bias, r);
}
template <class Real>
CATENA_HD Real release_driven(Wrench<Real>& bias, Release<Real> const& r, Real const& torque) {
    Real const along = dot(r.axis, bias.torque) + torque;
    take_away(bias, r, along);
    return along;
}
template <class Real>
CATENA_HD Real left_along_hinge(Undriven) {
    return Real(0);
}
template <class Real>
CATENA_HD Real left_along_hinge(Real const& torque) {
    return -torque;
}
/// What the run's accelerations at its first joint gain by a hinge: row j of z, up to its diagonal, and of e.
template <class Real>
CATENA_HD void gain_row(ReleasedHinge<Real> const& h, Real const& first, int j, Real (&row)[5], Real& e) {
    Real const share = h.inverse * first;
    CATENA_UNROLL
    for (int i = 0; i < 5; ++i)
        if (i <= j) row[i] = fused(h.first[i], share, row[i]);
    e = less_product(share, h.bias, e);
}

/// A joint that a run goes on by: from the one body's axes to those in which it goes on, and what the accelerations on its two sides differ
/// by, the hinge's own apart.
template <class Real>
struct HingePassed {
    Matrix<Real, 3, 3> turn;
    Vector<Real, 3> axis, angular, linear;
};
/// The bias's share of that. `all`: released.
template <class Real>
CATENA_HD void differ(Wrench<Real>& bias, SpatialInertia<Real> const& all, HingePassed<Real> const& joint) {
    bias.torque = bias.torque - (all.turning * joint.angular + all.coupling * joint.linear);
    bias.force = bias.force - (transposed_times(all.coupling, joint.angular) + all.moving * joint.linear);
}
/// And that of e, by `first` of its row.
template <class Real>
CATENA_HD void differ(Real& e, Wrench<Real> const& first, HingePassed<Real> const& joint) {
    e = e - (dot(first.torque, joint.angular) + dot(first.force, joint.linear));
}
/// To the hinge, and past it.
template <class Real, class Torque>
CATENA_HD ReleasedHinge<Real> pass_hinge(InertiaRun<Real>& run, Vector<Real, 3> const& to_hinge, HingePassed<Real> const& joint,
                                         Torque const& torque) {
    ReleasedHinge<Real> h;
    move_point(run.inertia, to_hinge);
    turn_axes(run.inertia, joint.turn);
    Release<Real> const r = release_hinge(run.inertia, joint.axis, h);
    auto const bring = [&](Wrench<Real>& w) {
        move_point(w, to_hinge);
        turn_axes(w, joint.turn);
    };
    bring(run.bias);
    h.bias = release_driven(run.bias, r, torque);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) {
        bring(run.first[j]);
        h.first[j] = release_hinge(run.first[j], r);
    }
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
CATENA_HD void differ(InertiaRun<Real>& run, HingePassed<Real> const& joint) {
    differ(run.bias, run.inertia, joint);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) differ(run.e[j], run.first[j], joint);
}
/// A body more at the point that I is about.
template <class Real>
CATENA_HD void add_body(SpatialInertia<Real>& all, HingedBody<Real> const& body) {
    all.turning = all.turning + body.inertia;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) all.moving(i, i) = all.moving(i, i) + body.mass;
}
template <class Real>
CATENA_HD void add_body(Wrench<Real>& bias, HingedBody<Real> const& body) {
    bias = {bias.torque - body.torque, bias.force - body.force};
}
/// Of one body: its `first` along direction j, and e of that row.
template <class Real>
CATENA_HD Wrench<Real> first_of(HingedBody<Real> const& body, int j) {
    Matrix<Real, 3, 5> const torque = body.handle1().torque;
    return {torque.column(j), j < 3 ? body.e1.column(j) : Vector<Real, 3>::zero()};
}
template <class Real>
CATENA_HD Real row_of_first(HingedBody<Real> const& body, int j) {
    return j < 3 ? body.bias[j] + dot(body.e1.column(j), body.inward1) : body.bias[j];
}
template <class Real>
CATENA_HD SpatialInertia<Real> inertia_of(HingedBody<Real> const& body) {
    SpatialInertia<Real> all{Symmetric<Real, 3>::zero(), Symmetric<Real, 3>::zero(), Matrix<Real, 3, 3>::zero()};
    add_body(all, body);
    return all;
}
template <class Real>
CATENA_HD Wrench<Real> bias_of(HingedBody<Real> const& body) {
    Wrench<Real> bias{Vector<Real, 3>::zero(), Vector<Real, 3>::zero()};
    add_body(bias, body);
    return bias;
}
template <class Real>
CATENA_HD InertiaRun<Real> begin_run(HingedBody<Real> const& body) {
    InertiaRun<Real> run{inertia_of(body), bias_of(body), {}, Symmetric<Real, 5>::zero(), {}};
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) {
        run.first[j] = first_of(body, j);
        run.e[j] = row_of_first(body, j);
    }
    return run;
}
/// Handle 2 of a run's last body as RunsEnd has it.
template <class Real>
CATENA_HD Handle<Real, 5> handle2_of_end(HingedFrame<Real> const& last) {
    Matrix<Real, 3, 3> const axes = transposed_times(last.e1, last.e2);
    return make_handle<5>(transposed_times(last.e1, last.r2 - last.r1), axes, axes);
}
/// Outboard handle of the body before: what going on needs of it.
template <class Real>
struct OutboardHandle {
    Vector<Real, 3> r, inward;
    Matrix<Real, 3, 3> axes;
};
template <class Real>
CATENA_HD OutboardHandle<Real> outboard_handle(HingedFrame<Real> const& body) {
    return {body.r2, body.inward2, body.e2};
}
/// The joint between `before` and `body`, in `body`'s axes.
template <class Real>
CATENA_HD HingePassed<Real> joint_between(OutboardHandle<Real> const& before, HingedFrame<Real> const& body) {
    Matrix<Real, 3, 3> const turn = body.turn_from(before.axes);
    return {turn, body.e1.column(2), -(body.bias[3] * body.e1.column(0) + body.bias[4] * body.e1.column(1)),
            turn * before.inward - body.inward1 - body.e1 * Vector<Real, 3>{{body.bias[0], body.bias[1], body.bias[2]}}};
}
/// In its own.
template <class Real>
CATENA_HD HingePassed<Real> last_joint(OutboardHandle<Real> const& before, HingedFrame<Real> const& last) {
    using Vector3 = Vector<Real, 3>;
    return {transpose(before.axes), Vector3{{Real(0), Real(0), Real(1)}}, Vector3{{-last.bias[3], -last.bias[4], Real(0)}},
            transposed_times(before.axes, before.inward) -
                (transpose(last.e1) * last.inward1 + Vector3{{last.bias[0], last.bias[1], last.bias[2]}})};
}
/// Goes on to `body`, the one after `before` and not the last of the run; what it returns is for the way back.
template <class Real, class Torque>
CATENA_HD ReleasedHinge<Real> go_on(InertiaRun<Real>& run, OutboardHandle<Real> const& before, HingedBody<Real> const& body,
                                    Torque const& torque) {
    HingePassed<Real> const joint = joint_between(before, body);
    ReleasedHinge<Real> const hinge = pass_hinge(run, before.r, joint, torque);
    differ(run, joint);
    Vector<Real, 3> const to_centre = -body.r1;
    move_point(run.inertia, to_centre);
    move_point(run.bias, to_centre);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) move_point(run.first[j], to_centre);
    add_body(run.inertia, body);
    add_body(run.bias, body);
    return hinge;
}

template <class Real>
CATENA_HD Vector<Real, 6> six_of(Vector<Real, 3> const& force, Vector<Real, 3> const& torque) {
    return {{force[0], force[1], force[2], torque[0], torque[1], torque[2]}};
}
/// Goes on to `last`, the last body, in the joint's axes; `hinge` as go_on(), in these axes too.
template <class Real, class Torque>
CATENA_HD RunsEnd<Real> end_run(InertiaRun<Real>& run, OutboardHandle<Real> const& before, HingedBody<Real> const& last,
                                ReleasedHinge<Real>& hinge, Torque const& torque) {
    using Vector3 = Vector<Real, 3>;
    HingePassed<Real> const joint = last_joint(before, last);
    hinge = pass_hinge(run, before.r, joint, torque);
    CATENA_UNROLL
    for (int j = 0; j < 3; ++j) run.inertia.turning(2, j) = run.inertia.coupling(2, j) = Real(0);  // not what rounding left there
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) run.first[j].torque[2] = Real(0);
    run.bias.torque[2] = left_along_hinge<Real>(torque);
    differ(run, joint);

    Matrix<Real, 3, 3> const to_joint = transpose(last.e1);
    Vector3 const centre = -(to_joint * last.r1), force = to_joint * last.force;
    Symmetric<Real, 3> const inertia = turned(to_joint, last.inertia);
    Real const square = dot(centre, centre);
    Symmetric<Real, 6> all;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        Vector3 unit = Vector3::zero();
        unit[i] = last.mass;
        Vector3 const arm = cross(centre, unit);  // column i of the last body's coupling
        CATENA_UNROLL
        for (int j = 0; j < 3; ++j) {
            all(3 + j, i) = run.inertia.coupling(j, i) + arm[j];
            if (j > i) continue;
            all(i, j) = i == j ? run.inertia.moving(i, j) + last.mass : run.inertia.moving(i, j);
            Real const apart = less_product(centre[i], centre[j], i == j ? square : Real(0));
            all(3 + i, 3 + j) = run.inertia.turning(i, j) + fused(last.mass, apart, inertia(i, j));
        }
    }
    RunsEnd<Real> end;
    end.factor = factorize(all, 6);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) end.first.set_column(j, six_of(run.first[j].force, run.first[j].torque));
    end.bias = six_of(run.bias.force - force, run.bias.torque - (to_joint * last.torque + cross(centre, force)));
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
/// The run as the tree joins it to others.
template <class Real>
CATENA_HD BiasedSegment<Real, 5> segment_of(InertiaRun<Real> const& run, RunsEnd<Real> const& end, HingedFrame<Real> const& last) {
    using Vector3 = Vector<Real, 3>;
    Handle<Real, 5> const h = handle2_of_end(last);
    Matrix<Real, 6, 5> first, second;  // L^-1 of them
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) {
        Vector3 const force = j < 3 ? h.force.column(j < 3 ? j : 0) : Vector3::zero();
        first.set_column(j, solve_lower(end.factor, end.first.column(j)));
        second.set_column(j, solve_lower(end.factor, six_of(force, h.torque.column(j))));
    }
    Vector<Real, 6> const bias = solve_lower(end.factor, end.bias);
    BiasedSegment<Real, 5> s{{}, {run.e, along(h, Vector3::zero(), transposed_times(last.e1, last.inward2))}};
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

/// Of the last body, from the forces at the run's first joint and at the one after it.
template <class Real>
CATENA_HD BodyAcceleration<Real> last_acceleration(RunsEnd<Real> const& end, HingedFrame<Real> const& last, Vector<Real, 5> const& first,
                                                   Vector<Real, 5> const& next) {
    using Vector3 = Vector<Real, 3>;
    Handle<Real, 5> const h = handle2_of_end(last);
    Vector<Real, 6> const wrench = end.first * first - (six_of(push(h, next), moment(h, next)) + end.bias);
    Vector<Real, 6> const y = solve_upper(end.factor, solve_lower(end.factor, wrench));
    Vector3 const alpha = last.e1 * Vector3{{y[3], y[4], y[5]}};
    return {alpha, last.e1 * Vector3{{y[0], y[1], y[2]}} - cross(alpha, last.r1)};
}
/// Of `before`, from that of `body` and the force at the run's first joint; `of_hinge`: of `body` against it, about the hinge between them.
/// `at_end`: `body` is the last of the run.
template <bool at_end, class Real>
CATENA_HD BodyAcceleration<Real> go_back(ReleasedHinge<Real> const& hinge, HingedFrame<Real> const& before, HingedFrame<Real> const& body,
                                         BodyAcceleration<Real> const& of_body, Vector<Real, 5> const& first, Real& of_hinge) {
    using Vector3 = Vector<Real, 3>;
    // Along the joint's axes: what the inboard side has, and the hinge's own.
    Vector3 turning = transposed_times(body.e1, of_body.alpha);
    Vector3 moving = transposed_times(body.e1, of_body.a + (cross(of_body.alpha, body.r1) + body.inward1));
    turning = turning + Vector3{{body.bias[3], body.bias[4], Real(0)}};
    moving = moving + Vector3{{body.bias[0], body.bias[1], body.bias[2]}};
    Vector3 const linear = moving - transposed_times(before.e2, before.inward2);
    Vector3 const turned = at_end ? turning : body.e1 * turning, moved = at_end ? linear : body.e1 * linear;
    Real const own = dot(hinge.turning, turned) + (dot(hinge.moving, moved) + (hinge.bias - dot(hinge.first, first)));
    of_hinge = own * hinge.inverse;
    turning[2] = less_product(own, hinge.inverse, turning[2]);
    BodyAcceleration<Real> a{before.e2 * turning, {}};
    a.a = before.e2 * linear - cross(a.alpha, before.r2);
    return a;
}
/// Of a body about the hinges inboard and outboard of it.
template <class Real>
CATENA_HD Real about_inboard_hinge(HingedFrame<Real> const& body, BodyAcceleration<Real> const& a) {
    return transposed_times(body.e1, a.alpha)[2];
}
template <class Real>
CATENA_HD Real about_outboard_hinge(HingedFrame<Real> const& body, BodyAcceleration<Real> const& a) {
    return transposed_times(body.e2, a.alpha)[2];
}
/// The velocity terms of a hinge along its directions: its axes `e1` and `omega` of the body outboard of it, in that body's axes.
template <class Real>
CATENA_HD Vector<Real, 5> hinge_bias(Matrix<Real, 3, 3> const& e1, Vector<Real, 3> const& omega, Real const& rate) {
    Vector<Real, 3> const w = transposed_times(e1, omega);
    return {{Real(0), Real(0), Real(0), -(rate * w[1]), rate * w[0]}};
}
/// The force at a body's inboard joint, from that at its outboard one.
template <class Real>
CATENA_HD Vector<Real, 5> inboard_force(HingedBody<Real> const& body, BodyAcceleration<Real> const& a, Vector<Real, 5> const& outboard) {
    Handle<Real, 5> const h2 = body.handle2();
    Vector<Real, 3> const force = (body.mass * a.a - body.force) + push(h2, outboard);
    Vector<Real, 3> const torque = (body.inertia * a.alpha - body.torque) + moment(h2, outboard) - cross(body.r1, force);
    Vector<Real, 3> const along_force = transposed_times(body.e1, force), along_torque = transposed_times(body.e1, torque);
    return {{along_force[0], along_force[1], along_force[2], along_torque[0], along_torque[1]}};
}

/// Of runs side by side, where one begins later than others: none does.
struct BeginsOnce {
    template <class Real>
    CATENA_HD void operator()(int, InertiaRun<Real>&) const {}
};
/// A run of `count` bodies, two or more: body(i) is asked for in turn, and after all but the first torque(i), of the hinge inboard of it: a
/// Real or Undriven. `kept`: put(i, ReleasedHinge) of joint i in the run, and put(RunsEnd), for the way back. `begin(i, run)`: after body i,
/// but not the last.
template <class Real, class Body, class Torque, class Kept, class Begin = BeginsOnce>
CATENA_HD_IN_PLACE BiasedSegment<Real, 5> climb_hinges(int count, Body const& body, Torque const& torque, Kept&& kept, Begin&& begin = {}) {
    HingedBody<Real> const begins = body(0);
    InertiaRun<Real> run = begin_run(begins);
    begin(0, run);
    OutboardHandle<Real> before = outboard_handle(begins);
    CATENA_NO_UNROLL
    for (int i = 1; i < count - 1; ++i) {
        HingedBody<Real> const next = body(i);
        kept.put(i, go_on(run, before, next, torque(i)));
        begin(i, run);
        before = outboard_handle(next);
    }
    HingedBody<Real> const last = body(count - 1);
    ReleasedHinge<Real> hinge;
    RunsEnd<Real> const end = end_run(run, before, last, hinge, torque(count - 1));
    kept.put(count - 1, hinge);
    kept.put(end);
    return segment_of(run, end, last);
}
/// And back from the forces at the run's first joint and at the one after it: frame(i) is asked for from the last body to the first,
/// accelerate(i, frame(i), BodyAcceleration) of each follows it, and turn(i, its relative acceleration) of the hinge inboard of it when the next frame
/// is known. `kept`: hinge(i) and end(). `ahead`: a frame is asked for one body earlier, so that reading it stands in nobody's way.
template <class Real, bool ahead, class Frame, class Kept, class Accelerate, class Turn>
CATENA_HD_IN_PLACE void descend_hinges(int count, Frame const& frame, Kept const& kept, Vector<Real, 5> const& first,
                                       Vector<Real, 5> const& next, Accelerate&& accelerate, Turn&& turn) {
    HingedFrame<Real> body = frame(count - 1), before, after;
    BodyAcceleration<Real> a = last_acceleration(kept.end(), body, first, next);
    accelerate(count - 1, body, a);
    before = frame(count - 2);
    if (ahead && count > 2) after = frame(count - 3);
    Real of_hinge;
    a = go_back<true>(kept.hinge(count - 1), before, body, a, first, of_hinge);
    turn(count - 1, of_hinge);
    accelerate(count - 2, before, a);
    CATENA_NO_UNROLL
    for (int i = count - 2; i > 0; --i) {
        body = before;
        before = ahead ? after : frame(i - 1);
        if (ahead && i > 1) after = frame(i - 2);
        a = go_back<false>(kept.hinge(i), before, body, a, first, of_hinge);
        turn(i, of_hinge);
        accelerate(i - 1, before, a);
    }
}

}  // namespace catena::dca
