#include <algorithm>

#include "chain/joint_kinematics.hpp"
#include "integrate/rigid_dynamics.hpp"

namespace catena {
namespace {

/// Bodies on spherical joints.
class SphericalDynamics final : public RigidDynamics {
  public:
    SphericalDynamics(ChainGroup const& group, Scene const& scene, Executor const& executor, Communicator const& communicator,
                      std::unique_ptr<ChainSolver> solver)
        : RigidDynamics(group, scene, executor, communicator, std::move(solver)), joint_torque_(group.size) {
        start_from_joint_coordinates(scene);
        for (std::int64_t k = 0; k < group.size; ++k)
            reach_ = std::max({reach_, norm(group.r1[k]), norm(group.r2[k]),
                               radius_of_gyration(as_symmetric(group.inertia[k]), group.mass.view().at(k, 0))});
        reach_ = communicator.max(reach_);
        for (LocalTip const& tip : group.tips) pin_.push_back(position_[tip.body] + turn(orientation_, tip.body) * group.r2[tip.body]);
    }

    void update_configuration() override {
        if (given_.springs) exchange_from_inboard(communicator_, group_, orientation_.view());
    }

    double constraint_error() override {
        set_outboard_points(position_, orientation_);
        double error = 0;
        for (std::int64_t k = 0; k < group_.size; ++k) error = larger(error, norm(gap(k, position_, orientation_)) / reach_);
        for (std::size_t i = 0; i < pin_.size(); ++i) error = larger(error, norm(pin_[i] - outboard_point_[group_.tips[i].body]) / reach_);
        return communicator_.max(error);
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

  protected:
    ConfigurationView configuration() override { return {{}, orientation_.view(), {}, {}, {}}; }
    void set_openings(double scale, Field<3> const& position, Field<4> const& orientation) override {
        executor_.for_each(group_.size, [&](std::int64_t k) { set_bias(k, scale * gap(k, position, orientation)); });
        for (std::size_t i = 0; i < pin_.size(); ++i)
            set_tip_bias(group_.tips[i].body, scale * (pin_[i] - outboard_point_[group_.tips[i].body]));
    }
    /// The bodies' centripetal terms are all there is.
    void set_velocity_biases() override {
        executor_.for_each(group_.size, [&](std::int64_t k) { set_bias(k, Vec3::zero()); });
        for (LocalTip const& tip : group_.tips) set_tip_bias(tip.body, Vec3::zero());
    }
    void add_joint_torques() override {
        if (!given_.joint_loads) return;
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
        executor_.for_each(group_.size, [&](std::int64_t k) {
            Vec3 torque = torque_[k] + joint_torque_[k];
            if (!group_.is_last[k]) torque = torque - joint_torque_.view().load(k + 1);
            torque_.set(k, torque);
        });
    }
    Vec3 joint_force(std::int64_t k) const override { return joint_force_.view().load<3>(k); }
    Vec3 tip_force(std::int64_t k) const override { return tip_force_.view().load<3>(k); }
    double closing(std::int64_t, Vec3 const& difference, double terms) const override { return relative(norm(difference), terms); }
    double tip_closing(std::int64_t, Vec3 const& difference, double terms) const override { return relative(norm(difference), terms); }

  private:
    void start_from_joint_coordinates(Scene const& scene) {
        HostSpace const host(executor_);
        JointState start = make_joint_state(group_, scene);
        BodyMotion motion(group_, host);
        JointKinematics(group_, host, communicator_).evaluate(start.view(), true, motion.view());
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
    /// Handle 1 of body k from handle 2 of its inboard neighbour, W.
    Vec3 gap(std::int64_t k, Field<3> const& position, Field<4> const& orientation) const {
        if (group_.joint[k] == JointType::free) return Vec3::zero();
        Vec3 const inboard = group_.is_first[k] ? group_.joint_translation[k] : outboard_point_.view().load(k - 1);
        return inboard_point(k, position, orientation) - inboard;
    }

    double reach_ = 0;       // longest distance of a joint from its bodies' centres, or a body's radius of gyration
    std::vector<Vec3> pin_;  // where the local tips are held, W
    Field<3> joint_torque_;  // of joint k on body k, W; halo from outboard
};

}  // namespace

std::unique_ptr<AbsoluteDynamics> make_spherical_dynamics(ChainGroup const& group, Scene const& scene, Executor const& executor,
                                                          Communicator const& communicator, std::unique_ptr<ChainSolver> solver) {
    return std::make_unique<SphericalDynamics>(group, scene, executor, communicator, std::move(solver));
}

}  // namespace catena
