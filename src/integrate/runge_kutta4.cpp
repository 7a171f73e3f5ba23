#include <utility>

#include "integrate/joint_integrators.hpp"

namespace catena {
namespace {

bool has_quaternion(JointType type) { return type == JointType::spherical || type == JointType::free; }

class RungeKutta4 final : public JointIntegrator {
  public:
    explicit RungeKutta4(ChainSystem& system) : system_(system), groups_(system.joint()) {
        for (JointDynamics const* group : groups_) rates_.push_back(group->make_rates());
    }
    int evaluations_a_step() const override { return 4; }

    void step(std::vector<JointState>& states, double h) override {
        start_ = states;
        sum_ = states;  // start + h/6 (k1 + 2 k2 + 2 k3 + k4)
        stage_ = states;
        double const weight[4] = {h / 6, h / 3, h / 3, h / 6}, next[3] = {h / 2, h / 2, h};
        for (int i = 0; i < 4; ++i) {
            system_.evaluate(stage_, rates_);
            for (std::size_t g = 0; g < groups_.size(); ++g) {
                advance(g, sum_[g], stage_[g], weight[i], sum_[g]);
                if (i == 3) continue;
                JointState const at = stage_[g];
                advance(g, start_[g], at, next[i], stage_[g]);
                stage_[g].time = start_[g].time + next[i];
                follow_courses(groups_[g]->group(), stage_[g]);
            }
        }
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            ChainGroup const& group = groups_[g]->group();
            JointState& sum = sum_[g];
            for (std::int64_t k = 0; k < group.size; ++k)
                if (has_quaternion(group.joint[k])) sum.q.set(k, as_vector(normalized(as_quaternion(sum.q[k]))));
            std::swap(states[g], sum);
            states[g].time = start_[g].time + h;
            follow_courses(group, states[g]);
        }
    }

  private:
    /// state <- start + h (derivative of the positions at `at`, rates)
    void advance(std::size_t g, JointState const& start, JointState const& at, double h, JointState& state) const {
        ChainGroup const& group = groups_[g]->group();
        JointRates const& rates = rates_[g];
        for (std::int64_t k = 0; k < group.size; ++k) {
            Vec3 const w = at.qd[k];
            Vector<double, 4> rate{{w[0], w[1], 0, 0}};
            if (has_quaternion(group.joint[k])) {
                Quat const r = as_quaternion(at.q[k]) * Quat{0, w[0], w[1], w[2]};
                rate = {{0.5 * r.w, 0.5 * r.x, 0.5 * r.y, 0.5 * r.z}};
            }
            state.q.set(k, plus_scaled(start.q[k], h, rate));
            state.qd.set(k, plus_scaled(start.qd[k], h, rates.qdd[k]));
        }
        for (std::size_t p = 0; p < group.pieces.size(); ++p) {
            state.base_position[p] = plus_scaled(start.base_position[p], h, at.base_velocity[p]);
            state.base_velocity[p] = plus_scaled(start.base_velocity[p], h, rates.base_acceleration[p]);
        }
    }
    ChainSystem& system_;
    std::vector<JointDynamics*> groups_;
    std::vector<JointState> stage_, start_, sum_;
    std::vector<JointRates> rates_;
};

}  // namespace

std::unique_ptr<JointIntegrator> make_runge_kutta4(ChainSystem& system) { return std::make_unique<RungeKutta4>(system); }

}  // namespace catena
