// A run of bodies on hinges seen from its two handles (dca/segment.hpp) by way of inertias: an oracle that shares nothing with joining
// bodies by their mobilities. Real = double, wider, or several side by side.
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
#include "dca/segment.hpp"

namespace catena::dca::test {

/// What a run needs of a body, in its axes: handles' axes in the columns of e1 and e2 (the hinge is the last one of e1), what acts on it
/// with the gyroscopic torque, and velocity terms: omega x (omega x r) at its two handles, and of its inboard joint along its directions.
template <class Real>
struct HingedBody {
    Real mass;
    Symmetric<Real, 3> inertia;
    Vector<Real, 3> r1, r2;
    Matrix<Real, 3, 3> e1, e2;
    Vector<Real, 3> torque, force, inward1, inward2;
    Vector<Real, 5> bias;

    Handle<Real, 5> handle1() const { return make_handle<5>(r1, e1, e1); }
    Handle<Real, 5> handle2() const { return make_handle<5>(r2, e2, e2); }
    /// Of this body's axes against those of the one before.
    Matrix<Real, 3, 3> turn_from(HingedBody const& before) const { return e1 * transpose(before.e2); }
};

template <class Real>
struct InertiaRun {
    Symmetric<Real, 3> turning, moving;  // I = {{turning, coupling}, {coupling^T, moving}}
    Matrix<Real, 3, 3> coupling;
    Vector<Real, 3> torque, force;       // bias
    Matrix<Real, 3, 5> torques, forces;  // first
    Symmetric<Real, 5> z;
    Vector<Real, 5> e;
};
/// A hinge when it was released: I along it, its own share's inverse, and the parts that biases and first have in it. At the meeting point,
/// in the outboard body's axes.
template <class Real>
struct ReleasedHinge {
    Vector<Real, 3> turning, moving;
    Real inverse, bias;
    Vector<Real, 5> first;
};
/// The end of a run, in the axes of its last joint and about its meeting point, I = L S L^T: `factor` as factorize(), the others L^-1 of
/// `first`, of the directions of handle 2, and of the bias. Rows force, then torque, that about the hinge last: light bodies on heavy ones
/// have little more than their own inertia there, which then is added to nothing.
template <class Real>
struct RunsEnd {
    Symmetric<Real, 6> factor;
    Matrix<Real, 6, 5> first, second;
    Vector<Real, 6> bias;
};
template <class Real>
struct BodyAcceleration {
    Vector<Real, 3> alpha, a;  // of the centre of mass
};

/// I about the point r away.
template <class Real>
void move_point(InertiaRun<Real>& run, Vector<Real, 3> const& r) {
    Matrix<Real, 3, 3> moved;
    for (int j = 0; j < 3; ++j)
        moved.set_column(j, run.coupling.column(j) - cross(r, Vector<Real, 3>{{run.moving(0, j), run.moving(1, j), run.moving(2, j)}}));
    for (int i = 0; i < 3; ++i) {
        Vector<Real, 3> const before{{run.coupling(i, 0), run.coupling(i, 1), run.coupling(i, 2)}};
        Vector<Real, 3> const after{{moved(i, 0), moved(i, 1), moved(i, 2)}};
        Vector<Real, 3> const along = cross(before, r), across = cross(after, r);
        for (int j = 0; j <= i; ++j) run.turning(i, j) = run.turning(i, j) + along[j];
        for (int j = i; j < 3; ++j) run.turning(j, i) = run.turning(j, i) + across[j];
    }
    run.coupling = moved;
    run.torque = run.torque - cross(r, run.force);
    for (int j = 0; j < 5; ++j) run.torques.set_column(j, run.torques.column(j) - cross(r, run.forces.column(j)));
}
/// q s q^T
template <class Real>
Symmetric<Real, 3> turned(Matrix<Real, 3, 3> const& q, Symmetric<Real, 3> const& s) {
    Matrix<Real, 3, 3> const half = q * full(s);
    Symmetric<Real, 3> t;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) t(i, j) = fused(half(i, 2), q(j, 2), fused(half(i, 1), q(j, 1), half(i, 0) * q(j, 0)));
    return t;
}
template <class Real>
void turn_axes(InertiaRun<Real>& run, Matrix<Real, 3, 3> const& q) {
    run.turning = turned(q, run.turning);
    run.moving = turned(q, run.moving);
    run.coupling = q * run.coupling * transpose(q);
    run.torque = q * run.torque;
    run.force = q * run.force;
    run.torques = q * run.torques;
    run.forces = q * run.forces;
}
/// No torque acts about `axis`, through the point that I is about, from here on.
template <class Real>
ReleasedHinge<Real> release_hinge(InertiaRun<Real>& run, Vector<Real, 3> const& axis) {
    ReleasedHinge<Real> h;
    h.turning = run.turning * axis;
    h.moving = transposed_times(run.coupling, axis);
    h.inverse = Real(1) / dot(axis, h.turning);
    h.bias = dot(axis, run.torque);
    h.first = transposed_times(run.torques, axis);
    Vector<Real, 3> const turning = h.inverse * h.turning, moving = h.inverse * h.moving;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            if (j <= i) run.turning(i, j) = less_product(h.turning[i], turning[j], run.turning(i, j));
            if (j <= i) run.moving(i, j) = less_product(h.moving[i], moving[j], run.moving(i, j));
            run.coupling(i, j) = less_product(h.turning[i], moving[j], run.coupling(i, j));
        }
    }
    run.torque = plus_scaled(run.torque, -h.bias, turning);
    run.force = plus_scaled(run.force, -h.bias, moving);
    for (int j = 0; j < 5; ++j) {
        Real const share = h.inverse * h.first[j];
        for (int i = 0; i <= j; ++i) run.z(j, i) = fused(h.first[i], share, run.z(j, i));
        run.e[j] = less_product(share, h.bias, run.e[j]);
        run.torques.set_column(j, plus_scaled(run.torques.column(j), -h.first[j], turning));
        run.forces.set_column(j, plus_scaled(run.forces.column(j), -h.first[j], moving));
    }
    return h;
}
/// A body more at the point that I is about.
template <class Real>
void add_body(InertiaRun<Real>& run, HingedBody<Real> const& body) {
    run.turning = run.turning + body.inertia;
    for (int i = 0; i < 3; ++i) run.moving(i, i) = run.moving(i, i) + body.mass;
    run.torque = run.torque - body.torque;
    run.force = run.force - body.force;
}
/// Of one body.
template <class Real>
InertiaRun<Real> begin_run(HingedBody<Real> const& body) {
    using Vector3 = Vector<Real, 3>;
    InertiaRun<Real> run{
        Symmetric<Real, 3>::zero(), Symmetric<Real, 3>::zero(), Matrix<Real, 3, 3>::zero(), Vector3::zero(), Vector3::zero(),
        body.handle1().torque,      Matrix<Real, 3, 5>::zero(), Symmetric<Real, 5>::zero(), body.bias};
    for (int j = 0; j < 3; ++j) {
        run.forces.set_column(j, body.e1.column(j));
        run.e[j] = run.e[j] + dot(body.e1.column(j), body.inward1);
    }
    add_body(run, body);
    return run;
}
/// Accelerations after a joint are those before it and these.
template <class Real>
void differ(InertiaRun<Real>& run, Vector<Real, 3> const& angular, Vector<Real, 3> const& linear) {
    run.torque = run.torque - (run.turning * angular + run.coupling * linear);
    run.force = run.force - (transposed_times(run.coupling, angular) + run.moving * linear);
    run.e = run.e - (transposed_times(run.torques, angular) + transposed_times(run.forces, linear));
}
/// Handle 2 of a run's last body as RunsEnd has it.
template <class Real>
Handle<Real, 5> handle2_of_end(HingedBody<Real> const& last) {
    Matrix<Real, 3, 3> const axes = transposed_times(last.e1, last.e2);
    return make_handle<5>(transposed_times(last.e1, last.r2 - last.r1), axes, axes);
}
/// Goes on to `body`, the one after `before` and not the last of the run; what it returns is for the way back.
template <class Real>
ReleasedHinge<Real> go_on(InertiaRun<Real>& run, HingedBody<Real> const& before, HingedBody<Real> const& body) {
    Matrix<Real, 3, 3> const turn = body.turn_from(before);
    move_point(run, before.r2);
    turn_axes(run, turn);
    ReleasedHinge<Real> const hinge = release_hinge(run, body.e1.column(2));
    // What the accelerations on the joint's two sides differ by, the hinge's own apart.
    Vector<Real, 3> const angular = -(body.bias[3] * body.e1.column(0) + body.bias[4] * body.e1.column(1));
    Vector<Real, 3> const linear =
        turn * before.inward2 - body.inward1 - body.e1 * Vector<Real, 3>{{body.bias[0], body.bias[1], body.bias[2]}};
    differ(run, angular, linear);
    move_point(run, -body.r1);
    add_body(run, body);
    return hinge;
}

template <class Real>
Vector<Real, 6> six_of(Vector<Real, 3> const& force, Vector<Real, 3> const& torque) {
    return {{force[0], force[1], force[2], torque[0], torque[1], torque[2]}};
}
/// Goes on to `last`, the last body, in the joint's axes; `hinge` as go_on(), in these axes too.
template <class Real>
RunsEnd<Real> end_run(InertiaRun<Real>& run, HingedBody<Real> const& before, HingedBody<Real> const& last, ReleasedHinge<Real>& hinge) {
    using Vector3 = Vector<Real, 3>;
    move_point(run, before.r2);
    turn_axes(run, transpose(before.e2));
    hinge = release_hinge(run, Vector3{{Real(0), Real(0), Real(1)}});
    for (int j = 0; j < 3; ++j) run.turning(2, j) = run.coupling(2, j) = Real(0);  // not what rounding left there
    for (int j = 0; j < 5; ++j) run.torques(2, j) = Real(0);
    run.torque[2] = Real(0);
    Matrix<Real, 3, 3> const to_joint = transpose(last.e1);
    Vector3 const angular{{-last.bias[3], -last.bias[4], Real(0)}};
    Vector3 const linear =
        transposed_times(before.e2, before.inward2) - (to_joint * last.inward1 + Vector3{{last.bias[0], last.bias[1], last.bias[2]}});
    differ(run, angular, linear);

    Vector3 const centre = -(to_joint * last.r1), force = to_joint * last.force;
    Symmetric<Real, 3> const inertia = turned(to_joint, last.inertia);
    Real const square = dot(centre, centre);
    Symmetric<Real, 6> all;
    for (int i = 0; i < 3; ++i) {
        Vector3 unit = Vector3::zero();
        unit[i] = last.mass;
        Vector3 const arm = cross(centre, unit);  // column i of the last body's coupling
        for (int j = 0; j < 3; ++j) {
            all(3 + j, i) = run.coupling(j, i) + arm[j];
            if (j > i) continue;
            all(i, j) = i == j ? run.moving(i, j) + last.mass : run.moving(i, j);
            Real const apart = less_product(centre[i], centre[j], i == j ? square : Real(0));
            all(3 + i, 3 + j) = run.turning(i, j) + fused(last.mass, apart, inertia(i, j));
        }
    }
    RunsEnd<Real> end;
    end.factor = factorize(all, 6);
    Handle<Real, 5> const h = handle2_of_end(last);
    for (int j = 0; j < 5; ++j) {
        Vector3 const along_force = j < 3 ? h.force.column(j) : Vector3::zero();
        end.first.set_column(j, solve_lower(end.factor, six_of(run.forces.column(j), run.torques.column(j))));
        end.second.set_column(j, solve_lower(end.factor, six_of(along_force, h.torque.column(j))));
    }
    end.bias = solve_lower(end.factor, six_of(run.force - force, run.torque - (to_joint * last.torque + cross(centre, force))));
    return end;
}
/// a^T S^-1 b of columns i and j.
template <class Real>
Real product(Symmetric<Real, 6> const& factor, Vector<Real, 6> const& a, Vector<Real, 6> const& b) {
    Real sum = (factor(0, 0) * a[0]) * b[0];
    for (int i = 1; i < 6; ++i) sum = fused(factor(i, i) * a[i], b[i], sum);
    return sum;
}
/// The run as the tree joins it to others.
template <class Real>
SegmentMatrix<Real, 5> segment_matrix(InertiaRun<Real> const& run, RunsEnd<Real> const& end) {
    SegmentMatrix<Real, 5> s;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j) {
            s.z12(i, j) = product(end.factor, end.first.column(i), end.second.column(j));
            if (j > i) continue;
            s.z11(i, j) = run.z(i, j) + product(end.factor, end.first.column(i), end.first.column(j));
            s.z22(i, j) = product(end.factor, end.second.column(i), end.second.column(j));
        }
    return s;
}
template <class Real>
SegmentBias<Real, 5> segment_bias(InertiaRun<Real> const& run, RunsEnd<Real> const& end, HingedBody<Real> const& last) {
    SegmentBias<Real, 5> b{run.e, along(handle2_of_end(last), Vector<Real, 3>::zero(), transposed_times(last.e1, last.inward2))};
    for (int i = 0; i < 5; ++i) {
        b.b1[i] = b.b1[i] - product(end.factor, end.first.column(i), end.bias);
        b.b2[i] = b.b2[i] - product(end.factor, end.second.column(i), end.bias);
    }
    return b;
}

/// Of the last body, from the forces at the run's first joint and at the one after it.
template <class Real>
BodyAcceleration<Real> last_acceleration(RunsEnd<Real> const& end, HingedBody<Real> const& last, Vector<Real, 5> const& first,
                                         Vector<Real, 5> const& next) {
    using Vector3 = Vector<Real, 3>;
    Vector<Real, 6> const y = solve_upper(end.factor, end.first * first - (end.second * next + end.bias));
    Vector3 const alpha = last.e1 * Vector3{{y[3], y[4], y[5]}};
    return {alpha, last.e1 * Vector3{{y[0], y[1], y[2]}} - cross(alpha, last.r1)};
}
/// Of `before`, from that of `body` and the force at the run's first joint. `at_end`: `body` is the last of the run.
template <bool at_end, class Real>
BodyAcceleration<Real> go_back(ReleasedHinge<Real> const& hinge, HingedBody<Real> const& before, HingedBody<Real> const& body,
                               BodyAcceleration<Real> const& of_body, Vector<Real, 5> const& first) {
    using Vector3 = Vector<Real, 3>;
    // Along the joint's axes: what the inboard side has, and the hinge's own.
    Vector3 turning = transposed_times(body.e1, of_body.alpha);
    Vector3 moving = transposed_times(body.e1, of_body.a + (cross(of_body.alpha, body.r1) + body.inward1));
    turning = turning + Vector3{{body.bias[3], body.bias[4], Real(0)}};
    moving = moving + Vector3{{body.bias[0], body.bias[1], body.bias[2]}};
    Vector3 const linear = moving - transposed_times(before.e2, before.inward2);
    Vector3 const turned = at_end ? turning : body.e1 * turning, moved = at_end ? linear : body.e1 * linear;
    Real const own = dot(hinge.turning, turned) + (dot(hinge.moving, moved) + (hinge.bias - dot(hinge.first, first)));
    turning[2] = less_product(own, hinge.inverse, turning[2]);
    BodyAcceleration<Real> a{before.e2 * turning, {}};
    a.a = before.e2 * linear - cross(a.alpha, before.r2);
    return a;
}

}  // namespace catena::dca::test
