#include <utility>

#include "integrate/joint_integrators.hpp"

namespace catena {
namespace {

class VelocityVerlet final : public JointIntegrator {
  public:
    explicit VelocityVerlet(ChainSystem& system) : system_(system), groups_(system.joint()) {
        for (JointDynamics const* group : groups_) {
            rates_.push_back(group->make_rates());
            next_.push_back(group->make_rates());
        }
    }
    int evaluations_a_step() const override { return 1; }
    std::vector<JointRates>* carried() override { return &rates_; }
    void restored() override { ready_ = true; }
    void prepare(std::vector<JointState> const& states) override {
        if (!ready_) system_.evaluate(states, rates_);
        ready_ = true;
    }

    void step(std::vector<JointState>& states, double h) override {
        prepare(states);
        start_ = states;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            move(g, states[g], h);
            states[g].time = start_[g].time + h;
            add_to_velocities(start_[g], h, rates_[g], states[g]);
            follow_courses(groups_[g]->group(), states[g]);
        }
        system_.evaluate(states, next_);
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            add_to_velocities(start_[g], 0.5 * h, rates_[g], states[g]);
            add_to_velocities(states[g], 0.5 * h, next_[g], states[g]);
            follow_courses(groups_[g]->group(), states[g]);
            std::swap(rates_[g], next_[g]);
        }
    }

  private:
    void move(std::size_t g, JointState& state, double h) const {
        ChainGroup const& group = groups_[g]->group();
        JointRates const& rates = rates_[g];
        for (std::int64_t k = 0; k < group.size; ++k) {
            Vec3 const by = plus_scaled(h * state.qd[k], 0.5 * h * h, rates.qdd[k]);
            Vector<double, 4> const q = state.q[k];
            if (group.joint[k] == JointType::spherical || group.joint[k] == JointType::free)
                state.q.set(k, as_vector(normalized(as_quaternion(q) * from_rotation_vector(by))));
            else
                state.q.set(k, {{q[0] + by[0], q[1] + by[1], 0, 0}});
        }
        for (std::size_t p = 0; p < group.pieces.size(); ++p)
            state.base_position[p] =
                state.base_position[p] + plus_scaled(h * state.base_velocity[p], 0.5 * h * h, rates.base_acceleration[p]);
    }
    static void add_to_velocities(JointState const& from, double h, JointRates const& rates, JointState& to) {
        for (std::int64_t k = 0; k < from.qd.size(); ++k) to.qd.set(k, plus_scaled(from.qd[k], h, rates.qdd[k]));
        for (std::size_t p = 0; p < from.base_velocity.size(); ++p)
            to.base_velocity[p] = plus_scaled(from.base_velocity[p], h, rates.base_acceleration[p]);
    }

    ChainSystem& system_;
    std::vector<JointDynamics*> groups_;
    std::vector<JointState> start_;
    std::vector<JointRates> rates_, next_;
    bool ready_ = false;
};

}  // namespace

std::unique_ptr<JointIntegrator> make_velocity_verlet(ChainSystem& system) { return std::make_unique<VelocityVerlet>(system); }

}  // namespace catena
