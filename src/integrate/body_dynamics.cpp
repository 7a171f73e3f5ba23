#define EIGEN_DONT_PARALLELIZE  // threads are the executor's
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "integrate/absolute_dynamics.hpp"
#include "integrate/body_loads.hpp"
#include "integrate/rotor.hpp"

namespace catena {
namespace {

PrincipalFrame principal_frame(Sym3 const& inertia) {
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

/// Bodies on spherical joints. Handle 1 of body k lies at x + R r1, handle 2 at x + R r2 (x: centre of mass).
class BodyDynamics final : public AbsoluteDynamics {
  public:
    BodyDynamics(ChainGroup const& group, Scene const& scene, Executor const& executor, Communicator const& communicator,
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
          joint_torque_(group.size),
          momentum_(group.size),
          angular_momentum_(group.size),
          acceleration_(group.size),
          alpha_(group.size),
          trial_position_(group.size),
          trial_omega_(group.size),
          trial_orientation_(group.size),
          outboard_point_(group.size),
          bias_(group.size + 1, group.directions),
          joint_force_(group.size + 1, group.directions) {
        for (std::int64_t k = 0; k < group.size; ++k) principal_.push_back(principal_frame(as_symmetric(group.inertia[k])));
        start_from_joint_coordinates(scene);
        for (std::int64_t k = 0; k < group.size; ++k) reach_ = std::max({reach_, norm(group.r1[k]), norm(group.r2[k])});
        reach_ = communicator.max(reach_);
    }

    void update_configuration() override {
        if (given_.springs) exchange_from_inboard(communicator_, group_, orientation_.view());
    }
    void assemble_matrices() override { solver_->assemble_matrices({{}, orientation_.view(), {}, {}, {}}); }

    void set_simple_forces() override {
        if (given_.joint_loads) set_joint_torques();
        executor_.for_each(group_.size, [&](std::int64_t k) {
            Vec3 force = group_.mass.view().at(k, 0) * given_.gravity, torque = Vec3::zero();  // torque: W
            if (given_.joint_loads) {
                torque = joint_torque_[k];
                if (!group_.is_last[k]) torque = torque - joint_torque_.view().load(k + 1);
            }
            if (given_.wrenches) {
                force = force + given_.wrench_force[k];
                torque = torque + given_.wrench_torque[k];
            }
            force_.set(k, force);
            torque_.set(k, transposed_times(turn(orientation_, k), torque));
        });
    }
    View<3> bead_forces() override { return {}; }
    ConstView<3> bead_positions() const override { return {}; }

    void kick(double h) override { project(h, velocity_.view(), omega_.view()); }
    void observe(double h) override { project(h, observed_velocity_.view(), observed_omega_.view()); }

    /// Impulses along the joints at the start enter momenta before the drift, and the free rotor runs again in every sweep
    /// (formulas, "Rigid bodies under RATTLE").
    void drift(double h, int sweeps) override {
        for (int sweep = 0;; ++sweep) {
            executor_.for_each(group_.size, [&](std::int64_t k) {
                trial_position_.set(k, plus_scaled(position_[k], h, velocity_[k]));
                RotorState const after = free_rotor(principal_[k], {as_quaternion(orientation_[k]), omega_[k]}, h);
                trial_orientation_.set(k, as_vector(after.orientation));
                trial_omega_.set(k, after.omega);
                outboard_point_.set(k, trial_position_[k] + to_matrix(after.orientation) * group_.r2[k]);
            });
            if (sweep == sweeps) break;
            exchange_from_inboard(communicator_, group_, outboard_point_.view());
            executor_.for_each(group_.size, [&](std::int64_t k) { set_bias(k, (1.0 / h) * gap(k, trial_position_, trial_orientation_)); });
            solver_->solve({{}, {}, {}, bias_.view(), {}}, {alpha_.view(), acceleration_.view(), {}, {}});
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

    void thermostat(double c, double kt, std::uint64_t seed, std::uint64_t step) override {
        double const spread = std::sqrt((1.0 - c * c) * kt);
        executor_.for_each(group_.size, [&](std::int64_t k) {
            add_noise(k, c, spread, seed, step, NoiseStage::thermostat, NoiseStage::thermostat_angular);
        });
        kick(0.0);
    }
    void draw_velocities(double kt, std::uint64_t seed, std::vector<bool> const& of_chain) override {
        for (dca::Piece const& piece : group_.pieces)
            for (std::int64_t k = piece.local; of_chain[piece.chain] && k < piece.local + piece.count; ++k)
                add_noise(k, 0.0, std::sqrt(kt), seed, 0, NoiseStage::start, NoiseStage::start_angular);
        kick(0.0);
    }

    double constraint_error() override {
        set_outboard_points();
        double error = 0;
        for (std::int64_t k = 0; k < group_.size; ++k) error = larger(error, norm(gap(k, position_, orientation_)) / reach_);
        return communicator_.max(error);
    }

    std::vector<StateArray> state() const override {
        return {to_array<3>("position", position_.view()), to_array<3>("velocity", velocity_.view()),
                to_array<4>("orientation", orientation_.view()), to_array<3>("omega", omega_.view())};
    }
    void set_state(std::vector<StateArray> const& arrays) override {
        from_array<3>(array_named(arrays, "position"), position_.view());
        from_array<3>(array_named(arrays, "velocity"), velocity_.view());
        from_array<4>(array_named(arrays, "orientation"), orientation_.view());
        from_array<3>(array_named(arrays, "omega"), omega_.view());
    }
    std::vector<StateArray> observed_state() const override {
        return {to_array<3>("velocity", observed_velocity_.view()), to_array<3>("omega", observed_omega_.view())};
    }

    void evaluate() override {
        set_outboard_points();
        executor_.for_each(group_.size, [&](std::int64_t k) {
            Vec3 const w = observed_omega_[k];
            momentum_.set(k, torque_[k] - cross(w, as_symmetric(group_.inertia[k]) * w));
            set_bias(k, Vec3::zero());
        });
        solver_->solve({momentum_.view(), force_.view(), observed_omega_.view(), bias_.view(), {}},
                       {alpha_.view(), acceleration_.view(), joint_force_.view(), {}});
    }
    BodyResults results() const override {
        BodyResults r;
        for (std::int64_t k = 0; k < group_.size; ++k) {
            r.alpha.push_back(turn(orientation_, k) * alpha_[k]);
            r.acceleration.push_back(acceleration_[k]);
            Vec3 const f = joint_force_.view().load<3>(k);
            r.joint_force.push_back({{0, 0, 0, f[0], f[1], f[2]}});
        }
        return r;
    }
    double residual() override {
        Field<4> point(group_.size);  // acceleration of handle 2, W, and the size of its terms
        for (std::int64_t k = 0; k < group_.size; ++k) {
            HandleAcceleration const a = handle_acceleration(k, group_.r2[k]);
            point.set(k, {{a.value[0], a.value[1], a.value[2], a.terms}});
        }
        exchange_from_inboard(communicator_, group_, point.view());
        double worst = 0;
        for (std::int64_t k = 0; k < group_.size; ++k) {
            double const newton = newton_euler_residual(k);
            double closing = 0;
            if (group_.joint[k] != JointType::free) {
                HandleAcceleration const mine = handle_acceleration(k, group_.r1[k]);
                Vector<double, 4> const before = group_.is_first[k] ? Vector<double, 4>::zero() : point.view().load(k - 1);
                closing = relative(norm(mine.value - Vec3{{before[0], before[1], before[2]}}), mine.terms + before[3]);
            }
            worst = larger(worst, larger(newton, closing));
        }
        return communicator_.max(worst);
    }

    PotentialEnergy potential() override {
        exchange_from_inboard(communicator_, group_, orientation_.view());
        PotentialEnergy e;
        for (std::int64_t k = 0; k < group_.size; ++k) {
            e.gravity.push_back(-group_.mass.view().at(k, 0) * dot(given_.gravity, position_[k]));
            bool const spring = given_.springs && group_.joint[k] == JointType::spherical;
            e.springs.push_back(spring ? spherical_spring_energy(given_.stiffness[k], as_quaternion(given_.rest[k]), joint_turn(k)) : 0.0);
        }
        return e;
    }
    ChainGroup const& group() const override { return group_; }
    ChainSolver const& solver() const override { return *solver_; }

  private:
    struct HandleAcceleration {
        Vec3 value;
        double terms;
    };
    static double relative(double difference, double terms) { return terms == 0 ? 0.0 : std::abs(difference) / terms; }
    static Mat3 turn(Field<4> const& orientation, std::int64_t k) { return to_matrix(as_quaternion(orientation.view().load(k))); }

    void start_from_joint_coordinates(Scene const& scene) {
        BodyMotion motion = make_body_motion(group_);
        JointKinematics(group_, executor_, communicator_).evaluate(make_joint_state(group_, scene), true, motion);
        for (std::int64_t k = 0; k < group_.size; ++k) {
            Mat3 const r = turn(motion.orientation, k);
            orientation_.set(k, motion.orientation[k]);
            omega_.set(k, motion.omega[k]);
            position_.set(k, motion.origin[k] - r * group_.r1[k]);
            velocity_.set(k, r * (motion.velocity[k] - cross(motion.omega[k], group_.r1[k])));
        }
    }
    /// X: of B in the joint frame of the inboard joint.
    Quat joint_turn(std::int64_t k) const {
        Quat const frame = as_quaternion(group_.joint_rotation[k]);
        Quat const inboard = group_.is_first[k] ? Quat::identity() : as_quaternion(orientation_.view().load(k - 1));
        return conjugate(inboard * frame) * as_quaternion(orientation_[k]);
    }
    void set_joint_torques() {
        executor_.for_each(group_.size, [&](std::int64_t k) {
            Vec3 torque = Vec3::zero();
            if (group_.joint[k] == JointType::spherical) {
                torque = given_.torque[k];
                if (given_.springs)
                    torque = torque + spherical_spring_torque(given_.stiffness[k], as_quaternion(given_.rest[k]), joint_turn(k));
            }
            joint_torque_.set(k, turn(orientation_, k) * torque);
        });
        exchange_from_outboard(communicator_, group_, joint_torque_.view());
    }
    void set_outboard_points() {
        executor_.for_each(group_.size,
                           [&](std::int64_t k) { outboard_point_.set(k, position_[k] + turn(orientation_, k) * group_.r2[k]); });
        exchange_from_inboard(communicator_, group_, outboard_point_.view());
    }
    /// Handle 1 of body k from handle 2 of its inboard neighbour, W.
    Vec3 gap(std::int64_t k, Field<3> const& position, Field<4> const& orientation) const {
        if (group_.joint[k] == JointType::free) return Vec3::zero();
        Vec3 const inboard = group_.is_first[k] ? group_.joint_translation[k] : outboard_point_.view().load(k - 1);
        return position[k] + turn(orientation, k) * group_.r1[k] - inboard;
    }
    void set_bias(std::int64_t k, Vec3 const& value) {
        for (int i = 0; i < 3; ++i) bias_.view().origin[i * bias_.view().pitch + k] = value[i];
    }
    void add_noise(std::int64_t k, double c, double spread, std::uint64_t seed, std::uint64_t step, NoiseStage linear, NoiseStage angular) {
        auto const body = static_cast<std::uint64_t>(group_.scene_index(k));
        velocity_.set(
            k, plus_scaled(c * velocity_[k], spread * std::sqrt(group_.inverse_mass.view().at(k, 0)), normal3(seed, step, body, linear)));
        Vec3 noise = normal3(seed, step, body, angular);
        for (int i = 0; i < 3; ++i) noise[i] *= spread / std::sqrt(principal_[k].moments[i]);
        omega_.set(k, c * omega_[k] + to_matrix(principal_[k].rotation) * noise);
    }
    /// P (v + h M^-1 f): the solver with momenta in the place of forces gives velocities in the place of accelerations.
    void project(double h, View<3> velocity, View<3> omega) {
        executor_.for_each(group_.size, [&](std::int64_t k) {
            momentum_.set(k, plus_scaled(group_.mass.view().at(k, 0) * velocity_[k], h, force_[k]));
            angular_momentum_.set(k, plus_scaled(as_symmetric(group_.inertia[k]) * omega_[k], h, torque_[k]));
        });
        solver_->solve({angular_momentum_.view(), momentum_.view(), {}, {}, {}}, {omega, velocity, {}, {}});
    }
    /// With the size of what each force and moment on the body, and its turning, adds (chapter, eqs 2.1-2.2).
    HandleAcceleration handle_acceleration(std::int64_t k, Vec3 const& r) const {
        Mat3 const to_ground = turn(orientation_, k);
        Vec3 const w = observed_omega_[k], centripetal = cross(w, cross(w, r));
        Vec3 const f1 = joint_force_.view().load<3>(k), f2 = group_.is_last[k] ? Vec3::zero() : joint_force_.view().load<3>(k + 1);
        double terms = norm(centripetal) + group_.inverse_mass.view().at(k, 0) * (norm(force_[k]) + norm(f1) + norm(f2));
        for (Vec3 const& moment :
             {momentum_[k], cross(group_.r1[k], transposed_times(to_ground, f1)), cross(group_.r2[k], transposed_times(to_ground, f2))})
            terms += norm(cross(as_symmetric(group_.inverse_inertia[k]) * moment, r));
        return {acceleration_[k] + to_ground * (cross(alpha_[k], r) + centripetal), terms};
    }
    double newton_euler_residual(std::int64_t k) const {
        Mat3 const r = turn(orientation_, k);
        Vec3 const f1 = joint_force_.view().load<3>(k), f2 = group_.is_last[k] ? Vec3::zero() : joint_force_.view().load<3>(k + 1);
        Vec3 const ma = group_.mass.view().at(k, 0) * acceleration_[k];
        double const newton = relative(norm(ma - force_[k] - f1 + f2), norm(ma) + norm(force_[k]) + norm(f1) + norm(f2));
        Vec3 const w = observed_omega_[k], j_alpha = as_symmetric(group_.inertia[k]) * alpha_[k];
        Vec3 const gyroscopic = cross(w, as_symmetric(group_.inertia[k]) * w);
        Vec3 const t1 = cross(group_.r1[k], transposed_times(r, f1)), t2 = cross(group_.r2[k], transposed_times(r, f2));
        double const euler = relative(norm(j_alpha + gyroscopic - torque_[k] - t1 + t2),
                                      norm(j_alpha) + norm(gyroscopic) + norm(torque_[k]) + norm(t1) + norm(t2));
        return larger(newton, euler);
    }

    ChainGroup const& group_;
    Executor const& executor_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    BodyLoads given_;
    std::vector<PrincipalFrame> principal_;
    double reach_ = 0;  // longest distance of a joint from its bodies' centres
    Field<3> position_, velocity_, omega_;
    Field<4> orientation_;
    Field<3> observed_velocity_, observed_omega_, force_, torque_, joint_torque_, momentum_, angular_momentum_, acceleration_, alpha_;
    Field<3> trial_position_, trial_omega_;
    Field<4> trial_orientation_;
    Field<3> outboard_point_;
    DirectionsField bias_, joint_force_;
};

}  // namespace

std::unique_ptr<AbsoluteDynamics> make_body_dynamics(ChainGroup const& group, Scene const& scene, Executor const& executor,
                                                     Communicator const& communicator, std::unique_ptr<ChainSolver> solver) {
    return std::make_unique<BodyDynamics>(group, scene, executor, communicator, std::move(solver));
}

}  // namespace catena
