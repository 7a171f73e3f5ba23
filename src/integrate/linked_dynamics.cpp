#include <algorithm>
#include <cmath>

#include "integrate/link_geometry.hpp"
#include "integrate/rigid_dynamics.hpp"

namespace catena {
namespace {

/// Rigid bodies and point beads on links of fixed length.
class LinkedDynamics final : public RigidDynamics {
  public:
    LinkedDynamics(ChainGroup const& group, Scene const& scene, Executor const& executor, Communicator const& communicator,
                   std::unique_ptr<ChainSolver> solver)
        : RigidDynamics(group, scene, executor, communicator, std::move(solver)),
          anchor_(group.partition.trees.size(), Vec3::zero()),
          direction_(group.size),
          tip_direction_(group.has_tips() ? group.size : 0),
          observed_end_(group.size) {
        for (dca::Piece const& piece : group.pieces) {
            LinkedArrays const& linked = scene.chains[group.chain[piece.chain]].linked;
            anchor_[piece.chain] = linked.anchor;
            for (std::int64_t i = 0; i < piece.count; ++i) {
                auto const body = static_cast<std::size_t>(piece.body + i);
                auto const& q = linked.orientation[body];
                position_.set(piece.local + i, linked.position[body]);
                velocity_.set(piece.local + i, linked.velocity[body]);
                orientation_.set(piece.local + i, {{q[0], q[1], q[2], q[3]}});
                omega_.set(piece.local + i, linked.omega[body]);
            }
        }
        for (LocalTip const& tip : group.tips) {
            Vec3 const end = position_[tip.body] + turn(orientation_, tip.body) * group.r2[tip.body];
            tip_length_.push_back(tip.joint.length > 0 ? tip.joint.length : norm(*tip.joint.anchor - end));
        }
    }

    void update_configuration() override {
        set_outboard_points(position_, orientation_);
        executor_.for_each(group_.size, [&](std::int64_t k) {
            if (!has_link(k)) return direction_.set(k, Vec3::zero());
            Vec3 const d = link(k, position_, orientation_);
            direction_.set(k, (1.0 / norm(d)) * d);
        });
        exchange_from_outboard(communicator_, group_, direction_.view());
        for (LocalTip const& tip : group_.tips) {
            Vec3 const d = *tip.joint.anchor - outboard_point_[tip.body];
            tip_direction_.set(tip.body, (1.0 / norm(d)) * d);
        }
    }

    double constraint_error() override {
        set_outboard_points(position_, orientation_);
        double error = 0;
        for (std::int64_t k = 0; k < group_.size; ++k) {
            if (!has_link(k)) continue;
            double const l = length(k);
            error = larger(error, std::abs(norm(link(k, position_, orientation_)) - l) / l);
        }
        for (std::size_t i = 0; i < tip_length_.size(); ++i) {
            Vec3 const d = *group_.tips[i].joint.anchor - outboard_point_[group_.tips[i].body];
            error = larger(error, std::abs(norm(d) - tip_length_[i]) / tip_length_[i]);
        }
        return communicator_.max(error);
    }

    PotentialEnergy potential() override {
        PotentialEnergy e;
        for (std::int64_t k = 0; k < group_.size; ++k)
            e.gravity.push_back(-group_.mass.view().at(k, 0) * dot(given_.gravity, position_[k]));
        e.springs.assign(static_cast<std::size_t>(group_.size), 0.0);
        return e;
    }

  protected:
    ConfigurationView configuration() override {
        return {direction_.view(), orientation_.view(), group_.has_tips() ? tip_direction_.view() : View<3>{}, {}, {}};
    }
    void set_openings(double scale, Field<3> const& position, Field<4> const& orientation) override {
        executor_.for_each(group_.size, [&](std::int64_t k) {
            double const open = has_link(k) ? excess(link(k, position, orientation), direction_[k], length(k)) : 0.0;
            set_bias(k, {{scale * open, 0, 0}});
        });
        for (std::size_t i = 0; i < tip_length_.size(); ++i) {
            std::int64_t const k = group_.tips[i].body;
            Vec3 const d = *group_.tips[i].joint.anchor - outboard_point_[k];
            set_tip_bias(k, {{scale * excess(d, tip_direction_[k], tip_length_[i]), 0, 0}});
        }
    }
    void set_velocity_biases() override {
        executor_.for_each(group_.size, [&](std::int64_t k) { observed_end_.set(k, handle_velocity(k, group_.r2[k])); });
        exchange_from_inboard(communicator_, group_, observed_end_.view());
        executor_.for_each(group_.size, [&](std::int64_t k) { set_bias(k, {{has_link(k) ? swing_of(k) : 0.0, 0, 0}}); });
        for (std::size_t i = 0; i < tip_length_.size(); ++i) {
            std::int64_t const k = group_.tips[i].body;
            set_tip_bias(k, {{swing(-observed_end_[k], tip_direction_[k], tip_length_[i]), 0, 0}});
        }
    }
    Vec3 joint_force(std::int64_t k) const override { return joint_force_.view().load<1>(k)[0] * direction_.view().load(k); }
    Vec3 tip_force(std::int64_t k) const override { return tip_force_.view().load<1>(k)[0] * tip_direction_[k]; }
    double closing(std::int64_t k, Vec3 const& difference, double terms) const override {
        return relative(dot(direction_[k], difference) + swing_of(k), terms + swing_of(k));
    }
    double tip_closing(std::int64_t k, Vec3 const& difference, double terms) const override {
        double const s = std::as_const(tip_bias_).view().load<1>(k)[0];
        return relative(dot(tip_direction_[k], difference) + s, terms + s);
    }

  private:
    bool has_link(std::int64_t k) const { return group_.joint[k] == JointType::link; }
    double length(std::int64_t k) const { return group_.length.view().at(k, 0); }
    /// From handle 2 of the inboard neighbour (or the anchor) to handle 1 of body k, W.
    Vec3 link(std::int64_t k, Field<3> const& position, Field<4> const& orientation) const {
        Vec3 const end = inboard_point(k, position, orientation);
        if (!group_.is_first[k]) return end - outboard_point_.view().load(k - 1);
        return end - anchor_[group_.partition.chain_of(group_.first_of_rank()[communicator_.rank()] + k)];
    }
    double swing_of(std::int64_t k) const {
        Vec3 const before = group_.is_first[k] ? Vec3::zero() : observed_end_.view().load(k - 1);
        return swing(handle_velocity(k, group_.r1[k]) - before, direction_[k], length(k));
    }

    std::vector<Vec3> anchor_;
    Field<3> direction_, tip_direction_;
    Field<3> observed_end_;  // velocity of handle 2 at the velocities observed last, W; halo from inboard
    std::vector<double> tip_length_;
};

}  // namespace

std::unique_ptr<AbsoluteDynamics> make_linked_dynamics(ChainGroup const& group, Scene const& scene, Executor const& executor,
                                                       Communicator const& communicator, std::unique_ptr<ChainSolver> solver) {
    return std::make_unique<LinkedDynamics>(group, scene, executor, communicator, std::move(solver));
}

}  // namespace catena
