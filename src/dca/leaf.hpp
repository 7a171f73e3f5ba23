// One body as a segment between its two handles, host and device.
//
// Direction d at a handle is a unit wrench: `torque` about the centre of mass and `force`, per unit
// of the joint force along d. Then
//  zeta_ij(d, d') = torque_d . J^-1 torque_d' + force_d . force_d' / m,
// which is D_i^T zeta_ij D_j of the leaf for every kind of joint (src/dca/README.md, "Bodies";
// chapter, eqs 2.1-2.4, 2.6-2.7).
#pragma once

#include "dca/joint_directions.hpp"
#include "dca/segment.hpp"
#include "math/rotation.hpp"

namespace catena::dca {

/// Directions of one handle: K unit wrenches. Torques are in body axes, forces in the axes in which
/// the caller keeps forces. The first three directions (all if K < 3) have orthonormal forces, the
/// others have no force. With `any_forces`, every direction may have a force (screws).
template <class Real, int K, bool any_forces = false>
struct Handle {
    static constexpr int forces = any_forces || K < 3 ? K : 3;
    Matrix<Real, 3, K> torque;
    Matrix<Real, 3, forces> force;
};
/// Handle whose axes coincide with the force axes: directions 0-2 are forces along them, 3-5
/// torques about them.
template <class Real, int K>
struct GroundHandle {
    Matrix<Real, 3, K> torque;
    Vector<Real, 3> r;  // Handle from the centre of mass, body axes.
    /// Rotation matrix from the force axes to body axes.
    Matrix<Real, 3, 3> angular;
};

/// Returns the directions at a point `r` from the centre of mass (body axes): first the three
/// forces along the columns of `linear`, then torques about the columns of `angular`. Both hold the
/// same axes, `angular` in body axes and `linear` in the axes of the forces. The last column is the
/// joint's axis, the free direction of a revolute joint. K < 3: only the first K forces (a link's
/// direction; the plane of a planar chain).
template <int K, bool any_forces = false, class Real>
CATENA_HD Handle<Real, K, any_forces> make_handle(Vector<Real, 3> const& r,
                                                  Matrix<Real, 3, 3> const& angular,
                                                  Matrix<Real, 3, 3> const& linear) {
    static_assert(K >= 1 && K <= 6);
    Handle<Real, K, any_forces> h;
    CATENA_UNROLL
    for (int j = 0; j < (K < 3 ? K : 3); ++j) {
        h.torque.set_column(j, cross(r, angular.column(j)));
        h.force.set_column(j, linear.column(j));
    }
    CATENA_UNROLL
    for (int j = 3; j < K; ++j) {
        h.torque.set_column(j, angular.column(j - 3));
        if constexpr (any_forces) h.force.set_column(j, Vector<Real, 3>::zero());
    }
    return h;
}

/// Returns the directions along the force axes at a point `r` from the centre of mass (body axes).
/// `angular` is the rotation matrix from the force axes to body axes.
template <int K, class Real>
CATENA_HD GroundHandle<Real, K> make_ground_handle(Vector<Real, 3> const& r,
                                                   Matrix<Real, 3, 3> const& angular) {
    return {make_handle<K>(r, angular, Matrix<Real, 3, 3>{}).torque, r, angular};
}

/// Turns the directions of a handle made for a revolute joint into those of a screw, which combines
/// directions 2 and 5, and puts them into the joint's order.
template <int K, class Real>
CATENA_HD void turn_to_screw(Screw<Real> const& screw, Vector<Real, 3> const& r,
                             Matrix<Real, 3, 3> const& angular, Matrix<Real, 3, 3> const& linear,
                             Handle<Real, K, true>& h) {
    static_assert(K >= 5);
    Vector<Real, 3> const arm = cross(r, angular.column(2)), axis = angular.column(2),
                          along = linear.column(2);
    h.torque.set_column(2, screw.c * arm - screw.s * axis);
    h.force.set_column(2, screw.c * along);
    if constexpr (K == 6) {
        h.torque.set_column(5, screw.s * arm + screw.c * axis);
        h.force.set_column(5, screw.s * along);
    }
    put_in_order(screw.order, h.torque);
    put_in_order(screw.order, h.force);
}

/// Returns the contribution of the torques to leaf_matrix().
template <class Real, int K>
CATENA_HD SegmentMatrix<Real, K> turning_matrix(Symmetric<Real, 3> const& inverse_inertia,
                                                Matrix<Real, 3, K> const& torque1,
                                                Matrix<Real, 3, K> const& torque2) {
    Matrix<Real, 3, K> const j1 = full(inverse_inertia) * torque1;
    Matrix<Real, 3, K> const j2 = full(inverse_inertia) * torque2;
    SegmentMatrix<Real, K> s;
    CATENA_UNROLL
    for (int a = 0; a < K; ++a) {
        CATENA_UNROLL
        for (int b = 0; b < K; ++b) {
            if (b <= a) {
                s.z11(a, b) = dot(torque1.column(a), j1.column(b));
                s.z22(a, b) = dot(torque2.column(a), j2.column(b));
            }
            s.z12(a, b) = dot(torque1.column(a), j2.column(b));
        }
    }
    return s;
}
/// Returns the matrices of a body along the directions of its two handles. Precondition:
/// inverse_mass >= 0, inverse_inertia (body axes) positive semidefinite.
template <class Real, int K, bool any_forces>
CATENA_HD SegmentMatrix<Real, K> leaf_matrix(Real inverse_mass,
                                             Symmetric<Real, 3> const& inverse_inertia,
                                             Handle<Real, K, any_forces> const& h1,
                                             Handle<Real, K, any_forces> const& h2) {
    constexpr int forces = Handle<Real, K, any_forces>::forces;
    SegmentMatrix<Real, K> s = turning_matrix(inverse_inertia, h1.torque, h2.torque);
    CATENA_UNROLL
    for (int a = 0; a < forces; ++a) {
        if constexpr (any_forces) {
            CATENA_UNROLL
            for (int b = 0; b <= a; ++b) {
                s.z11(a, b) =
                    fused(inverse_mass, dot(h1.force.column(a), h1.force.column(b)), s.z11(a, b));
                s.z22(a, b) =
                    fused(inverse_mass, dot(h2.force.column(a), h2.force.column(b)), s.z22(a, b));
            }
        } else {
            s.z11(a, a) = s.z11(a, a) + inverse_mass;
            s.z22(a, a) = s.z22(a, a) + inverse_mass;
        }
        CATENA_UNROLL
        for (int b = 0; b < forces; ++b)
            s.z12(a, b) =
                fused(inverse_mass, dot(h1.force.column(a), h2.force.column(b)), s.z12(a, b));
    }
    return s;
}
/// Returns the matrices of a body whose handles lie along the force axes.
template <class Real, int K>
CATENA_HD SegmentMatrix<Real, K> leaf_matrix(Real inverse_mass,
                                             Symmetric<Real, 3> const& inverse_inertia,
                                             GroundHandle<Real, K> const& h1,
                                             GroundHandle<Real, K> const& h2) {
    static_assert(K == 3 || K == 6);
    SegmentMatrix<Real, K> s = turning_matrix(inverse_inertia, h1.torque, h2.torque);
    CATENA_UNROLL
    for (int a = 0; a < 3; ++a) {
        s.z11(a, a) = s.z11(a, a) + inverse_mass;
        s.z22(a, a) = s.z22(a, a) + inverse_mass;
        s.z12(a, a) = s.z12(a, a) + inverse_mass;
    }
    return s;
}

/// Returns the acceleration along the handle's directions, without velocity terms. The body has
/// angular acceleration `alpha` (body axes), its centre of mass has acceleration `a`.
template <class Real, int K, bool any_forces>
CATENA_HD Vector<Real, K> along(Handle<Real, K, any_forces> const& h, Vector<Real, 3> const& alpha,
                                Vector<Real, 3> const& a) {
    Vector<Real, K> v = transposed_times(h.torque, alpha);
    auto const pushed = transposed_times(h.force, a);
    CATENA_UNROLL
    for (int i = 0; i < Handle<Real, K, any_forces>::forces; ++i) v[i] = v[i] + pushed[i];
    return v;
}
template <class Real, int K>
CATENA_HD Vector<Real, K> along(GroundHandle<Real, K> const& h, Vector<Real, 3> const& alpha,
                                Vector<Real, 3> const& a) {
    Vector<Real, K> v = transposed_times(h.torque, alpha);
    CATENA_UNROLL
    for (int i = 0; i < 3; ++i) v[i] = v[i] + a[i];
    return v;
}
/// Returns the force on the body when `f` are the forces along the handle's directions.
template <class Real, int K, bool any_forces>
CATENA_HD Vector<Real, 3> push(Handle<Real, K, any_forces> const& h, Vector<Real, K> const& f) {
    Vector<Real, Handle<Real, K, any_forces>::forces> pushing;
    CATENA_UNROLL
    for (int i = 0; i < Handle<Real, K, any_forces>::forces; ++i) pushing[i] = f[i];
    return h.force * pushing;
}
template <class Real, int K>
CATENA_HD Vector<Real, 3> push(GroundHandle<Real, K> const&, Vector<Real, K> const& f) {
    return {{f[0], f[1], f[2]}};
}
/// Returns the torque about the centre of mass (body axes) when `f` are the forces along the
/// handle's directions.
template <class Real, int K, bool any_forces>
CATENA_HD Vector<Real, 3> moment(Handle<Real, K, any_forces> const& h, Vector<Real, K> const& f) {
    return h.torque * f;
}
template <class Real, int K>
CATENA_HD Vector<Real, 3> moment(GroundHandle<Real, K> const& h, Vector<Real, K> const& f) {
    Vector<Real, 3> const m = cross(h.r, h.angular * push(h, f));
    if constexpr (K == 6)
        return m + h.angular * Vector<Real, 3>{{f[3], f[4], f[5]}};
    else
        return m;
}

/// Returns A x from the inverse of A, which is symmetric and positive definite.
template <class Real, class Inverse = Quotient>
CATENA_HD Vector<Real, 3> times_inverse_of(Symmetric<Real, 3> const& inverse,
                                           Vector<Real, 3> const& x, Inverse const& quotient = {}) {
    Symmetric<Real, 3> const factor = factorize(inverse, 3, quotient);
    return solve_upper(factor, solve_lower(factor, x));
}

/// Returns an orthonormal right-handed triple (axis, p, q) for the unit vector `axis`, in columns
/// (Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
template <class Real>
CATENA_HD Matrix<Real, 3, 3> triple(Vector<Real, 3> const& axis) {
    Real const sign = axis[2] < Real(0) ? Real(-1) : Real(1);
    Real const a = Real(-1) / (sign + axis[2]);
    Real const b = axis[0] * axis[1] * a;
    Matrix<Real, 3, 3> m;
    m.set_column(0, axis);
    m.set_column(1, {{Real(1) + sign * axis[0] * axis[0] * a, sign * b, -sign * axis[0]}});
    m.set_column(2, {{b, sign + axis[1] * axis[1] * a, -axis[1]}});
    return m;
}

/// Returns the matrices of a point bead between links with unit directions u1 (from its inboard
/// neighbour to it) and u2 (from it to its outboard neighbour). Projected handles give T of the
/// link chain (src/dca/README.md, "Link chains"). A missing link has direction 0.
template <class Real>
CATENA_HD SegmentMatrix<Real, 1> bead_matrix(Real inverse_mass, Vector<Real, 3> const& u1,
                                             Vector<Real, 3> const& u2, Vector<Real, 1>) {
    SegmentMatrix<Real, 1> s;
    s.z11(0, 0) = inverse_mass;
    s.z22(0, 0) = inverse_mass;
    s.z12(0, 0) = inverse_mass * dot(u1, u2);
    return s;
}
/// Returns the matrices for full handles: all three directions, the link's first.
template <class Real>
CATENA_HD SegmentMatrix<Real, 3> bead_matrix(Real inverse_mass, Vector<Real, 3> const& u1,
                                             Vector<Real, 3> const& u2, Vector<Real, 3>) {
    SegmentMatrix<Real, 3> s;
    s.z11 = Symmetric<Real, 3>::zero();
    CATENA_UNROLL
    for (int a = 0; a < 3; ++a) s.z11(a, a) = inverse_mass;
    s.z22 = s.z11;
    s.z12 = transposed_times(triple(u1), triple(u2));
    CATENA_UNROLL
    for (int a = 0; a < 9; ++a) s.z12.data[a] = inverse_mass * s.z12.data[a];
    return s;
}
/// Returns the components of a vector along the directions of a bead's handle.
template <class Real>
CATENA_HD Vector<Real, 1> along_link(Vector<Real, 3> const& u, Vector<Real, 3> const& a,
                                     Vector<Real, 1>) {
    return {{dot(u, a)}};
}
template <class Real>
CATENA_HD Vector<Real, 3> along_link(Vector<Real, 3> const& u, Vector<Real, 3> const& a,
                                     Vector<Real, 3>) {
    return transposed_times(triple(u), a);
}
/// Returns the bias of a bead between the links u1 and u2 under the external force `force`.
template <class Real, int K>
CATENA_HD SegmentBias<Real, K> bead_bias(Real inverse_mass, Vector<Real, 3> const& force,
                                         Vector<Real, 3> const& u1, Vector<Real, 3> const& u2,
                                         Vector<Real, K> kind) {
    Vector<Real, 3> const a = inverse_mass * force;
    return {along_link(u1, a, kind), along_link(u2, a, kind)};
}
/// Returns the acceleration of a bead on which its links act with `inboard` along u1 and `outboard`
/// against u2.
template <class Real>
CATENA_HD Vector<Real, 3> bead_acceleration(Real inverse_mass, Vector<Real, 3> const& force,
                                            Real inboard, Vector<Real, 3> const& u1, Real outboard,
                                            Vector<Real, 3> const& u2) {
    return inverse_mass * plus_scaled(plus_scaled(force, inboard, u1), -outboard, u2);
}

}  // namespace catena::dca
