// The scan over the canonical tree that gives every body its motion against the ground, item by
// item, host and device.
//
// Bodies against the body before their run; runs and pairs of segments as wholes, up the tree; what
// lies before each segment, down the tree; bodies against the ground. Motions are those of a
// segment's last body.
#pragma once

#include "kinematics/joint_motion.hpp"
#include "math/records.hpp"
#include "tree/tree.hpp"

namespace catena {

using MotionRecords = dca::RecordsView<Motion, dca::Order::plain>;
constexpr int first_of_omega = 4;  // among a motion's numbers
/// Of a motion what is not zero.
template <bool positions>
constexpr int numbers_of_motion = positions ? 13 : 7;
template <bool positions>
using MotionNumbers = Vector<double, numbers_of_motion<positions>>;
template <bool positions>
CATENA_HD MotionNumbers<positions> packed(Motion const& m) {
    auto const all = as_numbers(m);
    MotionNumbers<positions> numbers;
    CATENA_UNROLL
    for (int i = 0; i < numbers_of_motion<positions>; ++i) numbers[i] = all[i];
    return numbers;
}
template <bool positions>
CATENA_HD Motion unpacked(MotionNumbers<positions> const& numbers) {
    auto all = Vector<double, 13>::zero();
    CATENA_UNROLL
    for (int i = 0; i < numbers_of_motion<positions>; ++i) all[i] = numbers[i];
    return as_motion(all);
}
template <bool positions>
CATENA_HD MotionNumbers<positions> numbers_at(MotionRecords const& records, std::int64_t slot) {
    MotionNumbers<positions> numbers;
    CATENA_UNROLL
    for (int i = 0; i < numbers_of_motion<positions>; ++i) numbers[i] = records.number(slot, i);
    return numbers;
}
template <bool positions>
CATENA_HD void put_numbers(MotionRecords const& records, std::int64_t slot, MotionNumbers<positions> const& numbers) {
    CATENA_UNROLL
    for (int i = 0; i < numbers_of_motion<positions>; ++i) records.number(slot, i) = numbers[i];
}

struct JointScan {
    JointsView joints;
    StateView state;
    MotionView motion;
    View<4> rotation;  // of body k against its inboard body, then against the body before its run
    View<3> omega, translation, velocity;
    std::int32_t const* slot = nullptr;  // of the run of body k
    MotionRecords whole;                  // by slot: against the body before the segment
    MotionRecords before;                 // by slot: of the body before the segment, against the ground
    View<9> next_meeting;                // {point, axes}: entry 1 of the joint after this rank's last body

    template <bool positions, class Place>
    CATENA_HD MotionOf<RealAt<Place>> load(Place k) const {
        using Vector3 = Vec3At<Place>;
        MotionOf<RealAt<Place>> m{as_quaternion(read(rotation, k)), read(omega, k), Vector3::zero(), Vector3::zero()};
        if constexpr (positions) {
            m.translation = read(translation, k);
            m.velocity = read(velocity, k);
        }
        return m;
    }
    template <bool positions, class Place>
    CATENA_HD void store(Place k, MotionOf<RealAt<Place>> const& m) const {
        write(rotation, k, as_vector(m.rotation));
        write(omega, k, m.omega);
        if constexpr (positions) {
            write(translation, k, m.translation);
            write(velocity, k, m.velocity);
        }
    }
    template <bool positions, class Place>
    CATENA_HD void set_relative(Place k) const {
        QuatAt<Place> const turn = joints.turn_of(state, k);
        write(motion.joint_turn, k, as_vector(turn));
        store<positions>(k, joints.motion(state, k, turn));
    }
    /// A few bodies at a time, so that their loads are under way together.
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
    template <bool positions>
    CATENA_HD Motion go_on(Motion const& before_it, Motion const& next, Vec3 const& normal, std::int64_t k) const {
        Motion m = compose<positions>(before_it, next);
        m.omega = joints.kept_in_plane(normal, m.omega);
        store<positions>(k, m);
        return m;
    }
    /// Of the body before the run of body k, against the ground.
    template <bool positions>
    CATENA_HD Motion before_run(std::int64_t k) const {
        return unpacked<positions>(numbers_at<positions>(before, slot[k]));
    }
    template <bool positions, class Place>
    CATENA_HD MotionOf<RealAt<Place>> before_run(Place const& several) const {
        return as_motion(pick<MotionRecords::numbers>(before.origin, slot, several, Vector<RealAt<Place>, MotionRecords::numbers>{}));
    }
    /// Its angular velocity.
    CATENA_HD Vec3 omega_before_run(std::int64_t k) const {
        std::int64_t const s = slot[k];
        return {{before.number(s, first_of_omega), before.number(s, first_of_omega + 1), before.number(s, first_of_omega + 2)}};
    }
    template <class Place>
    CATENA_HD Vec3At<Place> omega_before_run(Place const& several) const {
        return pick<MotionRecords::numbers>(before.origin + first_of_omega, slot, several, Vec3At<Place>{});
    }
    template <bool positions, class Place>
    CATENA_HD void set_motion(Place k) const {
        auto const own = load<positions>(k);
        auto const omega_before = omega_before_run(k);  // a GPU reads it while it waits for what decides
        if (positions || !motion.orients_first_alone || joints.starts_chain(k)) {
            auto const m = compose<positions>(before_run<positions>(k), own);
            write(motion.orientation, k, as_vector(normalized(m.rotation)));
            write(motion.omega, k, joints.kept_in_plane(joints.normal(k), m.omega));
            if constexpr (positions) {
                write(motion.origin, k, m.translation);
                write(motion.velocity, k, m.velocity);
            }
        } else {
            write(motion.omega, k, joints.kept_in_plane(joints.normal(k), compose(omega_before, own)));
        }
        if (motion.axes2.origin && !joints.ends_chain(k)) set_meeting(k);
    }

    CATENA_HD void show_first_meeting() const {
        Meeting const m = joints.meeting(state, std::int64_t{0});
        auto const axes = kept_axes(m.axes);
        Vector<double, 9> numbers;
        CATENA_UNROLL
        for (int i = 0; i < 9; ++i) numbers[i] = i < 3 ? m.point[i] : axes[i - 3];
        next_meeting.store(0, numbers);
    }
    CATENA_HD void set_meeting(std::int64_t inboard_body) const {
        if (inboard_body + 1 < joints.size) return put_meeting(inboard_body, joints.meeting(state, inboard_body + 1));
        Vector<double, 9> const n = next_meeting.load(1);
        put_meeting(inboard_body, {{{n[0], n[1], n[2]}}, axes_of(Vector<double, 6>{{n[3], n[4], n[5], n[6], n[7], n[8]}})});
    }
    template <class Place>
    CATENA_HD void set_meeting(Place const& inboard_bodies) const {
        put_meeting(inboard_bodies, joints.meeting(state, inboard_bodies + 1));
    }
    template <class Place>
    CATENA_HD void put_meeting(Place inboard_body, MeetingOf<RealAt<Place>> const& m) const {
        write(motion.r2, inboard_body, m.point + read(joints.r1, inboard_body));
        write(motion.axes2, inboard_body, kept_axes(m.axes));
    }
};

/// As a space's scans want it (HostSpace::ScanTree).
template <bool positions>
struct MotionScan {
    using Value = MotionNumbers<positions>;
    JointScan s;

    CATENA_HD Value of_run(dca::Run const& run) const { return packed<positions>(s.follow<positions>(run)); }
    CATENA_HD Value joined(Value const& inboard, Value const& outboard) const {
        return packed<positions>(compose<positions>(unpacked<positions>(inboard), unpacked<positions>(outboard)));
    }
    CATENA_HD Value whole(std::int64_t slot) const { return numbers_at<positions>(s.whole, slot); }
    CATENA_HD void set_whole(std::int64_t slot, Value const& value) const { put_numbers<positions>(s.whole, slot, value); }
    CATENA_HD Value before(std::int64_t slot) const { return numbers_at<positions>(s.before, slot); }
    CATENA_HD void set_before(std::int64_t slot, Value const& value) const { put_numbers<positions>(s.before, slot, value); }
    CATENA_HD MotionScan const& motions() const { return *this; }
};

}  // namespace catena
