// How joints move their bodies, host and device. A joint's motion (rotation, translation, angular and linear velocity) composes
// associatively along the chain, so the way along it is a scan.
#pragma once

#include "chain/chain_group.hpp"
#include "dca/leaf.hpp"
#include "scene/pose.hpp"

namespace catena {

using dca::Screw;

/// The motion of a frame B against a frame A.
struct Motion {
    Quat rotation;     // Q_AB
    Vec3 omega;        // of B against A, B
    Vec3 translation;  // of B's origin from A's, A
    Vec3 velocity;     // of B's origin against A, B
    static CATENA_HD Motion none() { return {Quat::identity(), Vec3::zero(), Vec3::zero(), Vec3::zero()}; }
};
/// As numbers, for storage and messages.
CATENA_HD Vector<double, 13> as_numbers(Motion const& m) {
    Quat const q = m.rotation;
    Vec3 const w = m.omega, x = m.translation, v = m.velocity;
    return {{q.w, q.x, q.y, q.z, w[0], w[1], w[2], x[0], x[1], x[2], v[0], v[1], v[2]}};
}
CATENA_HD Motion as_motion(Vector<double, 13> const& n) {
    return {{n[0], n[1], n[2], n[3]}, {{n[4], n[5], n[6]}}, {{n[7], n[8], n[9]}}, {{n[10], n[11], n[12]}}};
}
/// Motion of C against A from those of B against A and C against B. Without `positions` translation and velocity stay zero.
template <bool positions>
CATENA_HD Motion compose(Motion const& ab, Motion const& bc) {
    Mat3 const turn = to_matrix(bc.rotation);
    Motion ac{ab.rotation * bc.rotation, transposed_times(turn, ab.omega) + bc.omega, Vec3::zero(), Vec3::zero()};
    if constexpr (positions) {
        ac.translation = ab.translation + to_matrix(ab.rotation) * bc.translation;
        ac.velocity = transposed_times(turn, ab.velocity + cross(ab.omega, bc.translation)) + bc.velocity;
    }
    return ac;
}

/// The coordinates' rates as a relative motion of a joint: angular and linear velocity of the outboard side against the inboard one, M.
struct JointRate {
    Vec3 angular, linear;
};

/// State of bodies in joint coordinates (rules of BodyArrays).
struct StateView {
    View<4> q;
    View<3> qd;
    View<3> base_position, base_velocity;  // one a piece; counts where the piece starts on a free base: origin of body 1, W
};

/// What a pass over the chain finds. Without poses where nobody asks for them.
struct MotionView {
    View<4> joint_turn;   // quaternion of B in the meeting frame M of its inboard joint
    View<4> orientation;  // of B in W
    View<3> omega;        // of B, B
    View<3> origin;       // of B, W
    View<3> velocity;     // of B's origin, B
    // Where the meeting frames of outboard joints move in their inboard body (else absent): as ConfigurationView.
    View<3> r2;
    View<9> axes2;
};

/// The inboard side of a joint, seen from the body it is in.
struct Meeting {
    Vec3 point;  // from the origin
    Mat3 axes;
};

/// The inboard joints of a group's bodies, as plain pointers (ChainGroup says what they hold).
struct JointsView {
    std::int64_t size = 0;
    JointType const* joint = nullptr;
    std::uint8_t const *is_first = nullptr, *is_last = nullptr;
    bool planar = false, has_screws = false;
    ConstView<3> r1;
    ConstView<9> axes1;
    ConstView<4> joint_rotation;
    ConstView<3> joint_translation, first_axis, screw;
    std::int64_t const* piece = nullptr;  // first bodies of the pieces
    std::int64_t pieces = 0;
    LocalDrive const* drive = nullptr;
    std::int64_t drives = 0;

    CATENA_HD Mat3 axes(std::int64_t k) const { return as_matrix(axes1.load(k)); }
    CATENA_HD Vec3 axis(std::int64_t k) const { return {{axes1.at(k, 2), axes1.at(k, 5), axes1.at(k, 8)}}; }
    /// {c, s, rate} of ChainGroup::screw: the joint turns by c rate q and slides by s rate q.
    CATENA_HD Vec3 screw_of(std::int64_t k) const { return has_screws ? screw.load(k) : Vec3{{1, 0, 1}}; }
    CATENA_HD Screw<double> direction_of_screw(std::int64_t k) const {
        Vec3 const s = screw_of(k);
        return {s[0], s[1]};
    }
    CATENA_HD bool has_quaternion(std::int64_t k) const { return joint[k] == JointType::free || joint[k] == JointType::spherical; }
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
    CATENA_HD Quat turn_of(StateView const& state, std::int64_t k) const {
        switch (joint[k]) {
            case JointType::free:
            case JointType::spherical:
                return as_quaternion(state.q.load(k));
            case JointType::universal:
                return from_axis_angle(axis(k), state.q.at(k, 1));
            case JointType::weld:
            case JointType::link:
                return Quat::identity();
            default:
                Vec3 const s = screw_of(k);
                return from_axis_angle(axis(k), s[0] * s[2] * state.q.at(k, 0));
        }
    }
    /// Of the meeting frame M of joint k in the inboard body's axes.
    CATENA_HD Quat meeting_rotation(StateView const& state, std::int64_t k) const {
        Quat const frame = as_quaternion(joint_rotation.load(k));
        if (joint[k] != JointType::universal) return frame;
        return frame * from_axis_angle(first_axis.load(k), state.q.at(k, 0));
    }
    /// Of the meeting point from the inboard body's origin, its axes.
    CATENA_HD Vec3 meeting_point(StateView const& state, std::int64_t k) const {
        Vec3 const point = joint_translation.load(k);
        if (!has_screws) return point;
        Vec3 const s = screw_of(k);
        if (s[1] == 0) return point;
        Mat3 const frame = to_matrix(as_quaternion(joint_rotation.load(k)));
        return point + frame * ((s[1] * s[2] * state.q.at(k, 0)) * axis(k));
    }
    CATENA_HD JointRate rate(StateView const& state, std::int64_t k) const {
        Vec3 const qd = state.qd.load(k);
        switch (joint[k]) {
            case JointType::free:
            case JointType::spherical:
                return {to_matrix(turn_of(state, k)) * qd, Vec3::zero()};
            case JointType::universal:
                return {qd[0] * first_axis.load(k) + qd[1] * axis(k), Vec3::zero()};
            case JointType::weld:
            case JointType::link:
                return {Vec3::zero(), Vec3::zero()};
            default:
                Vec3 const s = screw_of(k), along = axis(k);
                return {(s[0] * s[2] * qd[0]) * along, (s[1] * s[2] * qd[0]) * along};
        }
    }
    /// Of body k against its inboard body. `turn`: turn_of().
    CATENA_HD Motion motion(StateView const& state, std::int64_t k, Quat const& turn) const {
        if (joint[k] == JointType::free) {
            std::int64_t const p = piece_of(k);
            return {turn, state.qd.load(k), state.base_position.load(p), transposed_times(to_matrix(turn), state.base_velocity.load(p))};
        }
        Motion m{meeting_rotation(state, k) * turn, Vec3::zero(), meeting_point(state, k), Vec3::zero()};
        switch (joint[k]) {
            case JointType::spherical:
                m.omega = state.qd.load(k);
                break;
            case JointType::revolute:  // B's axis is M's
                m.omega = state.qd.at(k, 0) * axis(k);
                break;
            case JointType::weld:
                break;
            default:
                Mat3 const to_meeting = to_matrix(turn);
                JointRate const r = rate(state, k);
                m.omega = transposed_times(to_meeting, r.angular);
                m.velocity = transposed_times(to_meeting, r.linear);
        }
        return m;
    }
    CATENA_HD Meeting meeting(StateView const& state, std::int64_t k) const {
        return {meeting_point(state, k), to_matrix(meeting_rotation(state, k)) * axes(k)};
    }
    /// Of the chain's plane, the same in M and B.
    CATENA_HD Vec3 normal(std::int64_t k) const { return planar ? axis(k) : Vec3::zero(); }
    /// In a plane bodies turn about its normal alone: composing rounds a part across it, which grows with the chain.
    CATENA_HD Vec3 kept_in_plane(Vec3 const& plane, Vec3 const& omega) const { return planar ? dot(plane, omega) * plane : omega; }
    /// Sets q and qd of a driven joint to its courses' at a time.
    CATENA_HD void follow_course(StateView const& state, std::int64_t k, double time) const {
        LocalDrive const* const d = drives > 0 ? drive_of(k) : nullptr;
        if (!d) return;
        bool const two = joint[k] == JointType::universal;
        state.q.store(k, Vector<double, 4>{{scene::value_at(d->first, time), two ? scene::value_at(d->second, time) : 0.0, 0, 0}});
        state.qd.store(k, Vec3{{scene::rate_at(d->first, time), two ? scene::rate_at(d->second, time) : 0.0, 0}});
    }
};

}  // namespace catena
