// Motion of one joint, on host and device. A joint's motion (rotation, translation, angular and
// linear velocity) composes associatively, so the motion along the chain is a parallel scan.
//
// Frames: W ground axes; B a body's axes; J the joint frame, fixed in the inboard body; M the
// meeting frame, in which the two bodies of a joint meet (ChainGroup). Units: nm, ps and rad,
// unless the scene has `units: si`.
#pragma once

#include "chain/chain_group.hpp"
#include "dca/lane_access.hpp"
#include "dca/leaf.hpp"
#include "joints/joint_models.hpp"
#include "scene/pose.hpp"

namespace catena {

using dca::is_one_body, dca::Mat3At, dca::QuatAt, dca::read, dca::RealAt, dca::Screw, dca::Vec3At,
    dca::write, dca::write_directions;

/// Motion of a frame B relative to a frame A.
template <class Real>
struct MotionOf {
    Quaternion<Real> rotation;    // Quaternion Q_AB of B in A.
    Vector<Real, 3> omega;        // Angular velocity of B relative to A, B axes.
    Vector<Real, 3> translation;  // Origin of B from the origin of A, A axes.
    Vector<Real, 3> velocity;     // Velocity of the origin of B relative to A, B axes.
    /// Motion of a frame relative to itself.
    static CATENA_HD MotionOf none() {
        return {Quaternion<Real>::identity(), Vector<Real, 3>::zero(), Vector<Real, 3>::zero(),
                Vector<Real, 3>::zero()};
    }
};
using Motion = MotionOf<double>;
/// The 13 components of a motion (quaternion w x y z, omega, translation, velocity), for storage
/// and messages.
CATENA_HD Vector<double, 13> as_numbers(Motion const& m) {
    Quat const q = m.rotation;
    Vec3 const w = m.omega, x = m.translation, v = m.velocity;
    return {{q.w, q.x, q.y, q.z, w[0], w[1], w[2], x[0], x[1], x[2], v[0], v[1], v[2]}};
}
/// Inverse of as_numbers().
template <class Real>
CATENA_HD MotionOf<Real> as_motion(Vector<Real, 13> const& n) {
    return {{n[0], n[1], n[2], n[3]},
            {{n[4], n[5], n[6]}},
            {{n[7], n[8], n[9]}},
            {{n[10], n[11], n[12]}}};
}
/// Angular velocity of C relative to A, C axes. `omega` is that of B relative to A (B axes), and
/// `bc` is the motion of C relative to B.
template <class Real>
CATENA_HD Vector<Real, 3> compose(Vector<Real, 3> const& omega, MotionOf<Real> const& bc) {
    return transposed_times(to_matrix(bc.rotation), omega) + bc.omega;
}
/// Motion of C relative to A, from those of B relative to A and of C relative to B. If `positions`
/// is false, translation and velocity are zero.
template <bool positions, class Real>
CATENA_HD MotionOf<Real> compose(MotionOf<Real> const& ab, MotionOf<Real> const& bc) {
    using Vector3 = Vector<Real, 3>;
    MotionOf<Real> ac{ab.rotation * bc.rotation, compose(ab.omega, bc), Vector3::zero(),
                      Vector3::zero()};
    if constexpr (positions) {
        ac.translation = ab.translation + to_matrix(ab.rotation) * bc.translation;
        ac.velocity = transposed_times(to_matrix(bc.rotation),
                                       ab.velocity + cross(ab.omega, bc.translation)) +
                      bc.velocity;
    }
    return ac;
}

/// State of bodies in joint coordinates: q and its rates qd, with the conventions of BodyArrays.
struct StateView {
    View<4> q;
    View<3> qd;
    /// Position and velocity of the origin of body 1, W, by piece. They are used if the piece
    /// begins on a free base.
    View<3> base_position, base_velocity;
};

/// Result of the forward kinematics. Origins and velocities are left unset unless they are
/// requested.
struct MotionView {
    View<4> joint_turn;  // Quaternion of B in the meeting frame M of the inboard joint.
    /// Quaternion of B in W. If `orients_first_alone`, it is set for the first body of each chain
    /// only.
    View<4> orientation;
    View<3> omega;     // Angular velocity of B, B axes.
    View<3> origin;    // Origin of B, W.
    View<3> velocity;  // Velocity of the origin of B, B axes.
    // Handle 2 of bodies (ConfigurationView::r2, axes2), B axes. Present only in groups whose
    // meeting frames move in the inboard body. In branched chains, entry k is the handle of the
    // inboard body of body k at the joint between them.
    View<3> r2;
    View<6> axes2;
    bool orients_first_alone = false;
};

/// Inboard side of a joint, in the axes of the inboard body.
template <class Real>
struct MeetingOf {
    Vector<Real, 3> point;  // Meeting point from the body's origin.
    Matrix<Real, 3, 3> axes;
};
using Meeting = MeetingOf<double>;

template <class Place>
struct JointAt;

/// Inboard joints of a group's bodies, as plain pointers for loops over bodies. ChainGroup
/// documents the arrays.
struct JointsView {
    std::int64_t size = 0;
    JointType const* joint = nullptr;
    std::uint8_t const *is_first = nullptr, *is_last = nullptr;
    bool planar = false, has_screws = false;
    ConstView<3> r1;
    ConstView<6> axes1;
    ConstView<4> joint_rotation;
    ConstView<3> joint_translation, first_axis;
    ConstView<4> screw;
    std::int64_t const* piece = nullptr;  // First bodies (local) of the pieces.
    std::int64_t pieces = 0;
    LocalDrive const* drive = nullptr;
    std::int64_t drives = 0;
    /// Branched chains: inboard body of each body (Branching::inboard), and the bodies that hang on
    /// each (dca::Levels). Null for other chains.
    std::int64_t const *inboard = nullptr, *first_child = nullptr, *child = nullptr;

    // Members below take a place k: the index of one body, or several consecutive bodies side by
    // side in vector lanes. The bodies of such a place have joints of one type, and none of them
    // begins a chain.
    CATENA_HD JointType type(std::int64_t k) const { return joint[k]; }
    template <dca::SeveralBodies Place>
    CATENA_HD JointType type(Place const& several) const {
        return joint[several.first];
    }
    CATENA_HD bool starts_chain(std::int64_t k) const { return is_first[k] != 0; }
    CATENA_HD bool ends_chain(std::int64_t k) const { return is_last[k] != 0; }
    template <dca::SeveralBodies Place>
    CATENA_HD bool starts_chain(Place const&) const {
        return false;
    }
    template <dca::SeveralBodies Place>
    CATENA_HD bool ends_chain(Place const&) const {
        return false;
    }
    /// Axes of the inboard joint in M, as columns.
    template <class Place>
    CATENA_HD Mat3At<Place> axes(Place k) const {
        return axes_of(read(axes1, k));
    }
    /// The joint's axis, the last column of axes(). The axis of a universal joint here is the
    /// second one.
    template <class Place>
    CATENA_HD Vec3At<Place> axis(Place k) const {
        return {{read(axes1, k, 3), read(axes1, k, 4), read(axes1, k, 5)}};
    }
    /// {c, s, rate, order} of LocalJoints::screw: a coordinate q rotates the joint by c rate q
    /// about its axis and slides it by s rate q.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> screw_of(Place k) const {
        using Real = RealAt<Place>;
        return has_screws ? read(screw, k)
                          : Vector<Real, 4>{{Real(1), Real(0), Real(1), Real(usual_order)}};
    }
    /// Directions of the joint's handles.
    template <class Place>
    CATENA_HD Screw<RealAt<Place>> direction_of_screw(Place k) const {
        return dca::as_screw(screw_of(k));
    }
    /// True if joint k translates along its first two axes; k may be the halo's joint.
    CATENA_HD bool glides(std::int64_t k) const {
        return has_screws && glides_in(static_cast<int>(screw.at(k, 3)));
    }
    template <dca::SeveralBodies Place>
    CATENA_HD bool glides(Place const& several) const {
        return catena::glides(type(several));
    }
    /// True if the coordinates of joint k are a unit quaternion.
    template <class Place>
    CATENA_HD bool has_quaternion(Place k) const {
        return catena::has_quaternion(type(k));
    }
    /// Index of the piece that contains body k; a binary search.
    CATENA_HD std::int64_t piece_of(std::int64_t k) const {
        std::int64_t low = 0, high = pieces;
        while (high - low > 1) {
            std::int64_t const middle = (low + high) / 2;
            if (piece[middle] <= k)
                low = middle;
            else
                high = middle;
        }
        return low;
    }
    /// Prescribed motion of joint k; null if it has none. A binary search.
    CATENA_HD LocalDrive const* drive_of(std::int64_t k) const {
        std::int64_t low = 0, high = drives;
        while (low < high) {
            std::int64_t const middle = (low + high) / 2;
            if (drive[middle].body < k)
                low = middle + 1;
            else
                high = middle;
        }
        return low < drives && drive[low].body == k ? drive + low : nullptr;
    }

    /// Rotation of B in M that the coordinates of joint k describe.
    template <class Place>
    CATENA_HD QuatAt<Place> turn_of(StateView const& state, Place k) const {
        JointAt<Place> const joint_k{*this, state, k};
        return with_motion(type(k), [&](auto motion) { return motion.turn(joint_k); });
    }
    /// Rotation of the meeting frame M of joint k in the inboard body's axes. It differs from the
    /// joint frame's rotation only in universal joints.
    template <class Place>
    CATENA_HD QuatAt<Place> meeting_rotation(StateView const& state, Place k) const {
        JointAt<Place> const joint_k{*this, state, k};
        QuatAt<Place> const frame = as_quaternion(read(joint_rotation, k));
        return with_motion(type(k), [&](auto motion) { return motion.meeting(joint_k, frame); });
    }
    /// Meeting point of joint k from the inboard body's origin, in the inboard body's axes. In a
    /// joint that translates it moves with the outboard body.
    template <class Place>
    CATENA_HD Vec3At<Place> meeting_point(StateView const& state, Place k) const {
        Vec3At<Place> const point = read(joint_translation, k);
        if (!slides(k)) return point;
        JointAt<Place> const joint_k{*this, state, k};
        Mat3At<Place> const frame = to_matrix(as_quaternion(read(joint_rotation, k)));
        return point + frame * with_axis_motion(type(k),
                                                [&](auto motion) { return motion.shift(joint_k); });
    }
    /// True if joint k translates.
    template <class Place>
    CATENA_HD bool slides(Place k) const {
        return has_screws && catena::slides(type(k));
    }
    /// Velocity of body k relative to the inboard side of its joint, M axes.
    template <class Place>
    CATENA_HD JointRate<RealAt<Place>> rate(StateView const& state, Place k) const {
        JointAt<Place> const joint_k{*this, state, k};
        return with_motion(type(k), [&](auto motion) { return motion.rate(joint_k); });
    }
    /// Motion of body k relative to its inboard body; on a free base, relative to the ground.
    /// `rotation` must be turn_of().
    template <class Place>
    CATENA_HD MotionOf<RealAt<Place>> motion(StateView const& state, Place k,
                                             QuatAt<Place> const& rotation) const {
        using Vector3 = Vec3At<Place>;
        if constexpr (is_one_body<Place>)
            if (floats(joint[k])) {
                std::int64_t const p = piece_of(k);
                return {rotation, state.qd.load(k), state.base_position.load(p),
                        transposed_times(to_matrix(rotation), state.base_velocity.load(p))};
            }
        MotionOf<RealAt<Place>> m{meeting_rotation(state, k) * rotation, Vector3::zero(),
                                  meeting_point(state, k), Vector3::zero()};
        JointAt<Place> const joint_k{*this, state, k};
        if (with_motion(type(k), [&](auto motion) { return motion.sets_omega(joint_k, m); }))
            return m;
        // The code below serves all other motions: copies of it would not be inlined on a GPU.
        Mat3At<Place> const to_meeting = to_matrix(rotation);
        auto const r = rate(state, k);
        m.omega = transposed_times(to_meeting, r.angular);
        m.velocity = transposed_times(to_meeting, r.linear);
        return m;
    }
    /// Meeting point and joint axes of joint k in its inboard body.
    template <class Place>
    CATENA_HD MeetingOf<RealAt<Place>> meeting(StateView const& state, Place k) const {
        return {meeting_point(state, k), to_matrix(meeting_rotation(state, k)) * axes(k)};
    }
    /// Normal of the chain's plane, with the same components in M and B; zero if the chains are not
    /// planar.
    template <class Place>
    CATENA_HD Vec3At<Place> normal(Place k) const {
        return planar ? axis(k) : Vec3At<Place>::zero();
    }
    /// Removes the component of an angular velocity across the normal of a planar chain. Bodies
    /// rotate about the normal only; rounding in compose() adds other components, which grow with
    /// the length of the chain.
    template <class Real>
    CATENA_HD Vector<Real, 3> kept_in_plane(Vector<Real, 3> const& plane,
                                            Vector<Real, 3> const& omega) const {
        return planar ? dot(plane, omega) * plane : omega;
    }
    /// Sets q and qd of a joint with prescribed motion to their values at `time`. Does nothing for
    /// other joints.
    CATENA_HD void follow_course(StateView const& state, std::int64_t k, double time) const {
        LocalDrive const* const d = drives > 0 ? drive_of(k) : nullptr;
        if (!d) return;
        bool const two = has_two_coordinates(joint[k]);
        state.q.store(k, Vector<double, 4>{{scene::value_at(d->first, time),
                                            two ? scene::value_at(d->second, time) : 0.0, 0, 0}});
        state.qd.store(k, Vec3{{scene::rate_at(d->first, time),
                                two ? scene::rate_at(d->second, time) : 0.0, 0}});
    }
};

/// Inboard joint of the bodies at a place, as the motions of joints read it (motion_terms.hpp).
template <class Place>
struct JointAt {
    using Real = RealAt<Place>;
    using Vector3 = Vec3At<Place>;
    using Rotation = QuatAt<Place>;

    JointsView const& joints;
    StateView const& state;
    Place k;

    CATENA_HD Mat3At<Place> axes() const { return joints.axes(k); }
    CATENA_HD Vector3 axis() const { return joints.axis(k); }
    CATENA_HD Vector3 first_axis() const { return read(joints.first_axis, k); }
    CATENA_HD Vector<Real, 4> screw() const { return joints.screw_of(k); }
    CATENA_HD bool has_screws() const { return joints.has_screws; }
    CATENA_HD Real coordinate(int i) const { return read(state.q, k, i); }
    CATENA_HD Rotation quaternion() const { return as_quaternion(read(state.q, k)); }
    CATENA_HD Real rate(int i) const { return read(state.qd, k, i); }
    CATENA_HD Vector3 rates() const { return read(state.qd, k); }
    CATENA_HD bool floats() const { return catena::floats(joints.type(k)); }
    CATENA_HD bool pivots() const { return catena::pivots(joints.type(k)); }
};

}  // namespace catena
