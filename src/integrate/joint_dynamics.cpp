#include "integrate/joint_dynamics.hpp"

#include <algorithm>
#include <cmath>

#include "scene/pose.hpp"

namespace catena {
namespace {

/// The longest chain's length from joint to joint and a body's size: a length to compare with. The same on every rank.
double reach_of(ChainGroup const& group, Scene const& scene) {
    double longest = 0;
    for (int const chain : group.chain) {
        ChainSpec const& spec = scene.chains[chain];
        BodyArrays const& b = spec.bodies;
        double length = spec.tip == Tip::jointed ? norm(spec.tip_joint.translation) : 0.0, size = 0;
        for (std::size_t k = 0; k < b.size(); ++k) {
            if (k > 0) length += norm(b.translation[k]);
            size = std::max(size, norm(b.com[k]) + radius_of_gyration(b.inertia[k], b.mass[k]));
        }
        longest = std::max(longest, length + size);
    }
    return longest;
}

BodyMotion motion_at_start(ChainGroup const& group, Scene const& scene, JointKinematics const& kinematics) {
    BodyMotion motion = make_body_motion(group);
    if (group.has_tips()) kinematics.evaluate(make_joint_state(group, scene), true, motion);
    return motion;
}

/// The load of joint k on its outboard body from the moments along its coordinates: torque along the joint's axes (universal:
/// within the plane of its axes) and force along the last one.
Vector<double, 4> load_along_axes(ChainGroup const& group, std::int64_t k, Vec3 const& along, Mat3 const& axes1, Mat3 const& turn) {
    switch (group.joint[k]) {
        case JointType::spherical: {
            Vec3 const t = transposed_times(axes1, turn * along);
            return {{t[0], t[1], t[2], 0}};
        }
        case JointType::universal: {
            Vec3 const first = group.first_axis.view().load(k), second = axes1.column(2);
            double const g = dot(first, second), x = (along[0] - g * along[1]) / (1 - g * g), y = along[1] - g * x;
            Vec3 const t = transposed_times(axes1, plus_scaled(x * first, y, second));
            return {{t[0], t[1], t[2], 0}};
        }
        case JointType::free:
        case JointType::link:
        case JointType::weld:
            return Vector<double, 4>::zero();
        default:
            Vec3 const screw = group.has_screws ? group.screw.view().load(k) : Vec3{{1, 0, 1}};
            return {{0, 0, screw[0] / screw[2] * along[0], screw[1] / screw[2] * along[0]}};
    }
}

}  // namespace

JointDynamics::JointDynamics(ChainGroup const& group, Scene const& scene, Executor const& executor, Communicator const& communicator,
                             std::unique_ptr<ChainSolver> solver)
    : group_(group),
      executor_(executor),
      communicator_(communicator),
      solver_(std::move(solver)),
      kinematics_(group, executor, communicator),
      given_(make_body_loads(group, scene)),
      motion_(motion_at_start(group, scene, kinematics_)),
      tips_(group, motion_, group.has_tips() ? reach_of(group, scene) : 1.0),
      carried_(group),
      has_wrenches_(given_.wrenches || carried_.any()),
      has_forces_(has_wrenches_ || given_.dragged || (given_.joint_loads && group.has_screws)),
      needs_positions_(given_.dragged || group.has_tips() || group.carried_in_scene),
      joint_load_(given_.joint_loads ? group.size : 0),
      torque_(group.size),
      force_(has_forces_ ? group.size : 0),
      alpha_(group.size),
      acceleration_(group.size),
      outboard_(group.size),
      bias_(group.size + 1, group.directions),
      joint_force_(group.size + 1, group.directions),
      tip_bias_(group.has_tips() ? group.size : 0, group.directions),
      tip_force_(group.has_tips() ? group.size : 0, group.directions) {}

JointRates JointDynamics::make_rates() const { return {Field<3>(group_.size), std::vector<Vec3>(group_.pieces.size(), Vec3::zero())}; }

Screw<double> JointDynamics::screw(std::int64_t k) const {
    if (!group_.has_screws) return {1, 0};
    Vec3 const s = group_.screw.view().load(k);
    return {s[0], s[1]};
}

BodyMotion const& JointDynamics::motion(JointState const& state) {
    kinematics_.evaluate(state, true, motion_);
    if (group_.moving_meeting()) tips_.set_meetings(motion_);
    return motion_;
}

void JointDynamics::evaluate(JointState const& state, JointRates& out) {
    update_configuration(state);
    assemble_matrices();
    solve(state, out);
}

void JointDynamics::update_configuration(JointState const& state) {
    kinematics_.evaluate(state, needs_positions_, motion_);
    if (group_.moving_meeting()) tips_.set_meetings(motion_);
    carried_.clear();
}

void JointDynamics::assemble_matrices() {
    bool const moving = group_.moving_meeting();
    auto const& m = motion_;
    solver_->assemble_matrices(
        {{}, m.joint_turn.view(), {}, moving ? m.r2.view() : ConstView<3>{}, moving ? m.axes2.view() : ConstView<9>{}});
}

void JointDynamics::solve(JointState const& state, JointRates& out) {
    if (given_.joint_loads) joint_torques(state);
    loads(state);
    if (group_.has_tips()) tips_.set_acceleration_bias(motion_, given_.gravity, tip_bias_.view());
    solver_->solve({torque_.view(), has_forces_ ? ConstView<3>(force_.view()) : ConstView<3>{}, motion_.omega.view(), bias_.view(),
                    of_tips(group_, tip_bias_)},
                   {alpha_.view(), acceleration_.view(), joint_force_.view(), of_tips(group_, tip_force_)});
    rates(state, out);
}

ConstView<3> JointDynamics::bead_positions() {
    return carried_.positions(
        executor_, [&](std::int64_t k) { return motion_.origin[k] - orientation(k) * group_.r1[k]; },
        [&](std::int64_t k) { return orientation(k); });
}

Wrench JointDynamics::wrench(std::int64_t k) const {
    Wrench w{Vec3::zero(), Vec3::zero()};
    if (carried_.any()) w = carried_.on_body(k, orientation(k));
    if (given_.wrenches) w = {w.torque + given_.wrench_torque[k], w.force + given_.wrench_force[k]};
    return w;
}

/// Known loads along the joint's free directions: given, spring and damper.
void JointDynamics::joint_torques(JointState const& state) {
    executor_.for_each(group_.size, [&](std::int64_t k) {
        if (!group_.drives.empty() && group_.is_driven(k)) return joint_load_.set(k, Vector<double, 4>::zero());
        Vec3 torque = given_.torque.view().load(k);
        Vec3 const qd = state.qd.view().load(k);
        Vector<double, 4> const q = state.q.view().load(k);
        if (given_.springs) {
            Vec3 const stiffness = given_.stiffness.view().load(k);
            Vector<double, 4> const rest = given_.rest.view().load(k);
            if (group_.joint[k] == JointType::spherical)
                torque = torque + spherical_spring_torque(stiffness, as_quaternion(rest), as_quaternion(q));
            else
                for (int i = 0; i < 2; ++i) torque[i] -= stiffness[i] * (q[i] - rest[i]);
        }
        if (given_.dampers) {
            Vec3 const damping = given_.damping.view().load(k);
            for (int i = 0; i < 3; ++i) torque[i] -= damping[i] * qd[i];
        }
        Mat3 const turn = to_matrix(as_quaternion(motion_.joint_turn.view().load(k)));
        joint_load_.set(k, load_along_axes(group_, k, torque, as_matrix(group_.axes1.view().load(k)), turn));
    });
    exchange_from_outboard(communicator_, group_, joint_load_.view());
}

/// Adds what the joints at both ends of body k do along their free directions; B.
void JointDynamics::add_joint_loads(std::int64_t k, Mat3 const& turn, Vec3& torque, Vec3& force) const {
    Vector<double, 4> const in = joint_load_.view().load(k);
    Mat3 const e1 = transposed_times(turn, as_matrix(group_.axes1.view().load(k)));
    torque = torque + e1 * Vec3{{in[0], in[1], in[2]}};
    if (in[3] != 0) {
        Vec3 const push = in[3] * e1.column(2);
        force = force + push;
        torque = torque + cross(group_.r1.view().load(k), push);
    }
    if (group_.is_last[k]) return;
    Vector<double, 4> const out = joint_load_.view().load(k + 1);
    Mat3 const e2 = axes2(k);
    torque = torque - e2 * Vec3{{out[0], out[1], out[2]}};
    if (out[3] != 0) {
        Vec3 const push = out[3] * e2.column(2);
        force = force - push;
        torque = torque - cross(r2(k), push);
    }
}

/// The velocity-dependent part c of joint k's relative acceleration (formulas, "Joint bias"), with what a drive prescribes; M.
Vec3 JointDynamics::joint_velocity_term(JointState const& state, std::int64_t k, Vec3& linear) const {
    Mat3 const turn = to_matrix(as_quaternion(motion_.joint_turn.view().load(k)));
    Vec3 const w = turn * motion_.omega.view().load(k);
    JointRate const rate = joint_rate(group_, state, k);
    Vec3 angular = cross(w, rate.angular);  // the outboard body's w does as well as the inboard one's
    linear = 2.0 * cross(w - rate.angular, rate.linear);
    bool const universal = group_.joint[k] == JointType::universal;
    Mat3 const axes = as_matrix(group_.axes1.view().load(k));
    if (universal) {
        Vec3 const qd = state.qd.view().load(k);
        angular = plus_scaled(angular, qd[0] * qd[1], cross(group_.first_axis.view().load(k), axes.column(2)));
    }
    if (group_.drives.empty() || !group_.is_driven(k)) return angular;
    auto const drive =
        std::lower_bound(group_.drives.begin(), group_.drives.end(), k, [](LocalDrive const& d, std::int64_t b) { return d.body < b; });
    double const first = scene::acceleration_at(drive->course[0], state.time),
                 second = scene::acceleration_at(drive->course[1], state.time);
    if (universal) return angular + first * group_.first_axis.view().load(k) + second * axes.column(2);
    Vec3 const s = group_.has_screws ? group_.screw.view().load(k) : Vec3{{1, 0, 1}};
    linear = plus_scaled(linear, s[1] * s[2] * first, axes.column(2));
    return plus_scaled(angular, s[0] * s[2] * first, axes.column(2));
}

void JointDynamics::loads(JointState const& state) {
    DirectionsView const bias = bias_.view();
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Vec3 const w = motion_.omega.view().load(k);
        Mat3 const turn = to_matrix(as_quaternion(motion_.joint_turn.view().load(k)));
        Mat3 const axes1 = as_matrix(group_.axes1.view().load(k));
        // In a plane the gyroscopic torque is across it, and large: only its rounding would count.
        Vec3 torque = group_.planar ? Vec3::zero() : -gyroscopic_torque(k), force = Vec3::zero();
        if (given_.joint_loads) add_joint_loads(k, turn, torque, force);
        if (has_wrenches_) {
            Wrench const w_out = wrench(k);
            torque = torque + transposed_times(orientation(k), w_out.torque);
            force = force + transposed_times(orientation(k), w_out.force);
        }
        if (given_.dragged) {
            Vector<double, 2> const drag = given_.drag.view().load(k);
            force = plus_scaled(force, -drag[0], motion_.velocity.view().load(k) - cross(w, group_.r1.view().load(k)));
            torque = plus_scaled(torque, -drag[1], w);
        }
        torque_.set(k, torque);
        if (group_.planar && has_forces_) {  // nothing moves across the plane
            Vec3 const axis = axes1.column(2);
            force = plus_scaled(force, -dot(axis, force), axis);
        }
        if (has_forces_) force_.set(k, force);

        Vec3 linear = Vec3::zero(), angular = Vec3::zero();  // -c along the joint's axes
        JointType const type = group_.joint[k];
        if (type != JointType::free && type != JointType::spherical && type != JointType::weld && !group_.planar) {
            angular = -transposed_times(axes1, joint_velocity_term(state, k, linear));
            linear = -transposed_times(axes1, linear);
        }
        if (group_.is_first[k] && type != JointType::free) {
            Mat3 const to_meeting = to_matrix(as_quaternion(motion_.joint_turn.view().load(k)));
            linear = linear +
                     transposed_times(axes1, to_meeting * transposed_times(orientation(k), given_.gravity));  // ground accelerates by -g
        }
        Screw<double> const s = screw(k);
        double const b[6] = {linear[0],  linear[1],  s.c * linear[2] - s.s * angular[2],
                             angular[0], angular[1], s.s * linear[2] + s.c * angular[2]};
        for (int i = 0; i < group_.directions; ++i) bias.origin[i * bias.pitch + k] = b[i];
    });
}

/// Second derivatives of joint k's coordinates. `relative_alpha`: outboard less inboard angular acceleration along the joint's axes.
/// `relative_slide`: the same of the meeting points along the last axis.
Vec3 JointDynamics::rate_of_joint(JointState const& state, std::int64_t k, Vec3 const& relative_alpha, double relative_slide) const {
    switch (group_.joint[k]) {
        case JointType::universal: {
            Mat3 const axes = as_matrix(group_.axes1.view().load(k));
            Vec3 linear;
            Vec3 const relative = relative_alpha - transposed_times(axes, joint_velocity_term(state, k, linear));
            Vec3 const first = transposed_times(axes, group_.first_axis.view().load(k));  // (0, y, z); the second axis is (0, 0, 1)
            double const u1 = relative[1] / first[1];
            return {{u1, relative[2] - first[2] * u1, 0}};
        }
        case JointType::weld:
        case JointType::link:
            return Vec3::zero();
        default:
            if (!group_.has_screws) return {{relative_alpha[2], 0, 0}};
            Vec3 const s = group_.screw.view().load(k);
            return {{(s[0] * relative_alpha[2] + s[1] * relative_slide) / s[2], 0, 0}};
    }
}

void JointDynamics::rates(JointState const& state, JointRates& out) {
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Mat3 const e2 = axes2(k);
        Vec3 const alpha = alpha_.view().load(k), along = transposed_times(e2, alpha);
        double slide = 0;
        if (group_.has_screws) {
            Vec3 const w = motion_.omega.view().load(k), r = r2(k);
            slide = dot(e2.column(2), acceleration_.view().load(k) + cross(alpha, r) + cross(w, cross(w, r)));
        }
        outboard_.set(k, {{along[0], along[1], along[2], slide}});
    });
    exchange_from_inboard(communicator_, group_, outboard_.view());
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Mat3 const axes1 = as_matrix(group_.axes1.view().load(k));
        Mat3 const turn = to_matrix(as_quaternion(motion_.joint_turn.view().load(k)));
        Vec3 const alpha = alpha_.view().load(k), w = motion_.omega.view().load(k);
        Vector<double, 4> before = Vector<double, 4>::zero();
        if (!group_.is_first[k]) before = outboard_.view().load(k - 1);
        Vec3 const inboard{{before[0], before[1], before[2]}};
        if (group_.joint[k] == JointType::free) return out.qdd.set(k, alpha);
        if (group_.joint[k] == JointType::spherical)
            return out.qdd.set(k, alpha - transposed_times(turn, axes1 * inboard) + cross(state.qd.view().load(k), w));
        double slide = 0;
        if (group_.has_screws) {
            Vec3 const r = group_.r1.view().load(k), axis = axes1.column(2);  // the axis is the same in B
            slide = dot(axis, acceleration_.view().load(k) + cross(alpha, r) + cross(w, cross(w, r))) - before[3];
            if (group_.is_first[k])
                slide += dot(axis, transposed_times(to_matrix(as_quaternion(motion_.orientation.view().load(k))), given_.gravity));
        }
        out.qdd.set(k, rate_of_joint(state, k, transposed_times(axes1, turn * alpha) - inboard, slide));
    });
    for (LocalDrive const& drive : group_.drives)
        out.qdd.set(drive.body,
                    {{scene::acceleration_at(drive.course[0], state.time),
                      group_.joint[drive.body] == JointType::universal ? scene::acceleration_at(drive.course[1], state.time) : 0.0, 0}});
    for (std::size_t p = 0; p < group_.pieces.size(); ++p) {
        std::int64_t const k = group_.pieces[p].local;
        if (!group_.pieces[p].starts || group_.joint[k] != JointType::free) continue;
        Vec3 const w = motion_.omega.view().load(k), r = group_.r1.view().load(k);
        Vec3 const a = acceleration_.view().load(k) + cross(alpha_.view().load(k), r) + cross(w, cross(w, r));
        out.base_acceleration[p] = to_matrix(as_quaternion(motion_.orientation.view().load(k))) * a + given_.gravity;
    }
}

}  // namespace catena
