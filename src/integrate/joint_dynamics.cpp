#include "integrate/joint_dynamics.hpp"

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

Quat as_quaternion(Vector<double, 4> const& v) { return {v[0], v[1], v[2], v[3]}; }
Mat3 as_matrix(Vector<double, 9> const& v) { return {{v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]}}; }
Sym3 as_symmetric(Vector<double, 6> const& v) { return {{v[0], v[1], v[2], v[3], v[4], v[5]}}; }

}  // namespace

JointDynamics::JointDynamics(ChainGroup const& group, Scene const& scene, Executor const& executor, Communicator const& communicator,
                             std::unique_ptr<ChainSolver> solver)
    : group_(group),
      executor_(executor),
      communicator_(communicator),
      solver_(std::move(solver)),
      kinematics_(group, executor, communicator),
      given_(make_body_loads(group, scene)),
      motion_{Field<4>(group.size), Field<4>(group.size), Field<3>(group.size), Field<3>(group.size), Field<3>(group.size)},
      joint_torque_(given_.joint_loads ? group.size : 0),
      torque_(group.size),
      force_(given_.wrenches ? group.size : 0),
      alpha_(group.size),
      acceleration_(group.size),
      alpha_outboard_(group.size),
      bias_(group.size + 1, group.directions),
      joint_force_(group.size + 1, group.directions) {}

JointRates JointDynamics::make_rates() const { return {Field<3>(group_.size), std::vector<Vec3>(group_.pieces.size(), Vec3::zero())}; }

BodyMotion const& JointDynamics::motion(JointState const& state) {
    kinematics_.evaluate(state, true, motion_);
    return motion_;
}

void JointDynamics::evaluate(JointState const& state, JointRates& out) {
    kinematics_.evaluate(state, false, motion_);
    solver_->assemble_matrices({{}, motion_.joint_turn.view()});
    if (given_.joint_loads) joint_torques(state);
    loads(state);
    solver_->solve({torque_.view(), given_.wrenches ? ConstView<3>(force_.view()) : ConstView<3>{}, motion_.omega.view(), bias_.view()},
                   {alpha_.view(), acceleration_.view(), joint_force_.view()});
    rates(state, out);
}

/// Known torques along the joint's free directions: given, spring and damper.
void JointDynamics::joint_torques(JointState const& state) {
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Vec3 torque = given_.torque.view().load(k);
        Vec3 const qd = state.qd.view().load(k);
        Vector<double, 4> const q = state.q.view().load(k);
        bool const revolute = group_.joint[k] == JointType::revolute;
        if (given_.springs) {
            Vec3 const stiffness = given_.stiffness.view().load(k);
            Vector<double, 4> const rest = given_.rest.view().load(k);
            if (revolute)
                torque[0] -= stiffness[0] * (q[0] - rest[0]);
            else if (group_.joint[k] == JointType::spherical)
                torque = torque + spherical_spring_torque(stiffness, as_quaternion(rest), as_quaternion(q));
        }
        if (given_.dampers) {
            Vec3 const damping = given_.damping.view().load(k);
            for (int i = 0; i < 3; ++i) torque[i] -= damping[i] * qd[i];
        }
        if (revolute)
            torque = {{0, 0, torque[0]}};
        else
            torque = transposed_times(as_matrix(group_.axes1.view().load(k)),
                                      to_matrix(as_quaternion(motion_.joint_turn.view().load(k))) * torque);
        joint_torque_.set(k, torque);
    });
    exchange_from_outboard(communicator_, group_, joint_torque_.view());
}

void JointDynamics::loads(JointState const& state) {
    DirectionsView const bias = bias_.view();
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Vec3 const w = motion_.omega.view().load(k);
        Mat3 const turn = to_matrix(as_quaternion(motion_.joint_turn.view().load(k)));
        Mat3 const axes1 = as_matrix(group_.axes1.view().load(k));
        Vec3 torque = -cross(w, as_symmetric(group_.inertia.view().load(k)) * w);
        if (given_.joint_loads) {
            torque = torque + transposed_times(turn, axes1 * joint_torque_.view().load(k));
            if (!group_.is_last[k]) torque = torque - as_matrix(group_.axes2.view().load(k)) * joint_torque_.view().load(k + 1);
        }
        if (given_.wrenches) {
            Mat3 const orientation = to_matrix(as_quaternion(motion_.orientation.view().load(k)));
            torque = torque + transposed_times(orientation, given_.wrench_torque.view().load(k));
            force_.set(k, transposed_times(orientation, given_.wrench_force.view().load(k)));
        }
        torque_.set(k, torque);
        Vector<double, 6> b = Vector<double, 6>::zero();  // -c along the joint's directions
        if (group_.is_first[k] && group_.joint[k] != JointType::free) {
            Mat3 const to_ground = to_matrix(as_quaternion(group_.joint_rotation.view().load(k)));
            Vec3 const g = transposed_times(axes1, transposed_times(to_ground, given_.gravity));  // ground accelerates by -g
            for (int i = 0; i < 3; ++i) b[i] = g[i];
        }
        if (group_.joint[k] == JointType::revolute) {
            Vec3 const c = transposed_times(axes1, turn * cross(w, state.qd.view().load(k)[0] * axes1.column(2)));
            for (int i = 0; i < 3; ++i) b[3 + i] = -c[i];
        }
        for (int i = 0; i < group_.directions; ++i) bias.origin[i * bias.pitch + k] = b[i];
    });
}

void JointDynamics::rates(JointState const& state, JointRates& out) {
    executor_.for_each(group_.size, [&](std::int64_t k) {
        alpha_outboard_.set(k, transposed_times(as_matrix(group_.axes2.view().load(k)), alpha_.view().load(k)));
    });
    exchange_from_inboard(communicator_, group_, alpha_outboard_.view());
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Mat3 const axes1 = as_matrix(group_.axes1.view().load(k));
        Vec3 const alpha = alpha_.view().load(k);
        Vec3 const inboard = group_.is_first[k] ? Vec3::zero() : alpha_outboard_.view().load(k - 1);
        if (group_.joint[k] == JointType::revolute) {
            out.qdd.set(k, {{dot(axes1.column(2), alpha) - inboard[2], 0, 0}});
        } else if (group_.joint[k] == JointType::spherical) {
            Mat3 const turn = to_matrix(as_quaternion(motion_.joint_turn.view().load(k)));
            out.qdd.set(k, alpha - transposed_times(turn, axes1 * inboard) + cross(state.qd.view().load(k), motion_.omega.view().load(k)));
        } else {
            out.qdd.set(k, alpha);
        }
    });
    for (std::size_t p = 0; p < group_.pieces.size(); ++p) {
        std::int64_t const k = group_.pieces[p].local;
        if (!group_.pieces[p].starts || group_.joint[k] != JointType::free) continue;
        Vec3 const w = motion_.omega.view().load(k), r = group_.r1.view().load(k);
        Vec3 const a = acceleration_.view().load(k) + cross(alpha_.view().load(k), r) + cross(w, cross(w, r));
        out.base_acceleration[p] = to_matrix(as_quaternion(motion_.orientation.view().load(k))) * a + given_.gravity;
    }
}

BodyResults JointDynamics::results() const {
    BodyResults r;
    auto const [origin, pitch] = joint_force_.view();
    for (std::int64_t k = 0; k < group_.size; ++k) {
        Mat3 const orientation = to_matrix(as_quaternion(motion_.orientation.view().load(k)));
        r.alpha.push_back(orientation * alpha_.view().load(k));
        r.acceleration.push_back(orientation * acceleration_.view().load(k) + given_.gravity);
        Vec3 force = Vec3::zero(), torque = Vec3::zero();
        for (int i = 0; i < 3; ++i) force[i] = origin[i * pitch + k];
        for (int i = 3; i < group_.directions; ++i) torque[i - 3] = origin[i * pitch + k];
        Mat3 const to_ground = orientation * transposed_times(to_matrix(as_quaternion(motion_.joint_turn.view().load(k))),
                                                              as_matrix(group_.axes1.view().load(k)));
        Vec3 const t = to_ground * torque, f = to_ground * force;
        r.joint_force.push_back({{t[0], t[1], t[2], f[0], f[1], f[2]}});
    }
    return r;
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
        if (group_.joint[k] == JointType::revolute) e.springs.back() = 0.5 * stiffness[0] * (q[0] - rest[0]) * (q[0] - rest[0]);
        if (group_.joint[k] == JointType::spherical)
            e.springs.back() = spherical_spring_energy(stiffness, as_quaternion(rest), as_quaternion(q));
    }
    return e;
}

}  // namespace catena
