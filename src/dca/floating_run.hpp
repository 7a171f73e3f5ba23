// Assembly and disassembly of a run of bodies on revolute joints by articulated-body inertias, host
// and device. The result is the run's segment between its two handles (segment.hpp). Passing a
// revolute joint releases one direction, where joining two segments eliminates five. Real = double,
// a wider type, or a SIMD vector of several runs side by side.
//
// The inward pass goes from the first body to the last, as in the articulated-body algorithm
// (Featherstone, Rigid Body Dynamics Algorithms, 2008, section 7.2). It carries along the response
// to a force at the run's first joint, so that the run floats (extended force propagators; Lilly
// and Orin, Int. J. Robotics Research 10, 1991). All quantities are in the axes of the run's first
// body and about the outboard handle of the current body. Those of the run's end (RunsEnd) are
// about the last body's inboard joint and in that joint's axes:
//   {torque, force} = I {alpha, a} + bias - first f1,   a1 = z f1 + first^T {alpha, a} + e.
// Here f1 is the force at handle 1 along its K = 5 directions (make_handle), and a1 is the
// acceleration along them. {torque, force} acts on the outboard side of the current body. {alpha,
// a} is the acceleration of that point without the centripetal terms omega x (omega x r) of the
// body's handles.
//
// Within the run, {alpha, a} is relative to the accelerations that velocities alone cause while the
// first body does not accelerate (FloatingRun::velocity_bias). Revolute joints within the run
// therefore have no velocity terms of their own, as in the outward pass of the Newton-Euler
// algorithm (Featherstone 2008, section 5.3).
#pragma once

#include "dca/bead_leaf.hpp"
#include "dca/inertia.hpp"

namespace catena::dca {

/// Kinematics of one body that the outward pass needs. All vectors and matrices are in the body's
/// axes.
template <class Real>
struct RevoluteFrame {
    /// Handles 1 and 2, from the centre of mass.
    Vector<Real, 3> r1, r2;
    /// Axes of the two handles, in columns; the last column of `e1` is the inboard revolute joint's
    /// axis.
    Matrix<Real, 3, 3> e1, e2;
    /// Centripetal accelerations omega x (omega x r) at the two handles.
    Vector<Real, 3> inward1, inward2;
    /// Velocity terms of the inboard joint along its five directions (LoadsView::bias).
    Vector<Real, 5> bias;

    CATENA_HD Handle<Real, 5> handle1() const { return make_handle<5>(r1, e1, e1); }
    CATENA_HD Handle<Real, 5> handle2() const { return make_handle<5>(r2, e2, e2); }
    /// Returns the rotation matrix from this body's axes to those of the body before, whose
    /// outboard axes are `e2_before`.
    CATENA_HD Matrix<Real, 3, 3> rotation_to(Matrix<Real, 3, 3> const& e2_before) const {
        return orthogonal(e2_before * transpose(e1));
    }
};
/// RevoluteFrame with the inertia and the loads that the inward pass needs as well.
template <class Real>
struct ArticulatedBody : RevoluteFrame<Real> {
    /// Mass, and inertia about the centre of mass.
    Real mass;
    Symmetric<Real, 3> inertia;
    /// Torque about the centre of mass and force on the body. The torque includes the gyroscopic
    /// torque.
    Vector<Real, 3> torque, force;
};

/// Angular acceleration, and linear acceleration of the centre of mass unless another point is
/// named.
template <class Real>
struct BodyAcceleration {
    Vector<Real, 3> alpha, a;
};
/// A body within a run and its inboard revolute joint, in the run's axes. Both passes need it.
template <class Real>
struct BodyInRun {
    Vector<Real, 3> axis;    // Axis of the inboard revolute joint.
    Vector<Real, 3> across;  // Vector from handle 1 to handle 2.
};
/// BodyInRun with the inertia and the loads that the inward pass needs as well.
template <class Real>
struct LoadedBodyInRun : BodyInRun<Real> {
    /// Velocity-dependent relative acceleration of the inboard joint: outboard side minus inboard
    /// side, at the meeting point.
    BodyAcceleration<Real> difference;
    Vector<Real, 3> centre;  // Centre of mass, from handle 2.
    Real mass;
    Symmetric<Real, 3> inertia;
    /// Torque about the centre of mass and force on the body.
    Vector<Real, 3> torque, force;
};
/// A body on a revolute joint within a run whose velocities are computed along the run
/// (run_kinematics.hpp). Its vectors and inertia are in its own axes.
template <class Real>
struct BodyOnRevolute {
    Quaternion<Real> rotation;  // Rotation to the axes of the body before.
    /// Axis of the joint, and the two handles from the centre of mass.
    Vector<Real, 3> axis, r1, r2;
    /// Rate of the joint, in radians per unit of time, and mass of the body.
    Real rate, mass;
    Symmetric<Real, 3> inertia;
};
/// State of the inward pass at the outboard handle of the current body; the equations are at the
/// head of this file.
template <class Real>
struct FloatingRun {
    SpatialInertia<Real> inertia;
    Wrench<Real> bias, first[5];
    Symmetric<Real, 5> z;
    Vector<Real, 5> e;
    /// Velocity bias: acceleration of the current body's handle 2 due to velocities alone.
    BodyAcceleration<Real> velocity_bias;
};
/// The end of a run, about the last body's inboard joint and in that joint's axes. `factor` is the
/// factorized inertia I (factorize()). Rows are force, then torque; the torque about the revolute
/// axis is last. Light bodies on heavy ones have little more than their own inertia about that
/// axis. Nothing inboard is added to that row, so it loses no digits.
template <class Real>
struct RunsEnd {
    Symmetric<Real, 6> factor;
    Matrix<Real, 6, 5> first;
    Vector<Real, 6> bias;
};

/// Adds the contribution of one released revolute joint to the run's response at its first joint:
/// row j of z, up to its diagonal, and element j of e.
template <class Real>
CATENA_HD void gain_row(ReleasedRevolute<Real> const& h, Real const& first, int j, Real (&row)[5],
                        Real& e) {
    Real const share = h.inverse * first;
    CATENA_UNROLL
    for (int i = 0; i < 5; ++i)
        if (i <= j) row[i] = fused(h.first[i], share, row[i]);
    e = less_product(share, h.bias, e);
}

/// Subtracts from `bias` the wrench that accelerates the articulated inertia `all` by the joint's
/// velocity-dependent relative acceleration `d`. The joint's direction has been released from
/// `all`.
template <class Real>
CATENA_HD void add_velocity_bias(Wrench<Real>& bias, SpatialInertia<Real> const& all,
                                 BodyAcceleration<Real> const& d) {
    bias.torque = bias.torque - (all.turning * d.alpha + all.coupling * d.a);
    bias.force = bias.force - (transposed_times(all.coupling, d.alpha) + all.moving * d.a);
}
/// Subtracts the contribution of the same relative acceleration from element j of e; `first`
/// belongs to that row.
template <class Real>
CATENA_HD void add_velocity_bias(Real& e, Wrench<Real> const& first,
                                 BodyAcceleration<Real> const& d) {
    e = e - (dot(first.torque, d.alpha) + dot(first.force, d.a));
}
/// Updates the velocity bias from handle 2 of the body before to handle 2 of this
/// body. `Body` has the members `difference` and `across`, as LoadedBodyInRun.
template <class Real, class Body>
CATENA_HD void swing_on(BodyAcceleration<Real>& velocity_bias, Body const& body) {
    velocity_bias.alpha = velocity_bias.alpha + body.difference.alpha;
    velocity_bias.a =
        (velocity_bias.a + body.difference.a) + cross(velocity_bias.alpha, body.across);
}
/// Returns the loads on a body minus the inertial wrench of its velocity bias, about
/// its centre of mass.
template <class Real>
CATENA_HD Wrench<Real> load_of(LoadedBodyInRun<Real> const& body,
                               BodyAcceleration<Real> const& velocity_bias) {
    return {body.torque - body.inertia * velocity_bias.alpha,
            plus_scaled(body.force, -body.mass,
                        velocity_bias.a + cross(velocity_bias.alpha, body.centre))};
}
/// Passes the revolute joint about `axis`, which transmits `torque` about it: releases that
/// direction in I, bias and first, and updates z and e.
template <class Real, class Torque>
CATENA_HD ReleasedRevolute<Real> pass_revolute(FloatingRun<Real>& run, Vector<Real, 3> const& axis,
                                               Torque const& torque) {
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
/// Adds the joint's velocity-dependent relative acceleration `d` to the bias and to all elements of
/// e.
template <class Real>
CATENA_HD void add_velocity_bias(FloatingRun<Real>& run, BodyAcceleration<Real> const& d) {
    add_velocity_bias(run.bias, run.inertia, d);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) add_velocity_bias(run.e[j], run.first[j], d);
}
/// Returns direction j of handle 1 of a single body as a wrench about its handle 2, in body axes.
template <class Real>
CATENA_HD Wrench<Real> first_of(ArticulatedBody<Real> const& body, int j) {
    Matrix<Real, 3, 5> const torque = body.handle1().torque;
    Wrench<Real> first{torque.column(j), j < 3 ? body.e1.column(j) : Vector<Real, 3>::zero()};
    move_point(first, body.r2);
    return first;
}
/// Returns element j of e of a single body: its joint's velocity term and the centripetal
/// acceleration of handle 1.
template <class Real>
CATENA_HD Real row_of_first(ArticulatedBody<Real> const& body, int j) {
    return j < 3 ? body.bias[j] + dot(body.e1.column(j), body.inward1) : body.bias[j];
}
/// Returns the spatial inertia of a single body about its handle 2, in body axes.
template <class Real>
CATENA_HD SpatialInertia<Real> inertia_of(ArticulatedBody<Real> const& body) {
    SpatialInertia<Real> all{Symmetric<Real, 3>::zero(), Symmetric<Real, 3>::zero(),
                             Matrix<Real, 3, 3>::zero()};
    add_body(all, added_body(body.mass, body.inertia, -body.r2));
    return all;
}
/// Returns the bias wrench of a single body about its handle 2, in body axes: the negative loads.
template <class Real>
CATENA_HD Wrench<Real> bias_of(ArticulatedBody<Real> const& body) {
    Wrench<Real> bias{Vector<Real, 3>::zero(), Vector<Real, 3>::zero()};
    add_load(bias, about_point({body.torque, body.force}, -body.r2));
    return bias;
}
/// Starts a run with its first body.
template <class Real>
CATENA_HD FloatingRun<Real> begin_run(ArticulatedBody<Real> const& body) {
    auto const none = Vector<Real, 3>::zero();
    FloatingRun<Real> run{inertia_of(body), bias_of(body), {}, Symmetric<Real, 5>::zero(), {},
                          {none, none}};
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) {
        run.first[j] = first_of(body, j);
        run.e[j] = row_of_first(body, j);
    }
    return run;
}
/// Returns handle 2 of a run's last body about its inboard joint and in that joint's axes, as
/// RunsEnd needs it.
template <class Real>
CATENA_HD Handle<Real, 5> handle2_of_end(RevoluteFrame<Real> const& last) {
    Matrix<Real, 3, 3> const axes = transposed_times(last.e1, last.e2);
    return make_handle<5>(transposed_times(last.e1, last.r2 - last.r1), axes, axes);
}
/// Returns `body` in the run's axes. `rotation` is the rotation matrix from the body's axes to the
/// run's. `inward` is omega x (omega x r) at handle 2 of the body before, in the run's axes.
template <class Real>
CATENA_HD LoadedBodyInRun<Real> in_run(ArticulatedBody<Real> const& body,
                                       Matrix<Real, 3, 3> const& rotation,
                                       Vector<Real, 3> const& inward) {
    using Vector3 = Vector<Real, 3>;
    Vector3 const angular = body.bias[3] * body.e1.column(0) + body.bias[4] * body.e1.column(1);
    Vector3 const linear =
        body.inward1 + body.e1 * Vector3{{body.bias[0], body.bias[1], body.bias[2]}};
    return {{rotation * body.e1.column(2), rotation * (body.r2 - body.r1)},
            {-(rotation * angular), inward - rotation * linear},
            -(rotation * body.r2),
            body.mass,
            turned(rotation, body.inertia),
            rotation * body.torque,
            rotation * body.force};
}
/// Extends the run by a body that is not its last. Returns the released inboard joint for the
/// outward pass.
template <class Real, class Torque>
CATENA_HD ReleasedRevolute<Real> go_on(FloatingRun<Real>& run, LoadedBodyInRun<Real> const& body,
                                       Torque const& torque) {
    ReleasedRevolute<Real> const revolute = pass_revolute(run, body.axis, torque);
    swing_on(run.velocity_bias, body);
    move_point(run.inertia, body.across);
    move_point(run.bias, body.across);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) move_point(run.first[j], body.across);
    add_body(run.inertia, added_body(body.mass, body.inertia, body.centre));
    add_load(run.bias, about_point(load_of(body, run.velocity_bias), body.centre));
    return revolute;
}
/// The outboard handle of the last body but one, in the run's axes.
template <class Real>
struct OutboardHandle {
    // Axes of the handle, in columns.
    Matrix<Real, 3, 3> axes;
    // Centripetal acceleration omega x (omega x r) of the handle.
    Vector<Real, 3> inward;
};
/// Returns the velocity-dependent relative acceleration of the run's last revolute joint, in that
/// joint's axes. `inward` is the centripetal acceleration of the handle inboard of it, in the same
/// axes.
template <class Real>
CATENA_HD BodyAcceleration<Real> last_difference(RevoluteFrame<Real> const& last,
                                                 Vector<Real, 3> const& inward) {
    using Vector3 = Vector<Real, 3>;
    return {Vector3{{-last.bias[3], -last.bias[4], Real(0)}},
            inward - (transposed_times(last.e1, last.inward1) +
                      Vector3{{last.bias[0], last.bias[1], last.bias[2]}})};
}
/// Axis of the run's last revolute joint in that joint's own axes.
template <class Real>
CATENA_HD Vector<Real, 3> last_axis() {
    return {{Real(0), Real(0), Real(1)}};
}

/// The last body about its inboard joint and in that joint's axes.
template <class Real>
struct LastBody {
    // Centre of mass, from the joint.
    Vector<Real, 3> centre;
    Real mass;
    Symmetric<Real, 3> inertia;
    // External and gyroscopic loads about the joint.
    Wrench<Real> load;
};
/// Returns the last body about its inboard joint.
template <class Real>
CATENA_HD LastBody<Real> last_body(ArticulatedBody<Real> const& last) {
    Matrix<Real, 3, 3> const to_joint = transpose(last.e1);
    Vector<Real, 3> const centre = -(to_joint * last.r1);
    return {centre, last.mass, turned(to_joint, last.inertia),
            about_point({to_joint * last.torque, to_joint * last.force}, centre)};
}
/// Sets to zero what rounding has left of the inboard inertia about the last revolute joint, which
/// is already released.
template <class Real>
CATENA_HD void leave_revolute(SpatialInertia<Real>& all) {
    CATENA_UNROLL
    for (int j = 0; j < 3; ++j) all.turning(2, j) = all.coupling(2, j) = Real(0);
}
/// Returns a wrench in the row order of RunsEnd: force, then torque.
template <class Real>
CATENA_HD Vector<Real, 6> six_of(Vector<Real, 3> const& force, Vector<Real, 3> const& torque) {
    return {{force[0], force[1], force[2], torque[0], torque[1], torque[2]}};
}
/// Returns I of RunsEnd, the sum of the inboard inertia and that of the last body.
template <class Real>
CATENA_HD Symmetric<Real, 6> inertia_of_end(SpatialInertia<Real> const& inboard,
                                            LastBody<Real> const& last) {
    Real const square = dot(last.centre, last.centre);
    Symmetric<Real, 6> all;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        auto unit = Vector<Real, 3>::zero();
        unit[i] = last.mass;
        // Column i of the last body's coupling.
        Vector<Real, 3> const arm = cross(last.centre, unit);
        CATENA_UNROLL
        for (int j = 0; j < 3; ++j) {
            all(3 + j, i) = inboard.coupling(j, i) + arm[j];
            if (j > i) continue;
            all(i, j) = i == j ? inboard.moving(i, j) + last.mass : inboard.moving(i, j);
            Real const apart =
                less_product(last.centre[i], last.centre[j], i == j ? square : Real(0));
            all(3 + i, 3 + j) = inboard.turning(i, j) + fused(last.mass, apart, last.inertia(i, j));
        }
    }
    return all;
}
/// Returns `bias` of RunsEnd, the sum of the inboard bias and that of the last body.
template <class Real>
CATENA_HD Vector<Real, 6> bias_of_end(Wrench<Real> const& inboard, LastBody<Real> const& last) {
    return six_of(inboard.force - last.load.force, inboard.torque - last.load.torque);
}
/// Extends the run by `last`, its last body. Sets `revolute` to the released last joint, in the
/// joint's axes, for the outward pass. `torque` acts about that joint.
template <class Real, class Torque>
CATENA_HD RunsEnd<Real> end_run(FloatingRun<Real>& run, OutboardHandle<Real> const& before,
                                ArticulatedBody<Real> const& last, ReleasedRevolute<Real>& revolute,
                                Torque const& torque) {
    add_velocity_bias(run, run.velocity_bias);
    Matrix<Real, 3, 3> const rotation = transpose(before.axes);
    rotate_axes(run.inertia, rotation);
    rotate_axes(run.bias, rotation);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) rotate_axes(run.first[j], rotation);
    revolute = pass_revolute(run, last_axis<Real>(), torque);
    leave_revolute(run.inertia);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j) run.first[j].torque[2] = Real(0);
    run.bias.torque[2] = left_along_revolute<Real>(torque);
    add_velocity_bias(run, last_difference(last, rotation * before.inward));

    LastBody<Real> const body = last_body(last);
    RunsEnd<Real> end;
    end.factor = factorize(inertia_of_end(run.inertia, body), 6);
    CATENA_UNROLL
    for (int j = 0; j < 5; ++j)
        end.first.set_column(j, six_of(run.first[j].force, run.first[j].torque));
    end.bias = bias_of_end(run.bias, body);
    return end;
}
/// Returns a^T S^-1 b; S^-1 is the diagonal of `factor`.
template <class Real>
CATENA_HD Real product(Symmetric<Real, 6> const& factor, Vector<Real, 6> const& a,
                       Vector<Real, 6> const& b) {
    Real sum = (factor(0, 0) * a[0]) * b[0];
    CATENA_UNROLL
    for (int i = 1; i < 6; ++i) sum = fused(factor(i, i) * a[i], b[i], sum);
    return sum;
}
/// Returns column j of handle 2 of a run's last body in the row order of RunsEnd.
template <class Real>
CATENA_HD Vector<Real, 6> second_of(Handle<Real, 5> const& handle2_of_end, int j) {
    Vector<Real, 3> const force =
        j < 3 ? handle2_of_end.force.column(j < 3 ? j : 0) : Vector<Real, 3>::zero();
    return six_of(force, handle2_of_end.torque.column(j));
}
/// Returns the centripetal acceleration of the last body's handle 2 along that handle's directions.
template <class Real>
CATENA_HD Vector<Real, 5> bias_beyond(Handle<Real, 5> const& handle2_of_end,
                                      RevoluteFrame<Real> const& last) {
    return along(handle2_of_end, Vector<Real, 3>::zero(), transposed_times(last.e1, last.inward2));
}
/// Returns the run as a segment that the tree merges with others.
template <class Real>
CATENA_HD BiasedSegment<Real, 5> segment_of(FloatingRun<Real> const& run, RunsEnd<Real> const& end,
                                            RevoluteFrame<Real> const& last) {
    Handle<Real, 5> const h = handle2_of_end(last);
    // Columns of L^-1 applied to the directions of handle 1 and handle 2.
    Matrix<Real, 6, 5> first, second;
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
            s.matrix.z11(i, j) =
                run.z(i, j) + product(end.factor, first.column(i), first.column(j));
            s.matrix.z22(i, j) = product(end.factor, second.column(i), second.column(j));
        }
        s.bias.b1[i] = s.bias.b1[i] - product(end.factor, first.column(i), bias);
        s.bias.b2[i] = s.bias.b2[i] - product(end.factor, second.column(i), bias);
    }
    return s;
}

/// Returns the acceleration of the last body at its inboard joint, in the joint's axes. `first` is
/// the force at the run's first joint, `next` that at the joint after the run.
template <class Real>
CATENA_HD BodyAcceleration<Real> last_acceleration(RunsEnd<Real> const& end,
                                                   RevoluteFrame<Real> const& last,
                                                   Vector<Real, 5> const& first,
                                                   Vector<Real, 5> const& next) {
    Handle<Real, 5> const h = handle2_of_end(last);
    Vector<Real, 6> const wrench =
        end.first * first - (six_of(push(h, next), moment(h, next)) + end.bias);
    Vector<Real, 6> const y = solve_upper(end.factor, solve_lower(end.factor, wrench));
    return {{{y[3], y[4], y[5]}}, {{y[0], y[1], y[2]}}};
}
/// Sum of two accelerations of the same point in the same axes.
template <class Real>
CATENA_HD BodyAcceleration<Real> operator+(BodyAcceleration<Real> const& a,
                                           BodyAcceleration<Real> const& b) {
    return {a.alpha + b.alpha, a.a + b.a};
}
/// Difference of two accelerations of the same point in the same axes.
template <class Real>
CATENA_HD BodyAcceleration<Real> operator-(BodyAcceleration<Real> const& a,
                                           BodyAcceleration<Real> const& b) {
    return {a.alpha - b.alpha, a.a - b.a};
}
/// A released revolute joint in the outward pass, when the force at the run's first joint is known.
/// `along` is the resulting bias about the joint.
template <class Real>
struct PushedRevolute {
    Vector<Real, 3> turning, moving;
    Real inverse, along;
};
/// Applies the force at the run's first joint to a released joint.
template <class Real>
CATENA_HD PushedRevolute<Real> pushed(ReleasedRevolute<Real> const& revolute,
                                      Vector<Real, 5> const& first) {
    return {revolute.turning, revolute.moving, revolute.inverse,
            revolute.bias - dot(revolute.first, first)};
}
/// Returns the joint unchanged, because the force has been applied to it before.
template <class Real>
CATENA_HD PushedRevolute<Real> const& pushed(PushedRevolute<Real> const& revolute,
                                             Vector<Real, 5> const&) {
    return revolute;
}
/// Moves the acceleration `a` from the outboard side of a revolute joint to its inboard side, at
/// the meeting point. Velocity terms are not in `a`. Returns the joint acceleration: angular
/// acceleration of the outboard body relative to the inboard one, about `axis`.
template <class Real>
CATENA_HD Real pass_back(PushedRevolute<Real> const& revolute, Vector<Real, 3> const& axis,
                         BodyAcceleration<Real>& a) {
    Real const own = dot(revolute.turning, a.alpha) + (dot(revolute.moving, a.a) + revolute.along);
    Real const of_revolute = own * revolute.inverse;
    a.alpha = plus_scaled(a.alpha, -of_revolute, axis);
    return of_revolute;
}
/// Returns the acceleration of a body's centre of mass in its own axes, from that of its handle
/// `r`. `rotation` is the rotation matrix from the body's axes to those of `at_handle`.
template <class Real>
CATENA_HD BodyAcceleration<Real> own_acceleration(Matrix<Real, 3, 3> const& rotation,
                                                  Vector<Real, 3> const& r,
                                                  BodyAcceleration<Real> const& at_handle) {
    Vector<Real, 3> const alpha = transposed_times(rotation, at_handle.alpha);
    return {alpha, transposed_times(rotation, at_handle.a) - cross(alpha, r)};
}
/// Returns a body's angular acceleration about its inboard revolute joint.
template <class Real>
CATENA_HD Real about_inboard_revolute(RevoluteFrame<Real> const& body,
                                      BodyAcceleration<Real> const& a) {
    return transposed_times(body.e1, a.alpha)[2];
}
/// Returns a body's angular acceleration about its outboard revolute joint.
template <class Real>
CATENA_HD Real about_outboard_revolute(RevoluteFrame<Real> const& body,
                                       BodyAcceleration<Real> const& a) {
    return transposed_times(body.e2, a.alpha)[2];
}
/// Returns the velocity terms of a revolute joint along its five directions. `e1` holds the joint's
/// axes and `omega` is the outboard body's angular velocity, both in the outboard body's axes.
template <class Real>
CATENA_HD Vector<Real, 5> revolute_bias(Matrix<Real, 3, 3> const& e1, Vector<Real, 3> const& omega,
                                        Real const& rate) {
    Vector<Real, 3> const w = transposed_times(e1, omega);
    return {{Real(0), Real(0), Real(0), -(rate * w[1]), rate * w[0]}};
}
/// Returns the force at a body's inboard joint along its five directions, from its acceleration and
/// the force at its outboard joint.
template <class Real>
CATENA_HD Vector<Real, 5> inboard_force(ArticulatedBody<Real> const& body,
                                        BodyAcceleration<Real> const& a,
                                        Vector<Real, 5> const& outboard) {
    Handle<Real, 5> const h2 = body.handle2();
    Vector<Real, 3> const force = (body.mass * a.a - body.force) + push(h2, outboard);
    Vector<Real, 3> const torque =
        (body.inertia * a.alpha - body.torque) + moment(h2, outboard) - cross(body.r1, force);
    Vector<Real, 3> const along_force = transposed_times(body.e1, force),
                          along_torque = transposed_times(body.e1, torque);
    return {{along_force[0], along_force[1], along_force[2], along_torque[0], along_torque[1]}};
}

/// Default callback of climb_revolutes(): all runs of a vector begin at body 0.
struct BeginsOnce {
    template <class Real, class Bodies>
    CATENA_HD void operator()(int, FloatingRun<Real>&, Bodies&) const {}
};
/// Supplies the bodies of a run for the inward pass and transforms them to the run's axes. body(i)
/// is called with increasing i.
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
        state.rotation = state.rotation * b.rotation_to(state.axes2);
        LoadedBodyInRun<Real> const in_axes = in_run(b, state.rotation, state.inward);
        state.axes2 = b.e2;
        state.inward = state.rotation * b.inward2;
        return in_axes;
    }
    /// Returns the last body in its own axes.
    CATENA_HD_IN_PLACE ArticulatedBody<Real> last(int i) { return body_(i); }
    CATENA_HD OutboardHandle<Real> before_last() const {
        return {state.rotation * state.axes2, state.inward};
    }

    /// Rotation matrix from the current body to the run's axes, its outboard axes in the body's
    /// axes, and the centripetal acceleration of its handle 2 in the run's axes.
    struct State {
        Matrix<Real, 3, 3> rotation, axes2;
        Vector<Real, 3> inward;
    } state;

  private:
    Body const& body_;
};

/// Inward pass of a run of `count` >= 2 bodies; returns the run's segment.
///
/// `bodies` has the interface of BodiesOfRun. torque(i) is called for each body but the first; it
/// returns the torque about that body's inboard revolute joint, a Real or Undriven.
///
/// `kept` stores what the outward pass needs. For bodies between the first and the last it gets
/// put(i, ReleasedRevolute, BodyInRun, velocity_bias). For the last body it gets put(i,
/// ReleasedRevolute) and put(RunsEnd). put_axes() gets the axes of the last revolute joint, in the
/// run's axes.
///
/// begin(i, run, bodies) is called after each body i but the last.
template <class Real, class Bodies, class Torque, class Kept, class Begin = BeginsOnce>
CATENA_HD_IN_PLACE BiasedSegment<Real, 5> climb_revolutes(int count, Bodies&& bodies,
                                                          Torque const& torque, Kept&& kept,
                                                          Begin&& begin = {}) {
    FloatingRun<Real> run = begin_run(bodies.first());
    begin(0, run, bodies);
    CATENA_NO_UNROLL
    for (int i = 1; i < count - 1; ++i) {
        LoadedBodyInRun<Real> const body = bodies.next(i);
        ReleasedRevolute<Real> const revolute = go_on(run, body, torque(i));
        kept.put(i, revolute, body, run.velocity_bias);
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
/// Outward pass of a run from the forces at its first joint (`first`) and at the joint after it
/// (`next`).
///
/// `kept` supplies revolute(i), body(i), end() and axes(). It supplies velocity_bias(i) of the last
/// body but one, if that is not the first body, and with `all` of every body between.
///
/// frame(i) is called for the last two bodies and the first; with `all` for every body, from the
/// last to the first. accelerate(i, frame(i), BodyAcceleration) follows for each of these bodies
/// except the last but one, which gets it only with `all`.
///
/// at(i, acceleration) is called for every body but the last. The acceleration is that of handle 2
/// in the run's axes, relative to the body's velocity bias; at() may change it.
/// joint_acceleration(i, joint acceleration) is called for every revolute joint.
template <class Real, class Frame, class Kept, class Accelerate, class At, class JointAcceleration>
CATENA_HD_IN_PLACE void descend_revolutes(int count, bool all, Frame const& frame, Kept const& kept,
                                          Vector<Real, 5> const& first, Vector<Real, 5> const& next,
                                          Accelerate&& accelerate, At&& at,
                                          JointAcceleration&& joint_acceleration) {
    BodyAcceleration<Real> a;
    Matrix<Real, 3, 3> axes;  // Axes of the joint outboard of the next body, in the run's axes.
    {
        RevoluteFrame<Real> const last = frame(count - 1);
        a = last_acceleration(kept.end(), last, first, next);
        accelerate(count - 1, last, own_acceleration(transpose(last.e1), last.r1, a));
        RevoluteFrame<Real> const before = frame(count - 2);
        a = a - last_difference(last, transposed_times(before.e2, before.inward2));
        Real const of_revolute =
            pass_back(pushed(kept.revolute(count - 1), first), last_axis<Real>(), a);
        joint_acceleration(count - 1, of_revolute);
        axes = count > 2 ? kept.axes() : before.e2;
        a = {axes * a.alpha, axes * a.a};
        if (count > 2) a = a - kept.velocity_bias(count - 2);
    }
    CATENA_NO_UNROLL
    for (int i = count - 2; i > 0; --i) {
        at(i, a);
        if (all) {
            RevoluteFrame<Real> const body = frame(i);
            Matrix<Real, 3, 3> const to_run = axes * transpose(body.e2);
            accelerate(i, body, own_acceleration(to_run, body.r2, a + kept.velocity_bias(i)));
            axes = to_run * body.e1;
        }
        BodyInRun<Real> const body = kept.body(i);
        a.a = a.a - cross(a.alpha, body.across);
        joint_acceleration(i, pass_back(pushed(kept.revolute(i), first), body.axis, a));
    }
    at(0, a);
    RevoluteFrame<Real> const begins = frame(0);
    accelerate(0, begins, BodyAcceleration<Real>{a.alpha, a.a - cross(a.alpha, begins.r2)});
}

}  // namespace catena::dca
