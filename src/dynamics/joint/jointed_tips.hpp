// Joints between last bodies and the ground or, in rings, the first bodies, for chains in joint
// coordinates: geometry, velocity terms, and openings by drift. On host and device.
//
// J is the joint frame, fixed in the last body. G is the frame on the other side of the joint:
// fixed in the ground, or a ring's first body.
#pragma once

#include <cmath>
#include <vector>

#include "dca/solver.hpp"
#include "joints/joint_models.hpp"
#include "kinematics/joint_kinematics.hpp"
#include "math/with_number.hpp"

namespace catena {

/// A jointed tip with at least one of its two bodies on this rank.
struct JointedTip {
    std::int64_t body = -1;  // Last body, local; -1 if it is on another rank.
    bool ring = false;
    std::int64_t first = -1;  // First body of a ring, local; -1 if it is on another rank.
    /// Rank that holds the other end of a ring; -1 if this rank does.
    int neighbour = -1;
    JointType type = JointType::spherical;
    Vec3 axis, first_axis;
    Mat3 rotation;  // Rotation of J in the last body.
    /// Origin of J from the last body's origin, B.
    Vec3 translation;
    Mat3 axes;  // Axes of the joint in the meeting frame, as LocalBodies::axes1.
    Screw<double> screw;
    /// Number of restricted directions.
    int restricted = 0;
    /// Helical with a nonzero pitch: it slides as it rotates.
    bool pitched = false;
    Motion ground = Motion::none();  // Motion of G on the ground, at rest.
    Vec3 com;                        // Centre of mass of the last body from its origin, B.
    /// Cosine of the angle between the axes of a universal joint.
    double cosine = 0;
};
/// Returns the properties of a tip that do not depend on its bodies.
JointedTip tip_of(TipJoint const& joint, Mat3 const& axes, Vector<double, 4> const& screw,
                  int restricted);
/// Jointed tips of this rank's bodies: those of last bodies, in the order of LocalEnds::tips, then
/// those of rings that only begin here. `start` is the motion at the scene's start, positions
/// included, which fixes the frames G on the ground.
std::vector<JointedTip> jointed_tips(ChainGroup const&, Scene const&, BodyMotion& start);
/// Characteristic length that openings are divided by: contour length of the longest chain plus the
/// size of a body, nm. Returns the same value on every rank.
double reach_of(ChainGroup const&, Scene const&);

/// Stores the first `directions` of the six numbers for body k.
template <class Place>
CATENA_HD void store_first(DirectionsView view, Place k, int directions,
                           Vector<RealAt<Place>, 6> const& v) {
    with_number<2, 6>(directions, [&](auto count) {
        constexpr int K = decltype(count)::value;
        Vector<RealAt<Place>, K> first;
        for (int i = 0; i < K; ++i) first[i] = v[i];
        write_directions(view, k, first);
    });
}

/// Extends a vector to six numbers by zeros.
template <int K>
CATENA_HD Vector<double, 6> with_zeros(Vector<double, K> const& v) {
    Vector<double, 6> all = Vector<double, 6>::zero();
    for (int i = 0; i < K; ++i) all[i] = v[i];
    return all;
}
/// Loads `directions` numbers of body k and extends them by zeros.
CATENA_HD Vector<double, 6> load_first(ConstDirectionsView view, std::int64_t k, int directions) {
    return with_number<2, 6>(
        directions, [&](auto count) { return with_zeros(view.load<decltype(count)::value>(k)); });
}

/// Tips of a rank and the motions of their two sides, with the operations on one tip.
struct JointedTips {
    JointedTip const* tip = nullptr;
    double reach = 1;
    int directions = 6;
    MotionView motion;
    /// Motions of the last body and of what it is joined to, indexed by tip.
    View<13> last, other;

    /// Side of the joint on the last body.
    struct Place {
        Vec3 point;  // Meeting point from the centre of mass, B.
        Mat3 axes;   // Axes of the joint, B.
    };
    /// Angular and linear part of a motion along the axes of a Place.
    struct Pair {
        Vec3 angular, linear;
    };

    /// Copies the motions of those ends that are on this rank.
    CATENA_HD void take_ends(std::int64_t i) const {
        JointedTip const& t = tip[i];
        if (t.body >= 0) last.store(i, as_numbers(motion_of(t.body)));
        if (t.first >= 0) other.store(i, as_numbers(motion_of(t.first)));
    }
    /// Motion of body k relative to the ground.
    CATENA_HD Motion motion_of(std::int64_t k) const {
        return {as_quaternion(motion.orientation.load(k)), motion.omega.load(k),
                motion.origin.load(k), motion.velocity.load(k)};
    }
    /// Motions of the two sides: the last body, and G.
    struct Ends {
        Motion last, other;
        /// Components in the last body's axes of a vector given in G's axes.
        CATENA_HD Vec3 to_last(Vec3 const& v) const {
            return to_matrix(conjugate(last.rotation) * other.rotation) * v;
        }
        /// Origin of G from the last body's origin, in the last body's axes.
        CATENA_HD Vec3 apart() const {
            return transposed_times(to_matrix(last.rotation), other.translation - last.translation);
        }
    };
    CATENA_HD Ends ends(std::int64_t i) const {
        return {as_motion(last.load(i)), as_motion(other.load(i))};
    }

    /// Meeting point and axes of the joint in the last body, at the current motion.
    CATENA_HD static Place place(JointedTip const& t, Ends const& e) {
        Place m{t.translation - t.com, t.rotation * t.axes};
        if (slides(t.type)) m.point = e.apart() - t.com;
        if (turns_twice(t.type)) {
            Vec3 const first = t.rotation * t.first_axis, second = e.to_last(t.axis);
            Vec3 const normal = cross(first, second), p = (1 / norm(normal)) * normal;
            m.axes.set_column(0, p);
            m.axes.set_column(1, cross(second, p));
            m.axes.set_column(2, second);
        }
        return m;
    }
    /// Sets handle 2 of the last body if meeting frames move (MotionView::r2, axes2). In a ring,
    /// also sets the rotation of the first body in the meeting frame, whose axes are the joint's.
    CATENA_HD void set_meeting(std::int64_t i) const {
        JointedTip const& t = tip[i];
        Ends const e = ends(i);
        Place const m = place(t, e);
        if (t.first >= 0)
            motion.joint_turn.store(
                t.first,
                as_vector(conjugate(e.last.rotation * to_quaternion(m.axes)) * e.other.rotation));
        if (t.body < 0 || !motion.axes2.origin) return;
        motion.r2.store(t.body, m.point);
        motion.axes2.store(t.body, kept_axes(m.axes));
    }

    /// Velocity of G relative to the meeting point of the last body, along the axes of the Place.
    CATENA_HD static Pair opening_rate(JointedTip const& t, Ends const& e, Place const& m) {
        Vec3 const w = e.last.omega, v = e.last.velocity + cross(w, t.com + m.point);
        return {transposed_times(m.axes, e.to_last(e.other.omega) - w),
                transposed_times(m.axes, e.to_last(e.other.velocity) - v)};
    }
    /// Velocity-dependent part c of the joint's relative acceleration (src/dca/README.md, "Joint
    /// bias"), with the rates that follow from the bodies' motion.
    CATENA_HD static Pair velocity_terms(JointedTip const& t, Ends const& e, Place const& m) {
        Vec3 const w = transposed_times(m.axes, e.last.omega);
        if (!turns_twice(t.type) && !keeps_axis(t.type)) return {Vec3::zero(), Vec3::zero()};
        Pair const rate = opening_rate(t, e, m);
        if (turns_twice(t.type)) {
            // First axis: (0, y, z).
            Vec3 const first = transposed_times(m.axes, t.rotation * t.first_axis);
            Vec3 const u{{0, rate.angular[1], rate.angular[2]}};
            double const u1 = u[1] / first[1], u2 = u[2] - first[2] * u1;
            return {cross(w, u) + (u1 * u2) * cross(first, Vec3{{0, 0, 1}}), Vec3::zero()};
        }
        Pair const free = free_part(t, rate);
        return {cross(w, free.angular), 2.0 * cross(w, free.linear)};
    }
    /// Part of a relative motion that the joint leaves free.
    CATENA_HD static Pair free_part(JointedTip const& t, Pair const& motion) {
        Vector<double, 6> d = along_directions(t, motion);
        for (int i = 0; i < t.restricted; ++i) d[i] = 0;
        dca::AlongAxes<double> const free = dca::along_axes(t.screw, d);
        return {free.angular, free.linear};
    }
    /// Displacement of G relative to J, along the axes of the Place: the joint's closing error
    /// along its restricted directions.
    CATENA_HD static Pair opening(JointedTip const& t, Ends const& e, Place const& m) {
        double constexpr turn = 6.283185307179586476925;
        Pair open{Vec3::zero(), transposed_times(m.axes, e.apart() - t.translation)};
        // Rotation of G in J.
        Quat const relative =
            conjugate(e.last.rotation * to_quaternion(t.rotation)) * e.other.rotation;
        if (is_rigid(t.type)) open.angular = rotation_vector(relative);
        if (turns_twice(t.type)) {
            Vec3 const second = to_matrix(relative) * t.axis;
            open.angular[0] =
                -(dot(t.first_axis, second) - t.cosine) / norm(cross(t.first_axis, second));
        }
        if (keeps_axis(t.type)) {
            open.angular = transposed_times(t.axes, cross(t.axis, to_matrix(relative) * t.axis));
            double turned = dot(rotation_vector(relative), t.axis);
            // The number of whole revolutions follows from the sliding.
            if (t.pitched) {
                double const asked = open.linear[2] * t.screw.c / t.screw.s;
                turned += turn * std::round((asked - turned) / turn);
            }
            open.angular[2] = turned;
        }
        return open;
    }
    /// Components along the directions of the joint's handles, in their order.
    CATENA_HD static Vector<double, 6> along_directions(JointedTip const& t, Pair const& pair) {
        return dca::along_directions(t.screw, dca::AlongAxes<double>{pair.linear, pair.angular});
    }
    /// Sets LoadsView::tip_bias for accelerations: velocity terms, and gravity as an acceleration
    /// of the ground.
    CATENA_HD void set_acceleration_bias(std::int64_t i, Vec3 const& gravity,
                                         DirectionsView out) const {
        JointedTip const& t = tip[i];
        if (t.body < 0) return;
        Ends const e = ends(i);
        Place const m = place(t, e);
        Pair terms = velocity_terms(t, e, m);
        if (!t.ring)
            terms.linear =
                terms.linear +
                transposed_times(m.axes, transposed_times(to_matrix(e.last.rotation), gravity));
        store_first(out, t.body, directions, along_directions(t, {-terms.angular, -terms.linear}));
    }
    /// Sets LoadsView::tip_bias for a correction: the opening along the joint's directions or, if
    /// `velocities`, its rate.
    CATENA_HD void set_opening(std::int64_t i, bool velocities, DirectionsView out) const {
        JointedTip const& t = tip[i];
        if (t.body < 0) return;
        Ends const e = ends(i);
        Place const m = place(t, e);
        store_first(out, t.body, directions,
                    along_directions(t, velocities ? opening_rate(t, e, m) : opening(t, e, m)));
    }
    /// Sets LoadsView::tip_bias to zero.
    CATENA_HD void set_no_bias(std::int64_t i, DirectionsView out) const {
        if (tip[i].body >= 0) store_first(out, tip[i].body, directions, Vector<double, 6>::zero());
    }
    /// Largest opening along a restricted direction; lengths are divided by the reach, angles are
    /// in rad.
    CATENA_HD double error(std::int64_t i) const {
        JointedTip const& t = tip[i];
        if (t.body < 0) return 0;
        Ends const e = ends(i);
        return largest_opening(t, e, place(t, e), reach);
    }
    CATENA_HD static double largest_opening(JointedTip const& t, Ends const& e, Place const& m,
                                            double reach) {
        Vector<double, 6> const open = along_directions(t, opening(t, e, m));
        double worst = 0;
        for (int j = 0; j < t.restricted; ++j) {
            bool const linear = direction_at(static_cast<int>(t.screw.order), j) < 3;
            double const along = std::fabs(open[j]) / (linear ? reach : 1.0);
            worst = along > worst || along != along ? along : worst;
        }
        return worst;
    }
};

}  // namespace catena
