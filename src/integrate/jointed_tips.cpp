#include "integrate/jointed_tips.hpp"

#include <cmath>
#include <numbers>

#include "scene/pose.hpp"

namespace catena {
namespace {

bool turns_about_axis(JointType type) { return type == JointType::revolute || slides(type); }

}  // namespace

JointedTips::JointedTips(ChainGroup const& group, BodyMotion const& start, double reach) : group_(group), reach_(reach) {
    for (LocalTip const& local : group.tips) {
        TipJoint const& joint = local.joint;
        Quat const orientation = as_quaternion(start.orientation[local.body]);
        Mat3 const body = to_matrix(orientation);
        scene::Pose const motion = scene::joint_motion(joint.type, joint.axis, joint.first_axis, joint.pitch, joint.q);  // of G in J
        Tip tip{&local, orientation * to_quaternion(joint.rotation) * normalized(motion.orientation),
                start.origin[local.body] + body * (joint.translation + joint.rotation * motion.origin), -group.r1[local.body],
                dot(joint.first_axis, joint.axis)};
        tips_.push_back(tip);
    }
}

JointedTips::Meeting JointedTips::meeting(Tip const& tip, BodyMotion const& motion) const {
    TipJoint const& joint = tip.local->joint;
    std::int64_t const k = tip.local->body;
    Mat3 const to_ground = to_matrix(as_quaternion(motion.orientation[k]));
    Meeting m{joint.translation - tip.com, joint.rotation * tip.local->axes};
    if (slides(joint.type)) m.point = transposed_times(to_ground, tip.ground_origin - motion.origin[k]) - tip.com;
    if (joint.type == JointType::universal) {
        Vec3 const first = joint.rotation * joint.first_axis;
        Vec3 const second = transposed_times(to_ground, to_matrix(tip.ground_rotation) * joint.axis);
        Vec3 const normal = cross(first, second), p = (1 / norm(normal)) * normal;
        m.axes.set_column(0, p);
        m.axes.set_column(1, cross(second, p));
        m.axes.set_column(2, second);
    }
    return m;
}

void JointedTips::set_meetings(BodyMotion& motion) const {
    for (Tip const& tip : tips_) {
        Meeting const m = meeting(tip, motion);
        Vector<double, 9> axes;
        for (int i = 0; i < 9; ++i) axes[i] = m.axes.data[i];
        motion.r2.set(tip.local->body, m.point);
        motion.axes2.set(tip.local->body, axes);
    }
}

/// Of G against the last body's point that it meets, on their way apart, along the meeting's axes.
JointedTips::Pair JointedTips::opening_rate(Tip const& tip, Meeting const& m, BodyMotion const& motion) const {
    std::int64_t const k = tip.local->body;
    Vec3 const w = motion.omega[k], v = motion.velocity[k] + cross(w, tip.com + m.point);
    return {transposed_times(m.axes, -w), transposed_times(m.axes, -v)};
}

/// c of the joint (formulas, "Joint bias") with the rates that the last body's motion gives it.
JointedTips::Pair JointedTips::velocity_terms(Tip const& tip, Meeting const& m, BodyMotion const& motion) const {
    TipJoint const& joint = tip.local->joint;
    Vec3 const w = transposed_times(m.axes, motion.omega[tip.local->body]);
    if (joint.type == JointType::universal) {
        Vec3 const first = transposed_times(m.axes, joint.rotation * joint.first_axis);  // (0, y, z)
        Vec3 const u{{0, -w[1], -w[2]}};
        double const u1 = u[1] / first[1], u2 = u[2] - first[2] * u1;
        return {cross(w, u) + (u1 * u2) * cross(first, Vec3{{0, 0, 1}}), Vec3::zero()};
    }
    if (!turns_about_axis(joint.type)) return {Vec3::zero(), Vec3::zero()};
    double const c = tip.local->screw[0], s = tip.local->screw[1];
    double const along = c * -w[2] + (s == 0 ? 0.0 : s * opening_rate(tip, m, motion).linear[2]);
    return {cross(w, Vec3{{0, 0, c * along}}), 2.0 * cross(w, Vec3{{0, 0, s * along}})};
}

/// Of G against J.
JointedTips::Pair JointedTips::opening(Tip const& tip, Meeting const& m, BodyMotion const& motion) const {
    TipJoint const& joint = tip.local->joint;
    std::int64_t const k = tip.local->body;
    Quat const orientation = as_quaternion(motion.orientation[k]);
    Vec3 const apart = transposed_times(to_matrix(orientation), tip.ground_origin - motion.origin[k]) - joint.translation;
    Pair open{Vec3::zero(), transposed_times(m.axes, apart)};
    Quat const relative = conjugate(orientation * to_quaternion(joint.rotation)) * tip.ground_rotation;  // G in J
    if (joint.type == JointType::weld) open.angular = rotation_vector(relative);
    if (joint.type == JointType::universal) {
        Vec3 const second = to_matrix(relative) * joint.axis;
        open.angular[0] = -(dot(joint.first_axis, second) - tip.cosine) / norm(cross(joint.first_axis, second));
    }
    if (turns_about_axis(joint.type)) {
        open.angular = transposed_times(tip.local->axes, cross(joint.axis, to_matrix(relative) * joint.axis));
        double turn = dot(rotation_vector(relative), joint.axis);
        if (joint.type == JointType::helical && joint.pitch != 0) {  // whole turns as the slide says
            double const asked = open.linear[2] * tip.local->screw[0] / tip.local->screw[1];
            turn += 2 * std::numbers::pi * std::round((asked - turn) / (2 * std::numbers::pi));
        }
        open.angular[2] = turn;
    }
    return open;
}

/// Along the directions of the joint's handles, in their order.
Vector<double, 6> JointedTips::along_directions(Tip const& tip, Pair const& pair) const {
    double const c = tip.local->screw[0], s = tip.local->screw[1];
    return {{pair.linear[0], pair.linear[1], c * pair.linear[2] - s * pair.angular[2], pair.angular[0], pair.angular[1],
             s * pair.linear[2] + c * pair.angular[2]}};
}

void JointedTips::store(DirectionsView view, std::int64_t body, Vector<double, 6> const& values) const {
    for (int i = 0; i < group_.directions; ++i) view.origin[i * view.pitch + body] = values[i];
}

void JointedTips::set_acceleration_bias(BodyMotion const& motion, Vec3 const& gravity, DirectionsView out) const {
    for (Tip const& tip : tips_) {
        Meeting const m = meeting(tip, motion);
        Pair terms = velocity_terms(tip, m, motion);
        Mat3 const to_ground = to_matrix(as_quaternion(motion.orientation[tip.local->body]));
        terms.linear = -(terms.linear + transposed_times(m.axes, transposed_times(to_ground, gravity)));
        terms.angular = -terms.angular;
        store(out, tip.local->body, along_directions(tip, terms));
    }
}

void JointedTips::set_opening(BodyMotion const& motion, bool velocities, DirectionsView out) const {
    for (Tip const& tip : tips_) {
        Meeting const m = meeting(tip, motion);
        store(out, tip.local->body, along_directions(tip, velocities ? opening_rate(tip, m, motion) : opening(tip, m, motion)));
    }
}

double JointedTips::error(BodyMotion const& motion) const {
    double worst = 0;
    for (Tip const& tip : tips_) {
        Vector<double, 6> const open = along_directions(tip, opening(tip, meeting(tip, motion), motion));
        int const restricted = tip.local->restricted;
        for (int i = 0; i < restricted; ++i) {
            double const e = std::abs(open[i]) / (i < 3 ? reach_ : 1.0);
            worst = e > worst || e != e ? e : worst;
        }
    }
    return worst;
}

}  // namespace catena
