// Bodies in joint coordinates with their motion, in any Space, as loads and rates read them.
// Frames: W ground axes, B body axes, J joint frame, M meeting frame. The axes of a joint are the
// columns of LocalBodies::axes1 in M.
#pragma once

#include "joints/joint_models.hpp"
#include "kinematics/joint_scan.hpp"

namespace catena {

/// Bodies at a state: their joints and motion, with the geometry and the velocity terms that follow
/// from these.
struct MovedBodies {
    JointScan scan;
    /// Handle 2 of bodies where it does not move (GroupView::r2, axes2). In branched chains, entry
    /// k is the handle of the inboard body of body k at the joint between them, as in MotionView.
    ConstView<3> fixed_r2;
    ConstView<6> fixed_axes2;
    double time = 0;  // Time of the state, ps.

    CATENA_HD JointsView const& joints() const { return scan.joints; }
    /// Inboard joint of the bodies at a place, for the motions of joints.
    template <class Place>
    CATENA_HD JointAt<Place> joint_at(Place k) const {
        return {scan.joints, scan.state, k};
    }
    // Members below take a place k: one body, or several consecutive bodies side by side
    // (dca/lane_access.hpp, JointsView::type).
    /// Rotation of B in M.
    template <class Place>
    CATENA_HD Mat3At<Place> rotation(Place k) const {
        return to_matrix(as_quaternion(read(scan.motion.joint_turn, k)));
    }
    /// Rotation of B in W.
    template <class Place>
    CATENA_HD Mat3At<Place> orientation(Place k) const {
        return to_matrix(as_quaternion(read(scan.motion.orientation, k)));
    }
    /// Angular velocity of body k, B.
    template <class Place>
    CATENA_HD Vec3At<Place> omega(Place k) const {
        return read(scan.motion.omega, k);
    }
    /// Velocity of the inboard end of body k, B.
    template <class Place>
    CATENA_HD Vec3At<Place> velocity(Place k) const {
        return read(scan.motion.velocity, k);
    }
    /// Handle 1 of body k from its centre of mass, B.
    template <class Place>
    CATENA_HD Vec3At<Place> r1(Place k) const {
        return read(joints().r1, k);
    }
    /// Axes of the outboard joint of body k, B; or entry k as described above.
    template <class Place>
    CATENA_HD Mat3At<Place> axes2(Place k) const {
        return axes_of(scan.motion.axes2.origin ? read(scan.motion.axes2, k)
                                                : read(fixed_axes2, k));
    }
    /// Handle 2 of body k from its centre of mass, B; or entry k as described above.
    template <class Place>
    CATENA_HD Vec3At<Place> r2(Place k) const {
        return scan.motion.r2.origin ? read(scan.motion.r2, k) : read(fixed_r2, k);
    }
    /// Prescribed motion of joint k; null if it has none. Joints of several bodies side by side
    /// have none.
    CATENA_HD LocalDrive const* drive_of(std::int64_t k) const {
        return joints().drives > 0 ? joints().drive_of(k) : nullptr;
    }
    template <dca::SeveralBodies Place>
    CATENA_HD LocalDrive const* drive_of(Place const&) const {
        return nullptr;
    }

    /// Velocity-dependent part c of joint k's relative acceleration, including prescribed
    /// accelerations; M (src/dca/README.md, "Joint bias"). Returns the angular part and sets
    /// `linear`.
    template <class Place>
    CATENA_HD Vec3At<Place> velocity_term(Place k, Vec3At<Place>& linear) const {
        using Real = RealAt<Place>;
        using Vector3 = Vec3At<Place>;
        Vector3 const w = rotation(k) * omega(k);
        auto const rate = joints().rate(scan.state, k);
        // The inboard or the outboard body's angular velocity: both give the same product.
        Vector3 angular = cross(w, rate.angular);
        linear = Real(2) * cross(w - rate.angular, rate.linear);
        auto const type = joints().type(k);
        angular =
            with_motion(type, [&](auto motion) { return motion.with_drift(joint_at(k), angular); });
        if constexpr (is_one_body<Place>)
            if (LocalDrive const* const drive = drive_of(k)) {
                Vec3 const qdd{{scene::acceleration_at(drive->first, time),
                                scene::acceleration_at(drive->second, time), 0}};
                return with_motion(type, [&](auto motion) {
                    return motion.with_prescribed(joint_at(k), qdd, angular, linear);
                });
            }
        return angular;
    }
    /// Columns of P of joint k: motion along the last three directions of its handles per unit rate
    /// of each coordinate. Returns the number of coordinates.
    CATENA_HD int free_motions(std::int64_t k, Mat3& motions) const {
        motions = Mat3::zero();
        return with_motion(joints().joint[k], [&](auto motion) {
            return motion.free_motions(joint_at(k), [&] { return rotation(k); }, motions);
        });
    }
};

}  // namespace catena
