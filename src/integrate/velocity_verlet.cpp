#include <utility>

#include "integrate/joint_integrators.hpp"

namespace catena {
namespace {

class VelocityVerlet final : public JointIntegrator {
  public:
    explicit VelocityVerlet(JointDynamics& dynamics) : dynamics_(dynamics), rates_(dynamics.make_rates()), next_(dynamics.make_rates()) {}
    int evaluations_a_step() const override { return 1; }
    JointRates* carried() override { return &rates_; }
    void restored() override { ready_ = true; }

    void step(JointState& state, double h) override {
        if (!ready_) dynamics_.evaluate(state, rates_);
        ready_ = true;
        start_ = state;
        ChainGroup const& group = dynamics_.group();
        move(state, h);
        state.time = start_.time + h;
        add_to_velocities(start_, h, rates_, state);
        follow_courses(group, state);
        dynamics_.evaluate(state, next_);
        add_to_velocities(start_, 0.5 * h, rates_, state);
        add_to_velocities(state, 0.5 * h, next_, state);
        follow_courses(group, state);
        std::swap(rates_, next_);
        dynamics_.close_tips(state);
    }

  private:
    void move(JointState& state, double h) const {
        ChainGroup const& group = dynamics_.group();
        for (std::int64_t k = 0; k < group.size; ++k) {
            Vec3 const by = plus_scaled(h * state.qd[k], 0.5 * h * h, rates_.qdd[k]);
            Vector<double, 4> const q = state.q[k];
            if (group.joint[k] == JointType::spherical || group.joint[k] == JointType::free)
                state.q.set(k, as_vector(normalized(as_quaternion(q) * from_rotation_vector(by))));
            else
                state.q.set(k, {{q[0] + by[0], q[1] + by[1], 0, 0}});
        }
        for (std::size_t p = 0; p < group.pieces.size(); ++p)
            state.base_position[p] =
                state.base_position[p] + plus_scaled(h * state.base_velocity[p], 0.5 * h * h, rates_.base_acceleration[p]);
    }
    static void add_to_velocities(JointState const& from, double h, JointRates const& rates, JointState& to) {
        for (std::int64_t k = 0; k < from.qd.size(); ++k) to.qd.set(k, plus_scaled(from.qd[k], h, rates.qdd[k]));
        for (std::size_t p = 0; p < from.base_velocity.size(); ++p)
            to.base_velocity[p] = plus_scaled(from.base_velocity[p], h, rates.base_acceleration[p]);
    }

    JointDynamics& dynamics_;
    JointState start_;
    JointRates rates_, next_;
    bool ready_ = false;
};

}  // namespace

std::unique_ptr<JointIntegrator> make_velocity_verlet(JointDynamics& dynamics) { return std::make_unique<VelocityVerlet>(dynamics); }

}  // namespace catena
