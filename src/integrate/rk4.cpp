#include "integrate/rk4.hpp"

namespace catena {

RungeKutta4::RungeKutta4(JointDynamics& dynamics) : dynamics_(dynamics), rates_(dynamics.make_rates()) {}

void RungeKutta4::advance(JointState const& start, JointState const& at, JointRates const& rates, double h, JointState& state) const {
    ChainGroup const& group = dynamics_.group();
    for (std::int64_t k = 0; k < group.size; ++k) {
        Vector<double, 4> const q = at.q[k];
        Vec3 const w = at.qd[k];
        Vector<double, 4> rate{{w[0], 0, 0, 0}};
        if (group.joint[k] != JointType::revolute) {
            Quat const r = Quat{q[0], q[1], q[2], q[3]} * Quat{0, w[0], w[1], w[2]};
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

void RungeKutta4::step(JointState& state, double h) {
    start_ = state;
    sum_ = state;  // start + h/6 (k1 + 2 k2 + 2 k3 + k4)
    stage_ = state;
    double const weight[4] = {h / 6, h / 3, h / 3, h / 6}, next[3] = {h / 2, h / 2, h};
    for (int i = 0; i < 4; ++i) {
        dynamics_.evaluate(stage_, rates_);
        advance(sum_, stage_, rates_, weight[i], sum_);
        if (i < 3) {
            JointState const at = stage_;
            advance(start_, at, rates_, next[i], stage_);
        }
    }
    ChainGroup const& group = dynamics_.group();
    for (std::int64_t k = 0; k < group.size; ++k)
        if (group.joint[k] != JointType::revolute) {
            Vector<double, 4> const q = sum_.q[k];
            Quat const n = normalized(Quat{q[0], q[1], q[2], q[3]});
            sum_.q.set(k, {{n.w, n.x, n.y, n.z}});
        }
    std::swap(state, sum_);
}

}  // namespace catena
