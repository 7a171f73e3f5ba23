// Scan over the canonical tree that computes the motion of every body relative to the ground; each
// member handles one item (body, run or slot) on host or device.
//
// Order: (1) bodies relative to their inboard bodies; (2) bodies of a run relative to the body
// before the run; (3) whole runs and pairs of segments, in the inward pass; (4) the motion before
// each segment, in the outward pass; (5) bodies relative to the ground. The motion of a segment is
// that of its last body.
#pragma once

#include "kinematics/joint_motion.hpp"
#include "math/records.hpp"
#include "tree/tree.hpp"

namespace catena {

using MotionRecords = dca::RecordsView<Motion, dca::Order::plain>;
constexpr int first_of_omega = 4;  // Index of omega in as_numbers() of a motion.
/// Number of components of as_numbers() that are kept. Without positions these are rotation and
/// omega, because the others are zero.
template <bool positions>
constexpr int numbers_of_motion = positions ? 13 : 7;
template <bool positions>
using MotionNumbers = Vector<double, numbers_of_motion<positions>>;
/// Components of a motion for storage.
template <bool positions>
CATENA_HD MotionNumbers<positions> packed(Motion const& m) {
    auto const all = as_numbers(m);
    MotionNumbers<positions> numbers;
    CATENA_UNROLL
    for (int i = 0; i < numbers_of_motion<positions>; ++i) numbers[i] = all[i];
    return numbers;
}
/// Inverse of packed(). If `positions` is false, translation and velocity are zero.
template <bool positions>
CATENA_HD Motion unpacked(MotionNumbers<positions> const& numbers) {
    auto all = Vector<double, 13>::zero();
    CATENA_UNROLL
    for (int i = 0; i < numbers_of_motion<positions>; ++i) all[i] = numbers[i];
    return as_motion(all);
}
/// Reads the stored components of slot `slot`.
template <bool positions>
CATENA_HD MotionNumbers<positions> numbers_at(MotionRecords const& records, std::int64_t slot) {
    MotionNumbers<positions> numbers;
    CATENA_UNROLL
    for (int i = 0; i < numbers_of_motion<positions>; ++i) numbers[i] = records.number(slot, i);
    return numbers;
}
/// Stores the components of slot `slot`.
template <bool positions>
CATENA_HD void put_numbers(MotionRecords const& records, std::int64_t slot,
                           MotionNumbers<positions> const& numbers) {
    CATENA_UNROLL
    for (int i = 0; i < numbers_of_motion<positions>; ++i) records.number(slot, i) = numbers[i];
}

/// State, joints and storage of the scan, with one function per item.
struct JointScan {
    JointsView joints;
    StateView state;
    MotionView motion;
    /// Motion of body k: relative to its inboard body at first; after follow(), relative to the
    /// body before its run.
    View<4> rotation;
    View<3> omega, translation, velocity;
    /// Slot of the run of body k.
    std::int32_t const* slot = nullptr;
    /// Motion of each slot's segment relative to the body before it.
    MotionRecords whole;
    /// Motion of the body before each slot's segment, relative to the ground.
    MotionRecords before;
    /// {point, axes} of a meeting: entry 1 is that of the joint after this rank's last body.
    View<9> next_meeting;

    /// Reads the relative motion of body k.
    template <bool positions, class Place>
    CATENA_HD MotionOf<RealAt<Place>> load(Place k) const {
        using Vector3 = Vec3At<Place>;
        MotionOf<RealAt<Place>> m{as_quaternion(read(rotation, k)), read(omega, k), Vector3::zero(),
                                  Vector3::zero()};
        if constexpr (positions) {
            m.translation = read(translation, k);
            m.velocity = read(velocity, k);
        }
        return m;
    }
    /// Writes the relative motion of body k.
    template <bool positions, class Place>
    CATENA_HD void store(Place k, MotionOf<RealAt<Place>> const& m) const {
        write(rotation, k, as_vector(m.rotation));
        write(omega, k, m.omega);
        if constexpr (positions) {
            write(translation, k, m.translation);
            write(velocity, k, m.velocity);
        }
    }
    /// Computes the motion of body k relative to its inboard body from the state. Also sets
    /// MotionView::joint_turn.
    template <bool positions, class Place>
    CATENA_HD void set_relative(Place k) const {
        QuatAt<Place> const of_joint = joints.turn_of(state, k);
        write(motion.joint_turn, k, as_vector(of_joint));
        store<positions>(k, joints.motion(state, k, of_joint));
        if constexpr (is_one_body<Place>)
            if (joints.inboard && motion.axes2.origin && !joints.starts_chain(k))
                put_meeting(k, joints.inboard[k], joints.meeting(state, k));
    }
    /// Composes the motions along a run, stores them relative to the body before the run, and
    /// returns the last one. Four bodies are loaded at a time so that their loads overlap.
    template <bool positions>
    CATENA_HD Motion follow(dca::Run const& run) const {
        constexpr int few = 4;
        std::int64_t const end = run.body + run.count;
        std::int64_t k = run.body + 1;
        Motion m = load<positions>(run.body);
        for (; k + few <= end; k += few) {
            Motion next[few];
            Vec3 normal[few];
            CATENA_UNROLL
            for (int i = 0; i < few; ++i) {
                next[i] = load<positions>(k + i);
                normal[i] = joints.normal(k + i);
            }
            CATENA_UNROLL
            for (int i = 0; i < few; ++i) m = go_on<positions>(m, next[i], normal[i], k + i);
        }
        for (; k < end; ++k) m = go_on<positions>(m, load<positions>(k), joints.normal(k), k);
        m.rotation = normalized(m.rotation);
        return m;
    }
    /// Motion of body k from that of the body before it; stores and returns it.
    template <bool positions>
    CATENA_HD Motion go_on(Motion const& before_it, Motion const& next, Vec3 const& normal,
                           std::int64_t k) const {
        Motion m = compose<positions>(before_it, next);
        m.omega = joints.kept_in_plane(normal, m.omega);
        store<positions>(k, m);
        return m;
    }
    /// Motion of the body before the run of body k, relative to the ground.
    template <bool positions>
    CATENA_HD Motion before_run(std::int64_t k) const {
        if (joints.inboard) return of_inboard_body<positions>(k);
        return unpacked<positions>(numbers_at<positions>(before, slot[k]));
    }
    template <bool positions, class Place>
    CATENA_HD MotionOf<RealAt<Place>> before_run(Place const& several) const {
        return as_motion(pick<MotionRecords::numbers>(
            before.origin, slot, several, Vector<RealAt<Place>, MotionRecords::numbers>{}));
    }
    /// Motion of the body on which body k of a branched chain hangs, relative to the ground.
    template <bool positions>
    CATENA_HD Motion of_inboard_body(std::int64_t k) const {
        if (joints.starts_chain(k)) return Motion::none();
        std::int64_t const i = joints.inboard[k];
        return {as_quaternion(motion.orientation.load(i)), motion.omega.load(i),
                positions ? motion.origin.load(i) : Vec3::zero(),
                positions ? motion.velocity.load(i) : Vec3::zero()};
    }
    /// Angular velocity of before_run().
    CATENA_HD Vec3 omega_before_run(std::int64_t k) const {
        if (joints.inboard)
            return joints.starts_chain(k) ? Vec3::zero() : motion.omega.load(joints.inboard[k]);
        std::int64_t const s = slot[k];
        return {{before.number(s, first_of_omega), before.number(s, first_of_omega + 1),
                 before.number(s, first_of_omega + 2)}};
    }
    template <class Place>
    CATENA_HD Vec3At<Place> omega_before_run(Place const& several) const {
        return pick<MotionRecords::numbers>(before.origin + first_of_omega, slot, several,
                                            Vec3At<Place>{});
    }
    /// Computes the motion of body k relative to the ground, and its handle 2 where that moves. In
    /// branched chains, the motion of the inboard body must be known.
    template <bool positions, class Place>
    CATENA_HD void set_motion(Place k) const {
        auto const own = load<positions>(k);
        // Loaded here so that on a GPU the load overlaps with that of the data of the branch below.
        auto const omega_before = omega_before_run(k);
        if (positions || !motion.orients_first_alone || joints.starts_chain(k)) {
            auto const m = compose<positions>(before_run<positions>(k), own);
            write(motion.orientation, k, as_vector(normalized(m.rotation)));
            write(motion.omega, k, joints.kept_in_plane(joints.normal(k), m.omega));
            if constexpr (positions) {
                write(motion.origin, k, m.translation);
                write(motion.velocity, k, m.velocity);
            }
        } else {
            write(motion.omega, k,
                  joints.kept_in_plane(joints.normal(k), compose(omega_before, own)));
        }
        if (motion.axes2.origin && !joints.inboard && !joints.ends_chain(k)) set_meeting(k);
    }

    /// Packs the meeting of this rank's first joint into entry 0 of next_meeting, for the inboard
    /// neighbour.
    CATENA_HD void show_first_meeting() const {
        Meeting const m = joints.meeting(state, std::int64_t{0});
        auto const axes = kept_axes(m.axes);
        Vector<double, 9> numbers;
        CATENA_UNROLL
        for (int i = 0; i < 9; ++i) numbers[i] = i < 3 ? m.point[i] : axes[i - 3];
        next_meeting.store(0, numbers);
    }
    /// Sets r2 and axes2 of a body from its outboard joint. After this rank's last body they come
    /// from the outboard neighbour.
    CATENA_HD void set_meeting(std::int64_t inboard_body) const {
        if (inboard_body + 1 < joints.size)
            return put_meeting(inboard_body, inboard_body, joints.meeting(state, inboard_body + 1));
        Vector<double, 9> const n = next_meeting.load(1);
        put_meeting(inboard_body, inboard_body,
                    {{{n[0], n[1], n[2]}},
                     axes_of(Vector<double, 6>{{n[3], n[4], n[5], n[6], n[7], n[8]}})});
    }
    template <class Place>
    CATENA_HD void set_meeting(Place const& inboard_bodies) const {
        put_meeting(inboard_bodies, inboard_bodies, joints.meeting(state, inboard_bodies + 1));
    }
    /// Stores a meeting at place `entry` of handles 2; r2 counts from the centre of mass of the
    /// inboard body.
    template <class Place>
    CATENA_HD void put_meeting(Place entry, Place inboard_body,
                               MeetingOf<RealAt<Place>> const& m) const {
        write(motion.r2, entry, m.point + read(joints.r1, inboard_body));
        write(motion.axes2, entry, kept_axes(m.axes));
    }
};

/// The scan's interface for a Space's tree passes (HostSpace::ScanTree): values of runs, their
/// composition, and storage by slot.
template <bool positions>
struct MotionScan {
    using Value = MotionNumbers<positions>;
    JointScan s;

    CATENA_HD Value of_run(dca::Run const& run) const {
        return packed<positions>(s.follow<positions>(run));
    }
    CATENA_HD Value joined(Value const& inboard, Value const& outboard) const {
        return packed<positions>(
            compose<positions>(unpacked<positions>(inboard), unpacked<positions>(outboard)));
    }
    CATENA_HD Value whole(std::int64_t slot) const { return numbers_at<positions>(s.whole, slot); }
    CATENA_HD void set_whole(std::int64_t slot, Value const& value) const {
        put_numbers<positions>(s.whole, slot, value);
    }
    CATENA_HD Value before(std::int64_t slot) const {
        return numbers_at<positions>(s.before, slot);
    }
    CATENA_HD void set_before(std::int64_t slot, Value const& value) const {
        put_numbers<positions>(s.before, slot, value);
    }
    CATENA_HD MotionScan const& motions() const { return *this; }
};

}  // namespace catena
