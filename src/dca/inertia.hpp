// Inertias and wrenches of articulated bodies as runs on revolute joints (floating_run.hpp) go by
// them: about another point, in other axes, and past a revolute joint, which is released. Host and
// device; Real = double, wider, or several side by side.
#pragma once

#include "dca/leaf.hpp"

namespace catena::dca {

template <class Real>
struct SpatialInertia {
    Symmetric<Real, 3> turning, moving;  // I = {{turning, coupling}, {coupling^T, moving}}
    Matrix<Real, 3, 3> coupling;
};
template <class Real>
struct Wrench {
    Vector<Real, 3> torque, force;
};
/// A revolute joint when it was released: I along it, its own share's inverse, and the parts that
/// bias and first have in it. About the meeting point, in the axes of the run, but those of the
/// run's last revolute joint in its own.
template <class Real>
struct ReleasedRevolute {
    Vector<Real, 3> turning, moving;
    Real inverse, bias;
    Vector<Real, 5> first;
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
/// A body more, whose centre of mass is `centre` away from the point that I is about.
template <class Real>
struct AddedBody {
    Real mass;
    Vector<Real, 3> centre, moment;  // moment: m c
    Symmetric<Real, 3> turning;      // its inertia + (m c . c) 1: less m c c^T is what it turns with about that point
};
template <class Real>
CATENA_HD AddedBody<Real> added_body(Real const& mass, Symmetric<Real, 3> const& inertia, Vector<Real, 3> const& centre) {
    AddedBody<Real> body{mass, centre, mass * centre, inertia};
    Real const square = dot(body.moment, centre);
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) body.turning(i, i) = inertia(i, i) + square;
    return body;
}
template <class Real>
CATENA_HD void add_body(SpatialInertia<Real>& all, AddedBody<Real> const& body) {
    Vector<Real, 3> const& moment = body.moment;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        CATENA_UNROLL
        for (int j = 0; j <= i; ++j) all.turning(i, j) = less_product(moment[i], body.centre[j], all.turning(i, j) + body.turning(i, j));
        all.moving(i, i) = all.moving(i, i) + body.mass;
    }
    all.coupling(1, 0) = all.coupling(1, 0) + moment[2];
    all.coupling(2, 0) = all.coupling(2, 0) - moment[1];
    all.coupling(0, 1) = all.coupling(0, 1) - moment[2];
    all.coupling(2, 1) = all.coupling(2, 1) + moment[0];
    all.coupling(0, 2) = all.coupling(0, 2) + moment[1];
    all.coupling(1, 2) = all.coupling(1, 2) - moment[0];
}
/// A wrench at a centre of mass about the point that is `centre` away from it.
template <class Real>
CATENA_HD Wrench<Real> about_point(Wrench<Real> const& w, Vector<Real, 3> const& centre) {
    return {w.torque + cross(centre, w.force), w.force};
}
/// `load`: what acts on a body from outside.
template <class Real>
CATENA_HD void add_load(Wrench<Real>& bias, Wrench<Real> const& load) {
    bias = {bias.torque - load.torque, bias.force - load.force};
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
/// What a revolute joint that is released takes away, for a unit of what `along` it there is.
template <class Real>
struct Release {
    Vector<Real, 3> axis, turning, moving;
};
/// No torque acts about `axis`, through the point that I is about, from here on. Of ReleasedRevolute all but what the wrenches have.
template <class Real>
CATENA_HD Release<Real> release_revolute(SpatialInertia<Real>& all, Vector<Real, 3> const& axis, ReleasedRevolute<Real>& h) {
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
/// Returns what the wrench had along the revolute joint.
template <class Real>
CATENA_HD Real release_revolute(Wrench<Real>& w, Release<Real> const& r) {
    Real const along = dot(r.axis, w.torque);
    take_away(w, r, along);
    return along;
}
/// What a revolute joint does about its axis on the body outboard of it: nothing, or a torque, which then is in no body's own.
struct Undriven {};
template <class Real>
CATENA_HD Real release_driven(Wrench<Real>& bias, Release<Real> const& r, Undriven) {
    return release_revolute(bias, r);
}
template <class Real>
CATENA_HD Real release_driven(Wrench<Real>& bias, Release<Real> const& r, Real const& torque) {
    Real const along = dot(r.axis, bias.torque) + torque;
    take_away(bias, r, along);
    return along;
}
template <class Real>
CATENA_HD Real left_along_revolute(Undriven) {
    return Real(0);
}
template <class Real>
CATENA_HD Real left_along_revolute(Real const& torque) {
    return -torque;
}

}  // namespace catena::dca
