// Dynamics of one body of chains in joint coordinates: its loads and what these make of its
// velocities, for every Space.
#pragma once

#include "dynamics/joint/joint_loads.hpp"

namespace catena {

/// Time derivatives of StateView's velocities.
struct RatesView {
    View<3> qdd;  // second derivatives of q; spherical, free: derivative of the components of qd, B
    View<3> base_acceleration;  // one a piece: of a free base's origin, W
};

struct JointChains : JointLoads {
    ConstView<2> revolute_acceleration;  // AccelerationsView's, of `in_run`; absent: bodies'
                                         // accelerations are known

    /// Of body k along the axes of its outboard joint: angular acceleration; that of handle 2 along
    /// the last axis.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> outboard_end_of(Place k) const {
        auto const e2 = axes2(k);
        Vec3At<Place> const turning = read(alpha, k), along = transposed_times(e2, turning);
        RealAt<Place> slide(0);
        if (joints().has_screws) {
            Vec3At<Place> const w = omega(k), r = r2(k);
            slide = dot(e2.column(2),
                        read(acceleration, k) + cross(turning, r) + cross(w, cross(w, r)));
        }
        return {{along[0], along[1], along[2], slide}};
    }
    CATENA_HD Vector<double, 4> inboard_end_of(std::int64_t k) const {
        if (joints().is_first[k]) return Vector<double, 4>::zero();
        return k == 0 ? outboard_end.load(-1) : outboard_end_of(k - 1);
    }
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> inboard_end_of(Place const& several) const {
        return outboard_end_of(several - 1);
    }
    /// Second derivatives of joint k's coordinates. `relative_alpha`: outboard less inboard angular
    /// acceleration along the joint's axes. `relative_slide`: the same of the meeting points along
    /// the last axis.
    template <class Place>
    CATENA_HD Vec3At<Place> rate_of_joint(Place k, Vec3At<Place> const& relative_alpha,
                                          RealAt<Place> const& relative_slide) const {
        using Vector3 = Vec3At<Place>;
        RealAt<Place> const none(0);
        switch (joints().type(k)) {
            case JointType::universal: {
                auto const axes = joints().axes(k);
                Vector3 linear;
                Vector3 const relative =
                    relative_alpha - transposed_times(axes, joint_velocity_term(k, linear));
                Vector3 const first = transposed_times(
                    axes, read(joints().first_axis, k));  // (0, y, z); the second axis is (0, 0, 1)
                auto const u1 = relative[1] / first[1];
                return {{u1, relative[2] - first[2] * u1, none}};
            }
            case JointType::weld:
            case JointType::link:
                return Vector3::zero();
            default:
                if (!joints().has_screws) return {{relative_alpha[2], none, none}};
                auto const s = read(joints().screw, k);
                return {{(s[0] * relative_alpha[2] + s[1] * relative_slide) / s[2], none, none}};
        }
    }
    template <class Place>
    CATENA_HD bool goes_by_revolute(Place k) const {
        return revolute_acceleration.origin && in_run.has(k);
    }
    /// Precondition: goes_by_revolute().
    template <class Place>
    CATENA_HD RealAt<Place> rate_of_revolute(Place k) const {
        auto const own = read(revolute_acceleration, k, 0);
        if (!in_run.begins_run(k)) return own;
        if constexpr (is_one_body<Place>)
            if (k == 0) return own - outboard_end.at(-1, 2);
        return own - read(revolute_acceleration, k, 1);
    }
    /// Second derivatives of body k's coordinates.
    template <class Place>
    CATENA_HD Vec3At<Place> rate(Place k) const {
        using Vector3 = Vec3At<Place>;
        if constexpr (is_one_body<Place>)
            if (LocalDrive const* const d = drive_of(k))
                return {{scene::acceleration_at(d->first, time),
                         joints().joint[k] == JointType::universal
                             ? scene::acceleration_at(d->second, time)
                             : 0.0,
                         0}};
        if (goes_by_revolute(k)) return {{rate_of_revolute(k), RealAt<Place>(0), RealAt<Place>(0)}};
        Vector3 const turning = read(alpha, k);
        if (joints().type(k) == JointType::free) return turning;
        auto const axes1 = joints().axes(k), to_meeting = turn(k);
        auto const before = inboard_end_of(k);
        Vector3 const inboard{{before[0], before[1], before[2]}};
        if (joints().type(k) == JointType::spherical)
            return turning - transposed_times(to_meeting, axes1 * inboard) +
                   cross(read(scan.state.qd, k), omega(k));
        RealAt<Place> slide(0);
        if (joints().has_screws) {
            Vector3 const r = r1(k), w = omega(k),
                          axis = axes1.column(2);  // the axis is the same in B
            slide = dot(axis, read(acceleration, k) + cross(turning, r) + cross(w, cross(w, r))) -
                    before[3];
            if constexpr (is_one_body<Place>)
                if (joints().is_first[k])
                    slide = slide + dot(axis, transposed_times(orientation(k), given.gravity));
        }
        return rate_of_joint(k, transposed_times(axes1, to_meeting * turning) - inboard, slide);
    }
    /// Of the origin of body k on a free base.
    CATENA_HD Vec3 base_rate(std::int64_t k) const {
        Vec3 const w = omega(k), r = r1(k);
        return orientation(k) *
                   (acceleration.load(k) + cross(alpha.load(k), r) + cross(w, cross(w, r))) +
               given.gravity;
    }
    CATENA_HD bool on_free_base(std::int64_t k) const {
        return joints().joint[k] == JointType::free;
    }
    template <class Place>
    CATENA_HD void set_rates(Place k, RatesView const& out) const {
        if constexpr (is_one_body<Place>)
            if (joints().drives == 0 &&
                goes_by_revolute(k)) {  // whose other components are 0 and stay so
                out.qdd.at(k, 0) = rate_of_revolute(k);
                return;
            }
        write(out.qdd, k, rate(k));
        if constexpr (is_one_body<Place>)
            if (on_free_base(k)) out.base_acceleration.store(joints().piece_of(k), base_rate(k));
    }
};

}  // namespace catena
