// Implementation of JointDynamics in any Space.
#pragma once

#include "dynamics/joint/joint_dynamics.hpp"
#include "dynamics/joint/joint_operators.hpp"

namespace catena {

/// Holds the bodies of a group in a Space and drives their evaluations and steps.
template <class Space>
class JointDynamicsIn final : public JointDynamics {
  public:
    /// `solver` must read and write views of the same Space. `implicit_step` is the step length of
    /// implicit joint springs; 0 if there are none. The group, the scene and the communicator must
    /// outlive this object. Collective.
    JointDynamicsIn(ChainGroup const& group, Scene const& scene, Space const& space,
                    Communicator const& communicator, std::unique_ptr<ChainSolver> solver,
                    double implicit_step = 0)
        : JointDynamics(group, scene, communicator, std::move(solver)),
          bodies_({group, scene, communicator, *solver_, given_, reach_, clock_, implicit_step},
                  space) {
        if (scene.dynamics.given && is_adaptive(scene.dynamics.integrator))
            bodies_.state.pair.emplace(group);
        if (scene.solver.refine > 0) bodies_.solution.refinement.emplace(group);
        set_state(make_joint_state(group, scene));
    }

    void set_state(JointState const& s) override {
        bodies_.state.set(bodies_.space, s);
        bodies_.motion.changed_state(false);
    }
    void update(JointUpdate what) override { joint_coordinates::update(bodies_, what); }
    void solve(SolvedWith matrices) override { joint_coordinates::solve(bodies_, matrices); }
    JointRates rates(RatesOf which) const override {
        auto const& state = bodies_.state;
        return (which == RatesOf::saved ? state.saved : state.rates).read(bodies_.space);
    }
    void save_rates(JointRates const& rates) override {
        bodies_.state.saved.set(bodies_.space, rates);
    }
    void apply(JointOperation const& op, double h) override {
        bodies_.with_positions([&](auto positions) {
            joint_coordinates::apply<decltype(positions)::value>(bodies_, op, h);
        });
    }
    BodyMotion motion() override {
        joint_coordinates::move(bodies_);
        MotionFields<Space> const& fields = bodies_.motion.fields();
        BodyMotion m;
        m.joint_turn = bodies_.space.read(fields.joint_turn);
        m.orientation = bodies_.space.read(fields.orientation);
        m.omega = bodies_.space.read(fields.omega);
        m.origin = bodies_.space.read(fields.origin);
        m.velocity = bodies_.space.read(fields.velocity);
        m.r2 = bodies_.space.read(fields.r2);
        m.axes2 = bodies_.space.read(fields.axes2);
        return m;
    }

    View<3> bead_forces() override { return bodies_.loads.beads.bead_forces(); }
    ConstView<3> bead_positions() override { return bodies_.loads.beads.bead_positions(); }
    /// The next solution includes these forces, also after JointUpdate::velocities.
    void take_bead_forces() override {
        bodies_.loads.beads.take_bead_forces();
        if (bodies_.loads.left == LoadsLeft::nothing) bodies_.loads.leave_beads();
    }

  protected:
    JointState read_state() const override { return bodies_.state.read(bodies_.space); }
    double largest(JointMeasure const& of) override {
        return joint_coordinates::largest(bodies_, of);
    }
    void with_solution(std::function<void(JointSolution const&)> const& use) override {
        joint_coordinates::with_solution(bodies_, use);
    }
    void add_response(JointDefect const& defect) override {
        joint_coordinates::add_response(bodies_, defect);
    }
    std::vector<double> time_chained(int chained, int repeat,
                                     std::function<void()> const& action) const override {
        return bodies_.space.time_chained(chained, repeat, communicator_.size() > 1, action);
    }

  private:
    JointBodies<Space> bodies_;
};

}  // namespace catena
