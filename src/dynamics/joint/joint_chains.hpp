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
    /// Accelerations of bodies, B, relative to a frame that falls with gravity.
    View<3> alpha, acceleration;
    /// Value of outboard_end_of() by body. Entry -1 is that of the body before this rank's first
    /// one.
    View<4> outboard_end;
    /// AccelerationsView::revolute_acceleration for the joints of `in_run`. Without origin, the
    /// accelerations of all bodies are known.
    ConstView<2> revolute_acceleration;

    /// Acceleration of the point of body k at `r` from its centre of mass, B.
    template <class Place>
    CATENA_HD Vec3At<Place> acceleration_at(Place k, Vec3At<Place> const& r) const {
        Vec3At<Place> const w = moved.omega(k);
        return read(acceleration, k) + cross(read(alpha, k), r) + cross(w, cross(w, r));
    }
    /// Acceleration of the outboard end of body k along the axes of its outboard joint. Components
    /// 0-2 are the angular acceleration, component 3 is that of handle 2 along the last axis. If
    /// the joint glides, components 0-1 are those of handle 2 too.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> outboard_end_of(Place k) const {
        return end_of(k, k, k + 1);
    }
    /// Value of outboard_end_of() for any body, with the place of its handle and the joint there.
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> end_of(Place k, Place handle_of, Place joint) const {
        auto const e2 = moved.axes2(handle_of);
        Vec3At<Place> along = transposed_times(e2, read(alpha, k));
        RealAt<Place> slide(0);
        if (moved.joints().has_screws) {
            Vec3At<Place> const handle = acceleration_at(k, moved.r2(handle_of));
            slide = dot(e2.column(2), handle);
            if (moved.joints().glides(joint))
                for (int i = 0; i < 2; ++i) along[i] = dot(e2.column(i), handle);
        }
        return {{along[0], along[1], along[2], slide}};
    }
    /// Acceleration of the inboard side of joint k; zero on the ground.
    CATENA_HD Vector<double, 4> inboard_end_of(std::int64_t k) const {
        if (moved.joints().is_first[k]) return Vector<double, 4>::zero();
        if (moved.joints().inboard) return end_of(moved.joints().inboard[k], k, k);
        return k == 0 ? outboard_end.load(-1) : outboard_end_of(k - 1);
    }
    template <class Place>
    CATENA_HD Vector<RealAt<Place>, 4> inboard_end_of(Place const& several) const {
        return outboard_end_of(several - 1);
    }
    /// Second derivatives of joint k's coordinates. `relative_alpha` is the outboard minus the
    /// inboard angular acceleration along the joint's axes; if the joint glides, its first two
    /// components are the acceleration of the meeting points. `relative_slide` is that of the
    /// meeting points along the last axis.
    template <class Place>
    CATENA_HD Vec3At<Place> rate_of_joint(Place k, Vec3At<Place> const& relative_alpha,
                                          RealAt<Place> const& relative_slide) const {
        auto const drift = [&] {
            JointRate<RealAt<Place>> term;
            term.angular = moved.velocity_term(k, term.linear);
            return term;
        };
        return with_axis_motion(moved.joints().type(k), [&](auto motion) {
            return motion.acceleration(moved.joint_at(k), relative_alpha, relative_slide, drift);
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
            if (LocalDrive const* const d = moved.drive_of(k))
                return {{scene::acceleration_at(d->first, moved.time),
                         has_two_coordinates(moved.joints().joint[k])
                             ? scene::acceleration_at(d->second, moved.time)
                             : 0.0,
                         0}};
        if (goes_by_revolute(k)) return {{rate_of_revolute(k), RealAt<Place>(0), RealAt<Place>(0)}};
        Vector3 const turning = read(alpha, k);
        if (floats(moved.joints().type(k))) return turning;
        auto const axes1 = moved.joints().axes(k), to_meeting = moved.rotation(k);
        auto const before = inboard_end_of(k);
        Vector3 const inboard{{before[0], before[1], before[2]}};
        if (is_ball(moved.joints().type(k)))
            return turning - transposed_times(to_meeting, axes1 * inboard) +
                   cross(read(moved.scan.state.qd, k), moved.omega(k));
        Vector3 relative = transposed_times(axes1, to_meeting * turning) - inboard;
        RealAt<Place> slide(0);
        if (moved.joints().has_screws) {
            Vector3 const axis = axes1.column(2);  // The axis has the same components in B.
            Vector3 const handle = acceleration_at(k, moved.r1(k));
            slide = dot(axis, handle) - before[3];
            if constexpr (is_one_body<Place>)
                if (moved.joints().is_first[k])
                    slide =
                        slide + dot(axis, transposed_times(moved.orientation(k), given.gravity));
            if (moved.joints().glides(k))
                set_gliding(k, transposed_times(axes1, to_meeting * handle) - inboard, relative);
        }
        return rate_of_joint(k, relative, slide);
    }
    /// Sets the first two components of the relative acceleration of a joint that glides, whose
    /// `handles` accelerate relative to each other along its axes.
    template <class Place>
    CATENA_HD void set_gliding(Place k, Vec3At<Place> const& handles,
                               Vec3At<Place>& relative) const {
        for (int i = 0; i < 2; ++i) relative[i] = handles[i];
        if constexpr (is_one_body<Place>)
            if (moved.joints().is_first[k]) {
                Vec3 const falling = transposed_times(
                    moved.joints().axes(k),
                    moved.rotation(k) * transposed_times(moved.orientation(k), given.gravity));
                for (int i = 0; i < 2; ++i) relative[i] += falling[i];
            }
    }
    /// Acceleration of the origin of body k on a free base, W.
    CATENA_HD Vec3 base_rate(std::int64_t k) const {
        return moved.orientation(k) * acceleration_at(k, moved.r1(k)) + given.gravity;
    }
    /// True if body k is the base of a free chain.
    CATENA_HD bool on_free_base(std::int64_t k) const { return floats(moved.joints().joint[k]); }
    /// Stores the rates of body k, and of its base if that is free.
    template <class Place>
    CATENA_HD void set_rates(Place k, RatesView const& out) const {
        // The other components are 0 and never change.
        if constexpr (is_one_body<Place>)
            if (moved.joints().drives == 0 && goes_by_revolute(k)) {
                out.qdd.at(k, 0) = rate_of_revolute(k);
                return;
            }
        write(out.qdd, k, rate(k));
        if constexpr (is_one_body<Place>)
            if (on_free_base(k))
                out.base_acceleration.store(moved.joints().piece_of(k), base_rate(k));
    }
};

}  // namespace catena
