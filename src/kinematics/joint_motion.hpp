// How joints move their bodies, host and device. A joint's motion (rotation, translation, angular
// and linear velocity) composes associatively along the chain, so the way along it is a scan.
#pragma once

#include "chain/chain_group.hpp"
#include "dca/lane_access.hpp"
#include "dca/leaf.hpp"
#include "scene/pose.hpp"

namespace catena {

using dca::is_one_body, dca::Mat3At, dca::QuatAt, dca::read, dca::RealAt, dca::Screw, dca::Vec3At,
    dca::write, dca::write_directions;

/// The motion of a frame B against a frame A.
template <class Real>
struct MotionOf {
    Quaternion<Real> rotation;    // Q_AB
    Vector<Real, 3> omega;        // of B against A, B
    Vector<Real, 3> translation;  // of B's origin from A's, A
    Vector<Real, 3> velocity;     // of B's origin against A, B
    static CATENA_HD MotionOf none() {
        return {Quaternion<Real>::identity(), Vector<Real, 3>::zero(), Vector<Real, 3>::zero(),
                Vector<Real, 3>::zero()};
    }
};
using Motion = MotionOf<double>;
/// As numbers, for storage and messages.
CATENA_HD Vector<double, 13> as_numbers(Motion const& m) {
    Quat const q = m.rotation;
    Vec3 const w = m.omega, x = m.translation, v = m.velocity;
    return {{q.w, q.x, q.y, q.z, w[0], w[1], w[2], x[0], x[1], x[2], v[0], v[1], v[2]}};
}
template <class Real>
CATENA_HD MotionOf<Real> as_motion(Vector<Real, 13> const& n) {
    return {{n[0], n[1], n[2], n[3]},
            {{n[4], n[5], n[6]}},
            {{n[7], n[8], n[9]}},
            {{n[10], n[11], n[12]}}};
}
/// Angular velocity of C against A, C, from that of B against A and the motion of C against B.
template <class Real>
CATENA_HD Vector<Real, 3> compose(Vector<Real, 3> const& omega, MotionOf<Real> const& bc) {
    return transposed_times(to_matrix(bc.rotation), omega) + bc.omega;
}
/// Motion of C against A from those of B against A and C against B. Without `positions` translation
/// and velocity stay zero.
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

/// The coordinates' rates as a relative motion of a joint: angular and linear velocity of the
/// outboard side against the inboard one, M.
template <class Real>
struct JointRate {
    Vector<Real, 3> angular, linear;
};

/// State of bodies in joint coordinates (rules of BodyArrays).
struct StateView {
    View<4> q;
    View<3> qd;
    View<3> base_position, base_velocity;  // one a piece; counts where the piece starts on a free
                                           // base: origin of body 1, W
};

/// What a pass over the chain finds. Without poses where nobody asks for them.
struct MotionView {
    View<4> joint_turn;   // quaternion of B in the meeting frame M of its inboard joint
    View<4> orientation;  // of B in W; of chains' first bodies alone where `orients_first_alone`
    View<3> omega;        // of B, B
    View<3> origin;       // of B, W
    View<3> velocity;     // of B's origin, B
    // Where the meeting frames of outboard joints move in their inboard body (else absent): as
    // ConfigurationView.
    View<3> r2;
    View<6> axes2;
    bool orients_first_alone = false;
};

/// The inboard side of a joint, seen from the body it is in.
template <class Real>
struct MeetingOf {
    Vector<Real, 3> point;  // from the origin
    Matrix<Real, 3, 3> axes;
};
using Meeting = MeetingOf<double>;

/// The inboard joints of a group's bodies, as plain pointers (ChainGroup says what they hold).
struct JointsView {
    std::int64_t size = 0;
    JointType const* joint = nullptr;
    std::uint8_t const *is_first = nullptr, *is_last = nullptr;
    bool planar = false, has_screws = false;
    ConstView<3> r1;
    ConstView<6> axes1;
    ConstView<4> joint_rotation;
    ConstView<3> joint_translation, first_axis, screw;
    std::int64_t const* piece = nullptr;  // first bodies of the pieces
    std::int64_t pieces = 0;
    LocalDrive const* drive = nullptr;
    std::int64_t drives = 0;

    // Of one body, or of several next to each other whose joints are of one type and none of which
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
    template <class Place>
    CATENA_HD Mat3At<Place> axes(Place k) const {
        return axes_of(read(axes1, k));
    }
    template <class Place>
    CATENA_HD Vec3At<Place> axis(Place k) const {
        return {{read(axes1, k, 3), read(axes1, k, 4), read(axes1, k, 5)}};
    }
    /// {c, s, rate} of ChainGroup::screw: the joint turns by c rate q and slides by s rate q.
    template <class Place>
    CATENA_HD Vec3At<Place> screw_of(Place k) const {
        using Real = RealAt<Place>;
        return has_screws ? read(screw, k) : Vec3At<Place>{{Real(1), Real(0), Real(1)}};
    }
    template <class Place>
    CATENA_HD Screw<RealAt<Place>> direction_of_screw(Place k) const {
        auto const s = screw_of(k);
        return {s[0], s[1]};
    }
    template <class Place>
    CATENA_HD bool has_quaternion(Place k) const {
        return type(k) == JointType::free || type(k) == JointType::spherical;
    }
    /// The piece that body k is in.
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
    /// What drives joint k; null: nothing.
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

    /// Of B in M.
    template <class Place>
    CATENA_HD QuatAt<Place> turn_of(StateView const& state, Place k) const {
        switch (type(k)) {
            case JointType::free:
            case JointType::spherical:
                return as_quaternion(read(state.q, k));
            case JointType::universal:
                return from_axis_angle(axis(k), read(state.q, k, 1));
            case JointType::weld:
            case JointType::link:
                return QuatAt<Place>::identity();
            default:
                auto const s = screw_of(k);
                return from_axis_angle(axis(k), s[0] * s[2] * read(state.q, k, 0));
        }
    }
    /// Of the meeting frame M of joint k in the inboard body's axes.
    template <class Place>
    CATENA_HD QuatAt<Place> meeting_rotation(StateView const& state, Place k) const {
        QuatAt<Place> const frame = as_quaternion(read(joint_rotation, k));
        if (type(k) != JointType::universal) return frame;
        return frame * from_axis_angle(read(first_axis, k), read(state.q, k, 0));
    }
    /// Of the meeting point from the inboard body's origin, its axes.
    template <class Place>
    CATENA_HD Vec3At<Place> meeting_point(StateView const& state, Place k) const {
        Vec3At<Place> const point = read(joint_translation, k);
        if (!slides(k)) return point;
        auto const s = screw_of(k);
        Mat3At<Place> const frame = to_matrix(as_quaternion(read(joint_rotation, k)));
        return point + frame * ((s[1] * s[2] * read(state.q, k, 0)) * axis(k));
    }
    template <class Place>
    CATENA_HD bool slides(Place k) const {
        return has_screws && (type(k) == JointType::prismatic || type(k) == JointType::helical);
    }
    template <class Place>
    CATENA_HD JointRate<RealAt<Place>> rate(StateView const& state, Place k) const {
        using Vector3 = Vec3At<Place>;
        Vector3 const qd = read(state.qd, k);
        switch (type(k)) {
            case JointType::free:
            case JointType::spherical:
                return {to_matrix(turn_of(state, k)) * qd, Vector3::zero()};
            case JointType::universal:
                return {qd[0] * read(first_axis, k) + qd[1] * axis(k), Vector3::zero()};
            case JointType::weld:
            case JointType::link:
                return {Vector3::zero(), Vector3::zero()};
            default:
                Vector3 const s = screw_of(k), along = axis(k);
                return {(s[0] * s[2] * qd[0]) * along, (s[1] * s[2] * qd[0]) * along};
        }
    }
    /// Of body k against its inboard body. `turn`: turn_of().
    template <class Place>
    CATENA_HD MotionOf<RealAt<Place>> motion(StateView const& state, Place k,
                                             QuatAt<Place> const& turn) const {
        using Vector3 = Vec3At<Place>;
        if constexpr (is_one_body<Place>)
            if (joint[k] == JointType::free) {
                std::int64_t const p = piece_of(k);
                return {turn, state.qd.load(k), state.base_position.load(p),
                        transposed_times(to_matrix(turn), state.base_velocity.load(p))};
            }
        MotionOf<RealAt<Place>> m{meeting_rotation(state, k) * turn, Vector3::zero(),
                                  meeting_point(state, k), Vector3::zero()};
        switch (type(k)) {
            case JointType::spherical:
                m.omega = read(state.qd, k);
                break;
            case JointType::revolute:  // B's axis is M's
                m.omega = read(state.qd, k, 0) * axis(k);
                break;
            case JointType::weld:
                break;
            default:
                Mat3At<Place> const to_meeting = to_matrix(turn);
                auto const r = rate(state, k);
                m.omega = transposed_times(to_meeting, r.angular);
                m.velocity = transposed_times(to_meeting, r.linear);
        }
        return m;
    }
    template <class Place>
    CATENA_HD MeetingOf<RealAt<Place>> meeting(StateView const& state, Place k) const {
        return {meeting_point(state, k), to_matrix(meeting_rotation(state, k)) * axes(k)};
    }
    /// Of the chain's plane, the same in M and B.
    template <class Place>
    CATENA_HD Vec3At<Place> normal(Place k) const {
        return planar ? axis(k) : Vec3At<Place>::zero();
    }
    /// In a plane bodies turn about its normal alone: composing rounds a part across it, which
    /// grows with the chain.
    template <class Real>
    CATENA_HD Vector<Real, 3> kept_in_plane(Vector<Real, 3> const& plane,
                                            Vector<Real, 3> const& omega) const {
        return planar ? dot(plane, omega) * plane : omega;
    }
    /// Sets q and qd of a driven joint to its courses' at a time.
    CATENA_HD void follow_course(StateView const& state, std::int64_t k, double time) const {
        LocalDrive const* const d = drives > 0 ? drive_of(k) : nullptr;
        if (!d) return;
        bool const two = joint[k] == JointType::universal;
        state.q.store(k, Vector<double, 4>{{scene::value_at(d->first, time),
                                            two ? scene::value_at(d->second, time) : 0.0, 0, 0}});
        state.qd.store(k, Vec3{{scene::rate_at(d->first, time),
                                two ? scene::rate_at(d->second, time) : 0.0, 0}});
    }
};

}  // namespace catena
