// Spatial inertias and wrenches of articulated bodies in runs on revolute joints
// (floating_run.hpp): shift to another point, transformation to other axes, and release of a
// revolute joint. Host and device; Real = double, a wider type, or a SIMD vector of several runs
// side by side.
#pragma once

#include "dca/leaf.hpp"

namespace catena::dca {

/// Spatial inertia I = {{turning, coupling}, {coupling^T, moving}} about some point: {torque,
/// force} = I {alpha, a}. Of a single body, `moving` is its mass times the identity.
template <class Real>
struct SpatialInertia {
    Symmetric<Real, 3> turning, moving;
    Matrix<Real, 3, 3> coupling;
};
/// Torque about some point and force through it.
template <class Real>
struct Wrench {
    Vector<Real, 3> torque, force;
};
/// A released revolute joint. `turning` and `moving` are I times its axis before the release;
/// `inverse` is 1 / (axis^T I axis). `bias` and `first` are the components of these wrenches along
/// the joint.
///
/// The values are about the meeting point, in the axes of the run. Those of the run's last revolute
/// joint are in that joint's axes.
template <class Real>
struct ReleasedRevolute {
    Vector<Real, 3> turning, moving;
    Real inverse, bias;
    Vector<Real, 5> first;
};
/// Shifts the reference point by `r`.
template <class Real>
CATENA_HD void move_point(SpatialInertia<Real>& all, Vector<Real, 3> const& r) {
    Matrix<Real, 3, 3> moved;
    CATENA_UNROLL
    for (int j = 0; j < 3; ++j)
        moved.set_column(
            j,
            all.coupling.column(j) -
                cross(r, Vector<Real, 3>{{all.moving(0, j), all.moving(1, j), all.moving(2, j)}}));
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
/// Shifts the reference point of a wrench by `r`.
template <class Real>
CATENA_HD void move_point(Wrench<Real>& w, Vector<Real, 3> const& r) {
    w.torque = w.torque - cross(r, w.force);
}
/// A body to be added, whose centre of mass is at `centre` from the reference point of I.
template <class Real>
struct AddedBody {
    Real mass;
    Vector<Real, 3> centre, moment;  // `moment` is m c.
    /// Inertia about the centre of mass + (m c . c) 1. Minus m c c^T, it is the rotational inertia
    /// about the reference point.
    Symmetric<Real, 3> turning;
};
/// Returns a body to be added; `inertia` is about its centre of mass.
template <class Real>
CATENA_HD AddedBody<Real> added_body(Real const& mass, Symmetric<Real, 3> const& inertia,
                                     Vector<Real, 3> const& centre) {
    AddedBody<Real> body{mass, centre, mass * centre, inertia};
    Real const square = dot(body.moment, centre);
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) body.turning(i, i) = inertia(i, i) + square;
    return body;
}
/// Adds a rigidly attached body.
template <class Real>
CATENA_HD void add_body(SpatialInertia<Real>& all, AddedBody<Real> const& body) {
    Vector<Real, 3> const& moment = body.moment;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        CATENA_UNROLL
        for (int j = 0; j <= i; ++j)
            all.turning(i, j) =
                less_product(moment[i], body.centre[j], all.turning(i, j) + body.turning(i, j));
        all.moving(i, i) = all.moving(i, i) + body.mass;
    }
    all.coupling(1, 0) = all.coupling(1, 0) + moment[2];
    all.coupling(2, 0) = all.coupling(2, 0) - moment[1];
    all.coupling(0, 1) = all.coupling(0, 1) - moment[2];
    all.coupling(2, 1) = all.coupling(2, 1) + moment[0];
    all.coupling(0, 2) = all.coupling(0, 2) + moment[1];
    all.coupling(1, 2) = all.coupling(1, 2) - moment[0];
}
/// Returns a wrench at a centre of mass as a wrench about the point from which that centre is at
/// `centre`.
template <class Real>
CATENA_HD Wrench<Real> about_point(Wrench<Real> const& w, Vector<Real, 3> const& centre) {
    return {w.torque + cross(centre, w.force), w.force};
}
/// Subtracts the external load on a body from the bias.
template <class Real>
CATENA_HD void add_load(Wrench<Real>& bias, Wrench<Real> const& load) {
    bias = {bias.torque - load.torque, bias.force - load.force};
}
/// Returns q s q^T.
template <class Real>
CATENA_HD Symmetric<Real, 3> turned(Matrix<Real, 3, 3> const& q, Symmetric<Real, 3> const& s) {
    Matrix<Real, 3, 3> const half = q * full(s);
    Symmetric<Real, 3> t;
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        CATENA_UNROLL
        for (int j = 0; j <= i; ++j)
            t(i, j) = fused(half(i, 2), q(j, 2), fused(half(i, 1), q(j, 1), half(i, 0) * q(j, 0)));
    }
    return t;
}
/// Transforms an inertia to other axes by the rotation matrix q.
template <class Real>
CATENA_HD void rotate_axes(SpatialInertia<Real>& all, Matrix<Real, 3, 3> const& q) {
    all.turning = turned(q, all.turning);
    all.moving = turned(q, all.moving);
    all.coupling = q * all.coupling * transpose(q);
}
/// Transforms a wrench to other axes by the rotation matrix q.
template <class Real>
CATENA_HD void rotate_axes(Wrench<Real>& w, Matrix<Real, 3, 3> const& q) {
    w = {q * w.torque, q * w.force};
}
/// Effect of a released revolute joint, per unit of a wrench's component along it: `turning` and
/// `moving` are subtracted from the wrench.
template <class Real>
struct Release {
    Vector<Real, 3> axis, turning, moving;
};
/// Releases the joint about `axis` through the reference point of I: no torque acts about it from
/// here on. Sets all of `h` but `bias` and `first`, which belong to the wrenches.
template <class Real>
CATENA_HD Release<Real> release_revolute(SpatialInertia<Real>& all, Vector<Real, 3> const& axis,
                                         ReleasedRevolute<Real>& h) {
    h.turning = all.turning * axis;
    h.moving = transposed_times(all.coupling, axis);
    h.inverse = Real(1) / dot(axis, h.turning);
    Release<Real> const r{axis, h.inverse * h.turning, h.inverse * h.moving};
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) {
        CATENA_UNROLL
        for (int j = 0; j < 3; ++j) {
            if (j <= i)
                all.turning(i, j) = less_product(h.turning[i], r.turning[j], all.turning(i, j));
            if (j <= i) all.moving(i, j) = less_product(h.moving[i], r.moving[j], all.moving(i, j));
            all.coupling(i, j) = less_product(h.turning[i], r.moving[j], all.coupling(i, j));
        }
    }
    return r;
}
/// Subtracts the effect of `along`, a wrench's component along the released joint.
template <class Real>
CATENA_HD void take_away(Wrench<Real>& w, Release<Real> const& r, Real const& along) {
    w = {plus_scaled(w.torque, -along, r.turning), plus_scaled(w.force, -along, r.moving)};
}
/// Releases the joint in a wrench. Returns the wrench's component along the joint.
template <class Real>
CATENA_HD Real release_revolute(Wrench<Real>& w, Release<Real> const& r) {
    Real const along = dot(r.axis, w.torque);
    take_away(w, r, along);
    return along;
}
/// Tag for a revolute joint that transmits no torque about its axis. Otherwise a Real stands for
/// that torque on the outboard body, which no body's loads then contain.
struct Undriven {};
/// Releases a joint without torque in `bias`. Returns the component along the joint.
template <class Real>
CATENA_HD Real release_driven(Wrench<Real>& bias, Release<Real> const& r, Undriven) {
    return release_revolute(bias, r);
}
/// Releases a joint that transmits `torque` in `bias`. Returns the component along the joint,
/// `torque` included.
template <class Real>
CATENA_HD Real release_driven(Wrench<Real>& bias, Release<Real> const& r, Real const& torque) {
    Real const along = dot(r.axis, bias.torque) + torque;
    take_away(bias, r, along);
    return along;
}
/// Component of the released bias along a joint without torque.
template <class Real>
CATENA_HD Real left_along_revolute(Undriven) {
    return Real(0);
}
/// Component of the released bias along a joint that transmits `torque`.
template <class Real>
CATENA_HD Real left_along_revolute(Real const& torque) {
    return -torque;
}

}  // namespace catena::dca
