#include "integrate/rigid_dynamics.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace catena {
namespace {

/// Of a point bead: no moments.
PrincipalFrame principal_frame(Sym3 const& inertia) {
    if (inertia.data[0] == 0) return {Quat::identity(), Vec3::zero()};
    Eigen::Matrix3d j;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) j(a, b) = inertia(a, b);
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> const solver(j);
    Eigen::Matrix3d axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
    Mat3 m;
    for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) m(a, b) = axes(a, b);
    return {to_quaternion(m), {{solver.eigenvalues()[0], solver.eigenvalues()[1], solver.eigenvalues()[2]}}};
}

}  // namespace

RigidDynamics::RigidDynamics(ChainGroup const& group, Scene const& scene, Executor const& executor, Communicator const& communicator,
                             std::unique_ptr<ChainSolver> solver)
    : group_(group),
      executor_(executor),
      communicator_(communicator),
      solver_(std::move(solver)),
      given_(make_body_loads(group, scene)),
      position_(group.size),
      velocity_(group.size),
      omega_(group.size),
      orientation_(group.size),
      observed_velocity_(group.size),
      observed_omega_(group.size),
      force_(group.size),
      torque_(group.size),
      momentum_(group.size),
      angular_momentum_(group.size),
      acceleration_(group.size),
      alpha_(group.size),
      trial_position_(group.size),
      trial_omega_(group.size),
      trial_orientation_(group.size),
      outboard_point_(group.size),
      bias_(group.size + 1, group.directions),
      joint_force_(group.size + 1, group.directions),
      tip_bias_(group.has_tips() ? group.size : 0, group.directions),
      tip_force_(group.has_tips() ? group.size : 0, group.directions),
      carried_(group) {
    for (std::int64_t k = 0; k < group.size; ++k) principal_.push_back(principal_frame(as_symmetric(group.inertia[k])));
}

void RigidDynamics::set_simple_forces() {
    executor_.for_each(group_.size, [&](std::int64_t k) {
        force_.set(k, group_.mass.view().at(k, 0) * given_.gravity);
        torque_.set(k, Vec3::zero());  // in W while it is summed up
        if (!given_.wrenches) return;
        force_.set(k, force_[k] + given_.wrench_force[k]);
        torque_.set(k, given_.wrench_torque[k]);
    });
    add_joint_torques();
    executor_.for_each(group_.size, [&](std::int64_t k) { torque_.set(k, transposed_times(turn(orientation_, k), torque_[k])); });
    carried_.clear();
}

ConstView<3> RigidDynamics::bead_positions() {
    return carried_.positions(
        executor_, [&](std::int64_t k) { return position_[k]; }, [&](std::int64_t k) { return turn(orientation_, k); });
}

void RigidDynamics::take_bead_forces() {
    if (!carried_.any()) return;
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Mat3 const r = turn(orientation_, k);
        Wrench const w = carried_.on_body(k, r);
        force_.set(k, force_[k] + w.force);
        torque_.set(k, torque_[k] + transposed_times(r, w.torque));
    });
}

void RigidDynamics::drift(double h, int sweeps) {
    for (int sweep = 0;; ++sweep) {
        executor_.for_each(group_.size, [&](std::int64_t k) {
            trial_position_.set(k, plus_scaled(position_[k], h, velocity_[k]));
            RotorState const start{as_quaternion(orientation_[k]), omega_[k]};
            RotorState const after = is_bead(k) ? start : free_rotor(principal_[static_cast<std::size_t>(k)], start, h);
            trial_orientation_.set(k, as_vector(after.orientation));
            trial_omega_.set(k, after.omega);
        });
        if (sweep == sweeps) break;
        set_outboard_points(trial_position_, trial_orientation_);
        set_openings(1.0 / h, trial_position_, trial_orientation_);
        solver_->solve({{}, {}, {}, bias_.view(), of_tips(group_, tip_bias_)}, {alpha_.view(), acceleration_.view(), {}, {}});
        executor_.for_each(group_.size, [&](std::int64_t k) {
            velocity_.set(k, velocity_[k] + acceleration_[k]);
            omega_.set(k, omega_[k] + alpha_[k]);
        });
    }
    // Copied, not swapped: the solver keeps a view of the orientation it was assembled at.
    executor_.for_each(group_.size, [&](std::int64_t k) {
        position_.set(k, trial_position_[k]);
        orientation_.set(k, trial_orientation_[k]);
        omega_.set(k, trial_omega_[k]);
    });
}

void RigidDynamics::thermostat(Thermostat const& t, std::uint64_t step) {
    executor_.for_each(group_.size, [&](std::int64_t k) {
        add_noise(k, t.keep, t.spread, t.seed, step, NoiseStage::thermostat, NoiseStage::thermostat_angular);
    });
    kick(0.0);
}

void RigidDynamics::draw_velocities(double kt, std::uint64_t seed, std::vector<bool> const& of_chain) {
    for (dca::Piece const& piece : group_.pieces)
        for (std::int64_t k = piece.local; of_chain[piece.chain] && k < piece.local + piece.count; ++k)
            add_noise(k, 0.0, std::sqrt(kt), seed, 0, NoiseStage::start, NoiseStage::start_angular);
    kick(0.0);
}

void RigidDynamics::add_noise(std::int64_t k, double c, double spread, std::uint64_t seed, std::uint64_t step, NoiseStage linear,
                              NoiseStage angular) {
    auto const body = static_cast<std::uint64_t>(group_.scene_index(k));
    velocity_.set(
        k, plus_scaled(c * velocity_[k], spread * std::sqrt(group_.inverse_mass.view().at(k, 0)), normal3(seed, step, body, linear)));
    if (is_bead(k)) return;
    PrincipalFrame const& frame = principal_[static_cast<std::size_t>(k)];
    Vec3 noise = normal3(seed, step, body, angular);
    for (int i = 0; i < 3; ++i) noise[i] *= spread / std::sqrt(frame.moments[i]);
    omega_.set(k, c * omega_[k] + to_matrix(frame.rotation) * noise);
}

std::vector<StateArray> RigidDynamics::state() const {
    return {to_array<3>("position", position_.view()), to_array<3>("velocity", velocity_.view()),
            to_array<4>("orientation", orientation_.view()), to_array<3>("omega", omega_.view())};
}
void RigidDynamics::set_state(std::vector<StateArray> const& arrays) {
    from_array<3>(array_named(arrays, "position"), position_.view());
    from_array<3>(array_named(arrays, "velocity"), velocity_.view());
    from_array<4>(array_named(arrays, "orientation"), orientation_.view());
    from_array<3>(array_named(arrays, "omega"), omega_.view());
}
std::vector<StateArray> RigidDynamics::observed_state() const {
    return {to_array<3>("velocity", observed_velocity_.view()), to_array<3>("omega", observed_omega_.view())};
}

void RigidDynamics::set_momenta_and_biases() {
    set_outboard_points(position_, orientation_);
    executor_.for_each(group_.size, [&](std::int64_t k) {
        Vec3 const w = observed_omega_[k];
        momentum_.set(k, torque_[k] - cross(w, as_symmetric(group_.inertia[k]) * w));
    });
    set_velocity_biases();
}
LoadsView RigidDynamics::loads() {
    return {momentum_.view(), force_.view(), observed_omega_.view(), bias_.view(), of_tips(group_, tip_bias_)};
}
AccelerationsView RigidDynamics::found() { return {alpha_.view(), acceleration_.view(), joint_force_.view(), of_tips(group_, tip_force_)}; }
void RigidDynamics::evaluate() {
    set_momenta_and_biases();
    solver_->solve(loads(), found());
}
void RigidDynamics::evaluate_at_once() {
    set_momenta_and_biases();
    solver_->assemble_and_solve(configuration(), loads_at_once(), found());
}
std::vector<double> RigidDynamics::time_at_once(int chained, int repeat) {
    AccelerationsView out = found();
    out.joint_force = {};
    return solver_->time_evaluations(configuration(), loads_at_once(), out, chained, repeat);
}
/// The solver adds what follows from angular velocities.
LoadsView RigidDynamics::loads_at_once() {
    LoadsView l = loads();
    if (group_.linked) return l;
    l.torque = torque_.view();
    l.gyroscopic = true;
    l.bias = {};
    return l;
}

BodyResults RigidDynamics::results() const {
    BodyResults r;
    for (std::int64_t k = 0; k < group_.size; ++k) {
        r.alpha.push_back(turn(orientation_, k) * alpha_[k]);
        r.acceleration.push_back(acceleration_[k]);
        Vec3 const f = joint_force(k);
        r.joint_force.push_back({{0, 0, 0, f[0], f[1], f[2]}});
    }
    for (LocalTip const& tip : group_.tips) {
        Vec3 const f = tip_force(tip.body);
        r.tip_force.push_back({group_.scene_chain(tip.body), {{0, 0, 0, -f[0], -f[1], -f[2]}}});
    }
    return r;
}

double RigidDynamics::residual() {
    Field<4> point(group_.size);  // acceleration of handle 2, W, and the size of its terms
    for (std::int64_t k = 0; k < group_.size; ++k) {
        HandleAcceleration const a = handle_acceleration(k, group_.r2[k]);
        point.set(k, {{a.value[0], a.value[1], a.value[2], a.terms}});
    }
    exchange_from_inboard(communicator_, group_, point.view());
    double worst = 0;
    for (std::int64_t k = 0; k < group_.size; ++k) {
        worst = larger(worst, newton_euler_residual(k));
        Vector<double, 4> const own = point[k];
        if (group_.has_jointed_tip(k)) worst = larger(worst, tip_closing(k, Vec3{{-own[0], -own[1], -own[2]}}, own[3]));
        if (group_.joint[static_cast<std::size_t>(k)] == JointType::free) continue;
        HandleAcceleration const mine = handle_acceleration(k, group_.r1[k]);
        Vector<double, 4> const before = group_.is_first[k] ? Vector<double, 4>::zero() : point.view().load(k - 1);
        worst = larger(worst, closing(k, mine.value - Vec3{{before[0], before[1], before[2]}}, mine.terms + before[3]));
    }
    return communicator_.max(worst);
}

Vec3 RigidDynamics::outboard_force(std::int64_t k) const {
    if (group_.has_jointed_tip(k)) return tip_force(k);
    return group_.is_last[k] ? Vec3::zero() : joint_force(k + 1);
}

void RigidDynamics::set_outboard_points(Field<3> const& position, Field<4> const& orientation) {
    executor_.for_each(group_.size, [&](std::int64_t k) { outboard_point_.set(k, position[k] + turn(orientation, k) * group_.r2[k]); });
    exchange_from_inboard(communicator_, group_, outboard_point_.view());
}

Vec3 RigidDynamics::inboard_point(std::int64_t k, Field<3> const& position, Field<4> const& orientation) const {
    return position[k] + turn(orientation, k) * group_.r1[k];
}

void RigidDynamics::set_bias(std::int64_t k, Vec3 const& value) {
    for (int i = 0; i < std::min(3, group_.directions); ++i) bias_.view().origin[i * bias_.view().pitch + k] = value[i];
}
void RigidDynamics::set_tip_bias(std::int64_t k, Vec3 const& value) {
    for (int i = 0; i < std::min(3, group_.directions); ++i) tip_bias_.view().origin[i * tip_bias_.view().pitch + k] = value[i];
}

Vec3 RigidDynamics::handle_velocity(std::int64_t k, Vec3 const& r) const {
    return observed_velocity_[k] + turn(orientation_, k) * cross(observed_omega_[k], r);
}

/// P (v + h M^-1 f): the solver with momenta in the place of forces gives velocities in the place of accelerations.
void RigidDynamics::project(double h, View<3> velocity, View<3> omega) {
    executor_.for_each(group_.size, [&](std::int64_t k) {
        momentum_.set(k, plus_scaled(group_.mass.view().at(k, 0) * velocity_[k], h, force_[k]));
        angular_momentum_.set(k, plus_scaled(as_symmetric(group_.inertia[k]) * omega_[k], h, torque_[k]));
    });
    solver_->solve({angular_momentum_.view(), momentum_.view(), {}, {}, {}}, {omega, velocity, {}, {}});
}

/// With the size of what each force and moment on the body, and its turning, adds (chapter, eqs 2.1-2.2).
RigidDynamics::HandleAcceleration RigidDynamics::handle_acceleration(std::int64_t k, Vec3 const& r) const {
    Mat3 const to_ground = turn(orientation_, k);
    Vec3 const w = observed_omega_[k], centripetal = cross(w, cross(w, r));
    Vec3 const f1 = joint_force(k), f2 = outboard_force(k);
    double terms = norm(centripetal) + group_.inverse_mass.view().at(k, 0) * (norm(force_[k]) + norm(f1) + norm(f2));
    for (Vec3 const& moment :
         {momentum_[k], cross(group_.r1[k], transposed_times(to_ground, f1)), cross(group_.r2[k], transposed_times(to_ground, f2))})
        terms += norm(cross(as_symmetric(group_.inverse_inertia[k]) * moment, r));
    return {acceleration_[k] + to_ground * (cross(alpha_[k], r) + centripetal), terms};
}

double RigidDynamics::newton_euler_residual(std::int64_t k) const {
    Mat3 const r = turn(orientation_, k);
    Vec3 const f1 = joint_force(k), f2 = outboard_force(k);
    Vec3 const ma = group_.mass.view().at(k, 0) * acceleration_[k];
    double const newton = relative(norm(ma - force_[k] - f1 + f2), norm(ma) + norm(force_[k]) + norm(f1) + norm(f2));
    if (is_bead(k)) return newton;
    Vec3 const w = observed_omega_[k], j_alpha = as_symmetric(group_.inertia[k]) * alpha_[k];
    Vec3 const gyroscopic = cross(w, as_symmetric(group_.inertia[k]) * w);
    Vec3 const t1 = cross(group_.r1[k], transposed_times(r, f1)), t2 = cross(group_.r2[k], transposed_times(r, f2));
    double const euler = relative(norm(j_alpha + gyroscopic - torque_[k] - t1 + t2),
                                  norm(j_alpha) + norm(gyroscopic) + norm(torque_[k]) + norm(t1) + norm(t2));
    return larger(newton, euler);
}

}  // namespace catena
