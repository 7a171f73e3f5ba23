#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "integrate/absolute_dynamics.hpp"
#include "integrate/link_geometry.hpp"

namespace catena {

StateArray const& array_named(std::vector<StateArray> const& arrays, std::string const& name) {
    auto const found = std::find_if(arrays.begin(), arrays.end(), [&](StateArray const& a) { return a.name == name; });
    if (found == arrays.end()) throw ComputationError("the state lacks the array " + name);
    return *found;
}

namespace {

class BeadDynamics final : public AbsoluteDynamics {
  public:
    BeadDynamics(ChainGroup const& group, Scene const& scene, Executor const& executor, Communicator const& communicator,
                 std::unique_ptr<ChainSolver> solver)
        : group_(group),
          executor_(executor),
          communicator_(communicator),
          solver_(std::move(solver)),
          gravity_(scene.forces.gravity),
          anchor_(group.partition.trees.size(), Vec3::zero()),
          position_(group.size),
          velocity_(group.size),
          observed_(group.size),
          force_(group.size),
          momentum_(group.size),
          change_(group.size),
          direction_(group.size),
          tip_direction_(group.has_tips() ? group.size : 0),
          bias_(group.size + 1, group.directions),
          joint_force_(group.size + 1, group.directions),
          tip_bias_(group.has_tips() ? group.size : 0, group.directions),
          tip_force_(group.has_tips() ? group.size : 0, group.directions) {
        for (dca::Piece const& piece : group.pieces) {
            BeadArrays const& beads = scene.chains[group.chain[piece.chain]].beads;
            anchor_[piece.chain] = beads.anchor;
            for (std::int64_t i = 0; i < piece.count; ++i) {
                position_.set(piece.local + i, beads.position[piece.body + i]);
                velocity_.set(piece.local + i, beads.velocity[piece.body + i]);
            }
        }
        for (LocalTip const& tip : group.tips)
            tip_length_.push_back(tip.joint.length > 0 ? tip.joint.length : norm(*tip.joint.anchor - position_[tip.body]));
    }

    void update_configuration() override {
        exchange_from_inboard(communicator_, group_, position_.view());
        exchange_from_outboard(communicator_, group_, position_.view());
        std::int64_t const joints = group_.size + (group_.neighbour_outboard >= 0 ? 1 : 0);
        executor_.for_each(joints, [&](std::int64_t k) {
            if (!has_link(k)) return direction_.set(k, Vec3::zero());
            Vec3 const d = link(k);
            direction_.set(k, (1.0 / norm(d)) * d);
        });
        for (std::size_t i = 0; i < tip_length_.size(); ++i) {
            Vec3 const d = tip_link(i);
            tip_direction_.set(group_.tips[i].body, (1.0 / norm(d)) * d);
        }
    }
    void assemble_matrices() override {
        solver_->assemble_matrices({direction_.view(), {}, group_.has_tips() ? tip_direction_.view() : View<3>{}, {}, {}});
    }
    void set_simple_forces() override {
        executor_.for_each(group_.size, [&](std::int64_t k) { force_.set(k, group_.mass.view().at(k, 0) * gravity_); });
    }
    View<3> bead_forces() override { return force_.view(); }
    ConstView<3> bead_positions() override { return position_.view(); }
    void take_bead_forces() override {}

    void kick(double h) override { project(h, velocity_.view()); }
    void observe(double h) override { project(h, observed_.view()); }

    void drift(double h, int sweeps) override {
        executor_.for_each(group_.size, [&](std::int64_t k) { position_.set(k, plus_scaled(position_[k], h, velocity_[k])); });
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            exchange_from_inboard(communicator_, group_, position_.view());
            executor_.for_each(group_.size,
                               [&](std::int64_t k) { set_bias(k, has_link(k) ? excess(link(k), direction_[k], length(k)) : 0.0); });
            for (std::size_t i = 0; i < tip_length_.size(); ++i)
                tip_bias_.view().origin[group_.tips[i].body] = excess(tip_link(i), tip_direction_[group_.tips[i].body], tip_length_[i]);
            solver_->solve({{}, {}, {}, bias_.view(), of_tips(group_, tip_bias_)}, {{}, change_.view(), {}, {}});
            executor_.for_each(group_.size, [&](std::int64_t k) {
                Vec3 const change = change_[k];
                position_.set(k, position_[k] + change);
                velocity_.set(k, plus_scaled(velocity_[k], 1.0 / h, change));
            });
        }
    }

    void thermostat(double c, double kt, std::uint64_t seed, std::uint64_t step) override {
        double const spread = std::sqrt((1.0 - c * c) * kt);
        executor_.for_each(group_.size, [&](std::int64_t k) {
            Vec3 const noise = normal3(seed, step, static_cast<std::uint64_t>(group_.scene_index(k)), NoiseStage::thermostat);
            velocity_.set(k, plus_scaled(c * velocity_[k], spread * std::sqrt(group_.inverse_mass.view().at(k, 0)), noise));
        });
        kick(0.0);
    }
    void draw_velocities(double kt, std::uint64_t seed, std::vector<bool> const& of_chain) override {
        for (dca::Piece const& piece : group_.pieces)
            for (std::int64_t k = piece.local; of_chain[piece.chain] && k < piece.local + piece.count; ++k) {
                Vec3 const noise = normal3(seed, 0, static_cast<std::uint64_t>(group_.scene_index(k)), NoiseStage::start);
                velocity_.set(k, std::sqrt(kt * group_.inverse_mass.view().at(k, 0)) * noise);
            }
        kick(0.0);
    }

    double constraint_error() override {
        exchange_from_inboard(communicator_, group_, position_.view());
        double error = 0;
        for (std::int64_t k = 0; k < group_.size; ++k) {
            if (!has_link(k)) continue;
            error = larger(error, std::abs(norm(link(k)) - length(k)) / length(k));
        }
        for (std::size_t i = 0; i < tip_length_.size(); ++i)
            error = larger(error, std::abs(norm(tip_link(i)) - tip_length_[i]) / tip_length_[i]);
        return communicator_.max(error);
    }

    std::vector<StateArray> state() const override {
        return {to_array<3>("position", position_.view()), to_array<3>("velocity", velocity_.view())};
    }
    void set_state(std::vector<StateArray> const& arrays) override {
        from_array<3>(array_named(arrays, "position"), position_.view());
        from_array<3>(array_named(arrays, "velocity"), velocity_.view());
    }
    std::vector<StateArray> observed_state() const override { return {to_array<3>("velocity", observed_.view())}; }

    void evaluate() override {
        exchange_from_inboard(communicator_, group_, observed_.view());
        executor_.for_each(group_.size, [&](std::int64_t k) { set_bias(k, has_link(k) ? swing_of(k) : 0.0); });
        for (std::size_t i = 0; i < tip_length_.size(); ++i) tip_bias_.view().origin[group_.tips[i].body] = tip_swing(i);
        solver_->solve({{}, force_.view(), {}, bias_.view(), of_tips(group_, tip_bias_)},
                       {{}, change_.view(), joint_force_.view(), of_tips(group_, tip_force_)});
    }
    BodyResults results() const override {
        BodyResults r;
        for (std::int64_t k = 0; k < group_.size; ++k) {
            r.acceleration.push_back(change_[k]);
            Vec3 const f = joint_force_.view().load<1>(k)[0] * direction_[k];
            r.joint_force.push_back({{0, 0, 0, f[0], f[1], f[2]}});
        }
        for (LocalTip const& tip : group_.tips) {
            Vec3 const f = outboard_force(tip.body);
            r.tip_force.push_back({group_.scene_chain(tip.body), {{0, 0, 0, -f[0], -f[1], -f[2]}}});
        }
        return r;
    }
    double residual() override {
        Field<4> terms(group_.size);  // acceleration and the size of what each force adds to it
        double worst = 0;
        for (std::int64_t k = 0; k < group_.size; ++k) {
            Vec3 const ma = group_.mass.view().at(k, 0) * change_[k], f = force_[k];
            Vec3 const inboard = joint_force_.view().load<1>(k)[0] * direction_[k];
            Vec3 const outboard = outboard_force(k);
            double const size = norm(f) + norm(inboard) + norm(outboard);
            worst = larger(worst, relative(norm(ma - f - inboard + outboard), norm(ma) + size));
            terms.set(k, {{change_[k][0], change_[k][1], change_[k][2], group_.inverse_mass.view().at(k, 0) * size}});
        }
        exchange_from_inboard(communicator_, group_, terms.view());
        for (std::size_t i = 0; i < tip_length_.size(); ++i) {
            std::int64_t const k = group_.tips[i].body;
            worst = larger(worst, relative(tip_swing(i) - dot(tip_direction_[k], change_[k]), terms[k][3] + tip_swing(i)));
        }
        for (std::int64_t k = 0; k < group_.size; ++k) {
            if (!has_link(k)) continue;
            Vector<double, 4> const mine = terms[k], before = to_ground(k) ? Vector<double, 4>::zero() : terms.view().load(k - 1);
            Vec3 const across{{mine[0] - before[0], mine[1] - before[1], mine[2] - before[2]}};
            worst = larger(worst, relative(dot(direction_[k], across) + swing_of(k), mine[3] + before[3] + swing_of(k)));
        }
        return communicator_.max(worst);
    }
    PotentialEnergy potential() override {
        PotentialEnergy e;
        for (std::int64_t k = 0; k < group_.size; ++k) e.gravity.push_back(-group_.mass.view().at(k, 0) * dot(gravity_, position_[k]));
        e.springs.assign(static_cast<std::size_t>(group_.size), 0.0);
        return e;
    }
    ChainGroup const& group() const override { return group_; }
    ChainSolver const& solver() const override { return *solver_; }

  private:
    bool has_link(std::int64_t k) const { return k >= group_.size || group_.joint[k] == JointType::link; }
    bool to_ground(std::int64_t k) const { return k < group_.size && group_.is_first[k]; }
    Vec3 link(std::int64_t k) const {
        if (!to_ground(k)) return position_.view().load(k) - position_.view().load(k - 1);
        return position_.view().load(k) - anchor_[group_.partition.chain_of(group_.first_of_rank()[communicator_.rank()] + k)];
    }
    void set_bias(std::int64_t k, double value) {
        bias_.view().origin[k] = value;  // the link's direction comes first; full handles' other directions stay 0
    }
    double length(std::int64_t k) const { return group_.length.view().at(k, 0); }
    double swing_of(std::int64_t k) const {
        Vec3 const v = observed_.view().load(k) - (to_ground(k) ? Vec3::zero() : observed_.view().load(k - 1));
        return swing(v, direction_[k], length(k));
    }
    /// From the last bead to the ground.
    Vec3 tip_link(std::size_t i) const { return *group_.tips[i].joint.anchor - position_[group_.tips[i].body]; }
    double tip_swing(std::size_t i) const {
        std::int64_t const k = group_.tips[i].body;
        return swing(observed_[k], tip_direction_[k], tip_length_[i]);
    }
    Vec3 outboard_force(std::int64_t k) const {
        if (group_.has_jointed_tip(k)) return tip_force_.view().load<1>(k)[0] * tip_direction_[k];
        return group_.is_last[k] ? Vec3::zero() : joint_force_.view().load<1>(k + 1)[0] * direction_.view().load(k + 1);
    }
    /// P (v + h M^-1 f): the solver with momenta in the place of forces gives velocities in the place of accelerations.
    void project(double h, View<3> out) {
        executor_.for_each(
            group_.size, [&](std::int64_t k) { momentum_.set(k, plus_scaled(group_.mass.view().at(k, 0) * velocity_[k], h, force_[k])); });
        solver_->solve({{}, momentum_.view(), {}, {}, {}}, {{}, out, {}, {}});
    }

    ChainGroup const& group_;
    Executor const& executor_;
    Communicator const& communicator_;
    std::unique_ptr<ChainSolver> solver_;
    Vec3 gravity_;
    std::vector<Vec3> anchor_;
    Field<3> position_, velocity_, observed_, force_, momentum_, change_, direction_, tip_direction_;
    DirectionsField bias_, joint_force_, tip_bias_, tip_force_;
    std::vector<double> tip_length_;
};

}  // namespace

std::unique_ptr<AbsoluteDynamics> make_bead_dynamics(ChainGroup const& group, Scene const& scene, Executor const& executor,
                                                     Communicator const& communicator, std::unique_ptr<ChainSolver> solver) {
    return std::make_unique<BeadDynamics>(group, scene, executor, communicator, std::move(solver));
}

}  // namespace catena
