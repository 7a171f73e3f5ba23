// The joints between last bodies and the ground, for chains in joint coordinates: where they are, what their velocities add, and
// how far they have come open. Host and device.
#pragma once

#include <cmath>
#include <vector>

#include "chain/joint_kinematics.hpp"
#include "dca/solver.hpp"

namespace catena {

struct JointedTip {
    std::int64_t body = 0;
    JointType type = JointType::spherical;
    Vec3 axis, first_axis;
    Mat3 rotation;     // of J in the last body
    Vec3 translation;  // of J's origin from the last body's, B
    Mat3 axes;         // the joint's in the meeting frame, as ChainGroup::axes1
    Screw<double> screw;
    int restricted = 0;
    bool pitched = false;  // it slides as it turns
    Quat ground_rotation;  // of G in W
    Vec3 ground_origin;    // W
    Vec3 com;              // of the last body from its origin, B
    double cosine = 0;     // universal: of the angle between its axes
};
/// `start`: motion at the scene's start, positions included, which decides where the ground's frames are.
std::vector<JointedTip> jointed_tips(ChainGroup const&, BodyMotion& start);
/// A length that openings are measured by: the longest chain's from joint to joint and a body's size. The same on every rank.
double reach_of(ChainGroup const&, Scene const&);

/// Stores the first `directions` numbers of body k.
CATENA_HD void store_first(DirectionsView view, std::int64_t k, int directions, Vector<double, 6> const& v) {
    switch (directions) {
        case 2:
            return view.store<2>(k, {{v[0], v[1]}});
        case 3:
            return view.store<3>(k, {{v[0], v[1], v[2]}});
        case 4:
            return view.store<4>(k, {{v[0], v[1], v[2], v[3]}});
        case 5:
            return view.store<5>(k, {{v[0], v[1], v[2], v[3], v[4]}});
        default:
            return view.store<6>(k, v);
    }
}

/// The same, loaded; 0 beyond them.
template <int K>
CATENA_HD Vector<double, 6> with_zeros(Vector<double, K> const& v) {
    Vector<double, 6> all = Vector<double, 6>::zero();
    for (int i = 0; i < K; ++i) all[i] = v[i];
    return all;
}
CATENA_HD Vector<double, 6> load_first(ConstDirectionsView view, std::int64_t k, int directions) {
    switch (directions) {
        case 2:
            return with_zeros(view.load<2>(k));
        case 3:
            return with_zeros(view.load<3>(k));
        case 4:
            return with_zeros(view.load<4>(k));
        case 5:
            return with_zeros(view.load<5>(k));
        default:
            return view.load<6>(k);
    }
}

struct JointedTips {
    JointedTip const* tip = nullptr;
    double reach = 1;
    int directions = 6;
    MotionView motion;

    /// Where the joint meets the last body.
    struct Place {
        Vec3 point;  // from the centre of mass, B
        Mat3 axes;   // B
    };
    /// Angular and linear parts along a place's axes.
    struct Pair {
        Vec3 angular, linear;
    };

    CATENA_HD Quat orientation(JointedTip const& t) const { return as_quaternion(motion.orientation.load(t.body)); }
    CATENA_HD Place place(JointedTip const& t) const {
        Mat3 const to_ground = to_matrix(orientation(t));
        Place m{t.translation - t.com, t.rotation * t.axes};
        if (slides(t.type)) m.point = transposed_times(to_ground, t.ground_origin - motion.origin.load(t.body)) - t.com;
        if (t.type == JointType::universal) {
            Vec3 const first = t.rotation * t.first_axis;
            Vec3 const second = transposed_times(to_ground, to_matrix(t.ground_rotation) * t.axis);
            Vec3 const normal = cross(first, second), p = (1 / norm(normal)) * normal;
            m.axes.set_column(0, p);
            m.axes.set_column(1, cross(second, p));
            m.axes.set_column(2, second);
        }
        return m;
    }
    /// Handle 2 of the last body, where meetings move (MotionView::r2, axes2).
    CATENA_HD void set_meeting(std::int64_t i) const {
        Place const m = place(tip[i]);
        Vector<double, 9> axes;
        CATENA_UNROLL
        for (int j = 0; j < 9; ++j) axes[j] = m.axes.data[j];
        motion.r2.store(tip[i].body, m.point);
        motion.axes2.store(tip[i].body, axes);
    }

    /// Of G against the last body's point that it meets, on their way apart, along the place's axes.
    CATENA_HD Pair opening_rate(JointedTip const& t, Place const& m) const {
        Vec3 const w = motion.omega.load(t.body), v = motion.velocity.load(t.body) + cross(w, t.com + m.point);
        return {transposed_times(m.axes, -w), transposed_times(m.axes, -v)};
    }
    CATENA_HD static bool turns_about_axis(JointType type) { return type == JointType::revolute || slides(type); }
    /// c of the joint (formulas, "Joint bias") with the rates that the last body's motion gives it.
    CATENA_HD Pair velocity_terms(JointedTip const& t, Place const& m) const {
        Vec3 const w = transposed_times(m.axes, motion.omega.load(t.body));
        if (t.type == JointType::universal) {
            Vec3 const first = transposed_times(m.axes, t.rotation * t.first_axis);  // (0, y, z)
            Vec3 const u{{0, -w[1], -w[2]}};
            double const u1 = u[1] / first[1], u2 = u[2] - first[2] * u1;
            return {cross(w, u) + (u1 * u2) * cross(first, Vec3{{0, 0, 1}}), Vec3::zero()};
        }
        if (!turns_about_axis(t.type)) return {Vec3::zero(), Vec3::zero()};
        double const c = t.screw.c, s = t.screw.s;
        double const along = c * -w[2] + (s == 0 ? 0.0 : s * opening_rate(t, m).linear[2]);
        return {cross(w, Vec3{{0, 0, c * along}}), 2.0 * cross(w, Vec3{{0, 0, s * along}})};
    }
    /// Of G against J.
    CATENA_HD Pair opening(JointedTip const& t, Place const& m) const {
        double constexpr turn = 6.283185307179586476925;
        Vec3 const apart = transposed_times(to_matrix(orientation(t)), t.ground_origin - motion.origin.load(t.body)) - t.translation;
        Pair open{Vec3::zero(), transposed_times(m.axes, apart)};
        Quat const relative = conjugate(orientation(t) * to_quaternion(t.rotation)) * t.ground_rotation;  // G in J
        if (t.type == JointType::weld) open.angular = rotation_vector(relative);
        if (t.type == JointType::universal) {
            Vec3 const second = to_matrix(relative) * t.axis;
            open.angular[0] = -(dot(t.first_axis, second) - t.cosine) / norm(cross(t.first_axis, second));
        }
        if (turns_about_axis(t.type)) {
            open.angular = transposed_times(t.axes, cross(t.axis, to_matrix(relative) * t.axis));
            double turned = dot(rotation_vector(relative), t.axis);
            if (t.pitched) {  // whole turns as the slide says
                double const asked = open.linear[2] * t.screw.c / t.screw.s;
                turned += turn * std::round((asked - turned) / turn);
            }
            open.angular[2] = turned;
        }
        return open;
    }
    /// Along the directions of the joint's handles, in their order.
    CATENA_HD static Vector<double, 6> along_directions(JointedTip const& t, Pair const& pair) {
        double const c = t.screw.c, s = t.screw.s;
        return {{pair.linear[0], pair.linear[1], c * pair.linear[2] - s * pair.angular[2], pair.angular[0], pair.angular[1],
                 s * pair.linear[2] + c * pair.angular[2]}};
    }
    /// LoadsView::tip_bias for the accelerations: velocity terms, and gravity as the ground's acceleration.
    CATENA_HD void set_acceleration_bias(std::int64_t i, Vec3 const& gravity, DirectionsView out) const {
        JointedTip const& t = tip[i];
        Place const m = place(t);
        Pair terms = velocity_terms(t, m);
        terms.linear = -(terms.linear + transposed_times(m.axes, transposed_times(to_matrix(orientation(t)), gravity)));
        terms.angular = -terms.angular;
        store_first(out, t.body, directions, along_directions(t, terms));
    }
    /// The same for corrections: how far the joint is open, or how fast it comes open, along its directions.
    CATENA_HD void set_opening(std::int64_t i, bool velocities, DirectionsView out) const {
        JointedTip const& t = tip[i];
        Place const m = place(t);
        store_first(out, t.body, directions, along_directions(t, velocities ? opening_rate(t, m) : opening(t, m)));
    }
    /// Largest opening over the reach (angles count by it already).
    CATENA_HD double error(std::int64_t i) const {
        JointedTip const& t = tip[i];
        Vector<double, 6> const open = along_directions(t, opening(t, place(t)));
        double worst = 0;
        for (int j = 0; j < t.restricted; ++j) {
            double const e = std::fabs(open[j]) / (j < 3 ? reach : 1.0);
            worst = e > worst || e != e ? e : worst;
        }
        return worst;
    }
};

}  // namespace catena
