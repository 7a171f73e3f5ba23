// Dynamics of one body of chains in joint coordinates, in any Space: its loads (JointLoads), and
// the rates that follow from its acceleration.
#pragma once

#include "dynamics/joint/joint_loads.hpp"
#include "joints/joint_models.hpp"

namespace catena {

/// Time derivatives of the velocities of StateView.
struct RatesView {
    /// Second derivatives of q. For spherical and free joints: derivatives of the components of qd,
    /// B.
    View<3> qdd;
    /// Acceleration of a free base's origin by piece, W.
    View<3> base_acceleration;
};

/// Loads and solution of bodies, with the operations that turn accelerations into rates.
struct JointChains : JointLoads {
    /// AccelerationsView::revolute_acceleration for the joints of `in_run`. Without origin, the
    /// accelerations of all bodies are known.
    ConstView<2> revolute_acceleration;

    /// Acceleration of the outboard end of body k along the axes of its outboard joint. Components
    /// 0-2 are the angular acceleration, component 3 is that of handle 2 along the last axis.
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
    /// Acceleration of the inboard side of joint k; zero on the ground.
    CATENA_HD Vector<double, 4> inboard_end_of(std::int64_t k) const {
        if (joints().is_first[k]) return Vector<double, 4>::zero();
        return k == 0 ? outboard_end.load(-1) : outboard_end_of(k - 1);
    }
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> inboard_end_of(Place const& several) const {
        return outboard_end_of(several - 1);
    }
    /// Second derivatives of joint k's coordinates. `relative_alpha` is the outboard minus the
    /// inboard angular acceleration along the joint's axes. `relative_slide` is that of the meeting
    /// points along the last axis.
    template <class Place>
    CATENA_HD Vec3At<Place> rate_of_joint(Place k, Vec3At<Place> const& relative_alpha,
                                          RealAt<Place> const& relative_slide) const {
        auto const drift = [&] {
            Vec3At<Place> linear;
            return joint_velocity_term(k, linear);
        };
        return with_axis_motion(joints().type(k), [&](auto motion) {
            return motion.acceleration(joint_at(k), relative_alpha, relative_slide, drift);
        });
    }
    /// True if the solver returned the acceleration of joint k itself.
    template <class Place>
    CATENA_HD bool goes_by_revolute(Place k) const {
        return revolute_acceleration.origin && in_run.has(k);
    }
    /// Second derivative of a revolute joint's angle. Precondition: goes_by_revolute().
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
                         has_two_axes(joints().joint[k]) ? scene::acceleration_at(d->second, time)
                                                         : 0.0,
                         0}};
        if (goes_by_revolute(k)) return {{rate_of_revolute(k), RealAt<Place>(0), RealAt<Place>(0)}};
        Vector3 const turning = read(alpha, k);
        if (floats(joints().type(k))) return turning;
        auto const axes1 = joints().axes(k), to_meeting = rotation(k);
        auto const before = inboard_end_of(k);
        Vector3 const inboard{{before[0], before[1], before[2]}};
        if (is_ball(joints().type(k)))
            return turning - transposed_times(to_meeting, axes1 * inboard) +
                   cross(read(scan.state.qd, k), omega(k));
        RealAt<Place> slide(0);
        if (joints().has_screws) {
            Vector3 const r = r1(k), w = omega(k),
                          axis = axes1.column(2);  // The axis has the same components in B.
            slide = dot(axis, read(acceleration, k) + cross(turning, r) + cross(w, cross(w, r))) -
                    before[3];
            if constexpr (is_one_body<Place>)
                if (joints().is_first[k])
                    slide = slide + dot(axis, transposed_times(orientation(k), given.gravity));
        }
        return rate_of_joint(k, transposed_times(axes1, to_meeting * turning) - inboard, slide);
    }
    /// Acceleration of the origin of body k on a free base, W.
    CATENA_HD Vec3 base_rate(std::int64_t k) const {
        Vec3 const w = omega(k), r = r1(k);
        return orientation(k) *
                   (acceleration.load(k) + cross(alpha.load(k), r) + cross(w, cross(w, r))) +
               given.gravity;
    }
    /// True if body k is the base of a free chain.
    CATENA_HD bool on_free_base(std::int64_t k) const { return floats(joints().joint[k]); }
    /// Stores the rates of body k, and of its base if that is free.
    template <class Place>
    CATENA_HD void set_rates(Place k, RatesView const& out) const {
        // The other components are 0 and never change.
        if constexpr (is_one_body<Place>)
            if (joints().drives == 0 && goes_by_revolute(k)) {
                out.qdd.at(k, 0) = rate_of_revolute(k);
                return;
            }
        write(out.qdd, k, rate(k));
        if constexpr (is_one_body<Place>)
            if (on_free_base(k)) out.base_acceleration.store(joints().piece_of(k), base_rate(k));
    }
};

}  // namespace catena
