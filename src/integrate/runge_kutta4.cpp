#include <utility>

#include "integrate/joint_integrators.hpp"

namespace catena {
namespace {

bool has_quaternion(JointType type) { return type == JointType::spherical || type == JointType::free; }

class RungeKutta4 final : public JointIntegrator {
  public:
    explicit RungeKutta4(JointDynamics& dynamics) : dynamics_(dynamics), rates_(dynamics.make_rates()) {}
    int evaluations_a_step() const override { return 4; }

    void step(JointState& state, double h) override {
        start_ = state;
        sum_ = state;  // start + h/6 (k1 + 2 k2 + 2 k3 + k4)
        stage_ = state;
        double const weight[4] = {h / 6, h / 3, h / 3, h / 6}, next[3] = {h / 2, h / 2, h};
        for (int i = 0; i < 4; ++i) {
            dynamics_.evaluate(stage_, rates_);
            advance(sum_, stage_, weight[i], sum_);
            if (i == 3) break;
            JointState const at = stage_;
            advance(start_, at, next[i], stage_);
            stage_.time = start_.time + next[i];
            follow_courses(dynamics_.group(), stage_);
        }
        ChainGroup const& group = dynamics_.group();
        for (std::int64_t k = 0; k < group.size; ++k)
            if (has_quaternion(group.joint[k])) sum_.q.set(k, as_vector(normalized(as_quaternion(sum_.q[k]))));
        std::swap(state, sum_);
        state.time = start_.time + h;
        follow_courses(group, state);
        dynamics_.close_tips(state);
    }

  private:
    /// state <- start + h (derivative of the positions at `at`, rates)
    void advance(JointState const& start, JointState const& at, double h, JointState& state) const {
        ChainGroup const& group = dynamics_.group();
        for (std::int64_t k = 0; k < group.size; ++k) {
            Vec3 const w = at.qd[k];
            Vector<double, 4> rate{{w[0], w[1], 0, 0}};
            if (has_quaternion(group.joint[k])) {
                Quat const r = as_quaternion(at.q[k]) * Quat{0, w[0], w[1], w[2]};
                rate = {{0.5 * r.w, 0.5 * r.x, 0.5 * r.y, 0.5 * r.z}};
            }
            state.q.set(k, plus_scaled(start.q[k], h, rate));
            state.qd.set(k, plus_scaled(start.qd[k], h, rates_.qdd[k]));
        }
        for (std::size_t p = 0; p < group.pieces.size(); ++p) {
            state.base_position[p] = plus_scaled(start.base_position[p], h, at.base_velocity[p]);
            state.base_velocity[p] = plus_scaled(start.base_velocity[p], h, rates_.base_acceleration[p]);
        }
    }
    JointDynamics& dynamics_;
    JointState stage_, start_, sum_;
    JointRates rates_;
};

}  // namespace

std::unique_ptr<JointIntegrator> make_runge_kutta4(JointDynamics& dynamics) { return std::make_unique<RungeKutta4>(dynamics); }

}  // namespace catena
