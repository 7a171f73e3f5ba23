// What a solution in joint coordinates says of bodies and joints, ground axes.
#include "integrate/across_plane.hpp"
#include "integrate/joint_dynamics.hpp"

namespace catena {

BodyResults JointDynamics::results() const {
    BodyResults r;
    auto const [origin, pitch] = joint_force_.view();
    for (std::int64_t k = 0; k < group_.size; ++k) {
        Mat3 const orientation = to_matrix(as_quaternion(motion_.orientation.view().load(k)));
        Mat3 const to_ground = orientation * transposed_times(to_matrix(as_quaternion(motion_.joint_turn.view().load(k))),
                                                              as_matrix(group_.axes1.view().load(k)));
        Vec3 gravity = given_.gravity;
        if (group_.planar) gravity = plus_scaled(gravity, -dot(to_ground.column(2), gravity), to_ground.column(2));
        r.alpha.push_back(orientation * alpha_.view().load(k));
        r.acceleration.push_back(orientation * acceleration_.view().load(k) + gravity);
        double f[6] = {0, 0, 0, 0, 0, 0};
        for (int i = 0; i < group_.directions; ++i) f[i] = origin[i * pitch + k];
        Screw<double> const s = screw(k);
        Vec3 const force{{f[0], f[1], s.c * f[2] + s.s * f[5]}}, torque{{f[3], f[4], s.c * f[5] - s.s * f[2]}};
        Vec3 const t = to_ground * torque, v = to_ground * force;
        r.joint_force.push_back({{t[0], t[1], t[2], v[0], v[1], v[2]}});
    }
    if (group_.planar) add_across_plane(r);
    for (LocalTip const& tip : group_.tips) {
        auto const [force_origin, force_pitch] = tip_force_.view();
        double f[6] = {0, 0, 0, 0, 0, 0};
        for (int i = 0; i < group_.directions; ++i) f[i] = force_origin[i * force_pitch + tip.body];
        Screw<double> const s{tip.screw[0], tip.screw[1]};
        Mat3 const to_ground = orientation(tip.body) * axes2(tip.body);
        Vec3 const force = -(to_ground * Vec3{{f[0], f[1], s.c * f[2] + s.s * f[5]}});
        // Handles meet on G's origin, which slides.
        Vec3 const arm = orientation(tip.body) * (r2(tip.body) - group_.r1[tip.body] - tip.joint.translation);
        Vec3 const torque = cross(arm, force) - to_ground * Vec3{{f[3], f[4], s.c * f[5] - s.s * f[2]}};
        r.tip_force.push_back({group_.scene_chain(tip.body), {{torque[0], torque[1], torque[2], force[0], force[1], force[2]}}});
    }
    return r;
}

/// Force along the axis and torque across it, of planar chains. Where a tip is jointed the ground holds the chain across its plane
/// twice: they stay 0.
void JointDynamics::add_across_plane(BodyResults& r) const {
    std::vector<NeededWrench> needed;
    for (std::int64_t k = 0; k < group_.size; ++k) {
        Mat3 const to_ground = orientation(k);
        Vec3 const wrench_force = has_wrenches_ ? wrench(k).force : Vec3::zero();
        Vec3 drag = Vec3::zero();
        if (given_.dragged) drag = (-given_.drag[k][0]) * (motion_.velocity[k] - cross(motion_.omega[k], group_.r1[k]));
        Vec3 const force =
            group_.mass.view().at(k, 0) * (r.acceleration[static_cast<std::size_t>(k)] - given_.gravity) - wrench_force - to_ground * drag;
        Vec3 const torque = to_ground * (as_symmetric(group_.inertia[k]) * alpha_[k] + gyroscopic_torque(k) - torque_[k]);
        Vec3 const to_next = group_.is_last[k] ? Vec3::zero() : to_ground * (group_.r2[k] - group_.r1[k]);
        needed.push_back({force, torque + cross(to_ground * -group_.r1[k], force), to_next});
    }
    auto const sums = sums_from_tip(group_, communicator_, needed);
    for (dca::Piece const& piece : group_.pieces) {
        if (group_.partition.jointed_tip[piece.chain]) continue;
        for (std::int64_t k = piece.local; k < piece.local + piece.count; ++k) {
            Vec3 const axis = to_matrix(as_quaternion(motion_.orientation[k])) * as_matrix(group_.axes1[k]).column(2);
            auto const& [needed_force, needed_torque] = sums[k];
            Vec3 const force = dot(axis, needed_force) * axis, torque = plus_scaled(needed_torque, -dot(axis, needed_torque), axis);
            for (int i = 0; i < 3; ++i) {
                r.joint_force[k][i] += torque[i];
                r.joint_force[k][3 + i] += force[i];
            }
        }
    }
}

PotentialEnergy JointDynamics::potential(JointState const& state, BodyMotion const& motion) const {
    PotentialEnergy e;
    for (std::int64_t k = 0; k < group_.size; ++k) {
        Vec3 const com = motion.origin[k] - to_matrix(as_quaternion(motion.orientation[k])) * group_.r1[k];
        e.gravity.push_back(-group_.mass.view().at(k, 0) * dot(given_.gravity, com));
        e.springs.push_back(0.0);
        if (!given_.springs) continue;
        Vec3 const stiffness = given_.stiffness[k];
        Vector<double, 4> const rest = given_.rest[k], q = state.q[k];
        if (group_.joint[k] == JointType::spherical)
            e.springs.back() = spherical_spring_energy(stiffness, as_quaternion(rest), as_quaternion(q));
        else if (group_.joint[k] != JointType::free)
            for (int i = 0; i < 2; ++i) e.springs.back() += 0.5 * stiffness[i] * (q[i] - rest[i]) * (q[i] - rest[i]);
    }
    return e;
}

}  // namespace catena
