// Dynamics of chains of rigid bodies in absolute coordinates, in any Space, which holds the state.
// Bodies are on spherical joints, or on links together with point beads. Frames and units:
// rigid_bodies.hpp.
#pragma once

#include <stdexcept>

#include "dynamics/rigid/rigid_beads.hpp"
#include "dynamics/rigid/rigid_evaluation.hpp"
#include "dynamics/rigid/rigid_operators.hpp"

namespace catena {

/// Implementation of AbsoluteDynamics for rigid chains: holds their bodies and drives their steps
/// and evaluations.
template <class Space>
class RigidDynamics final : public AbsoluteDynamics, public ClosingDrifts {
  public:
    /// `solver` must read and write views of the same Space. `implicit_step` is the step length of
    /// implicit joint springs; 0 if there are none.
    RigidDynamics(ChainGroup const& group, Scene const& scene, Space const& space,
                  Communicator const& communicator, std::unique_ptr<ChainSolver> solver,
                  double implicit_step = 0)
        : solver_(std::move(solver)),
          bodies_(group, scene, space, communicator, *solver_, implicit_step),
          beads_(bodies_) {}

    void update_configuration() override { rigid_bodies::update_configuration(bodies_); }
    void assemble_matrices() override {
        held([&] { solver_->assemble_matrices(bodies_.configuration()); });
    }
    void set_simple_forces() override { rigid_bodies::set_simple_forces(bodies_); }
    View<3> bead_forces() override { return bodies_.loads.beads.bead_forces(); }
    ConstView<3> bead_positions() override { return beads_.host_positions(); }
    void take_bead_forces() override { rigid_bodies::take_bead_forces(bodies_); }
    /// Null on the host.
    DeviceBeads* on_device() override { return beads_.stream() ? &beads_ : nullptr; }

    void kick(double h) override { rigid_bodies::kick(bodies_, h); }
    void observe(double h) override {
        rigid_bodies::project(bodies_, h, bodies_.observed.velocity.view(),
                              bodies_.observed.omega.view());
    }
    void drift(double h, int sweeps) override { rigid_bodies::drift(bodies_, h, sweeps); }
    int drift_closing(double h, int sweeps, Closing const& closing) override {
        return rigid_bodies::drift_closing(bodies_, h, sweeps, closing);
    }
    void thermalise(Thermostat const& t, std::uint64_t step) override {
        rigid_bodies::add_noise(
            bodies_, {t, step, NoiseStage::thermostat, NoiseStage::thermostat_angular, true}, 0,
            group().size);
    }
    void draw_velocities(double kt, std::uint64_t seed,
                         std::vector<bool> const& of_chain) override {
        rigid_bodies::draw_velocities(bodies_, kt, seed, of_chain);
    }

    double constraint_error() override {
        check();
        return agreed_error();
    }
    double agreed_error() override { return bodies_.communicator.max(own_error()); }
    std::string trouble() override {
        DeferredError found;
        found.hold([&] { check(); });
        return found.text();
    }
    double own_error() override {
        bodies_.set_ends();
        return bodies_.error_at_ends();
    }
    double own_error_beyond(double /*tolerance*/) override { return own_error(); }

    std::vector<StateArray> state() const override {
        check();
        std::vector<StateArray> all = bodies_.state.arrays(bodies_.space);
        bodies_.rotors.add_arrays(bodies_.space, all);
        return all;
    }
    void set_state(std::vector<StateArray> const& arrays) override {
        trouble_.forget();
        bodies_.state.set(bodies_.space, arrays);
        bodies_.rotors.set(bodies_.space, arrays);
    }
    ObservedMotion observed() override {
        check();
        return bodies_.observed.pull(bodies_.space, bodies_.state);
    }

    void evaluate() override {
        if (bodies_.rotors)
            throw std::logic_error("forces of implicit joints are known within a step only");
        trouble_.check();
        rigid_bodies::set_loads(bodies_);
        solver_->solve(rigid_bodies::loads(bodies_), rigid_bodies::found(bodies_));
    }
    void evaluate_at_once() override {
        rigid_bodies::set_loads(bodies_);
        solver_->assemble_and_solve(bodies_.configuration(), rigid_bodies::loads_at_once(bodies_),
                                    rigid_bodies::found(bodies_));
    }
    std::vector<double> time_at_once(int chained, int repeat) override {
        AccelerationsView out = rigid_bodies::found(bodies_);
        out.joint_force = {};
        return solver_->time_evaluations(
            bodies_.configuration(), rigid_bodies::loads_at_once(bodies_), out, chained, repeat);
    }
    BodyResults results() const override {
        check();
        return rigid_bodies::with_solution(bodies_,
                                           [](RigidSolution const& s) { return s.results(); });
    }
    double residual() override {
        check();
        return rigid_bodies::with_solution(
            bodies_, [&](RigidSolution const& s) { return s.residual(bodies_.communicator); });
    }
    PotentialEnergy potential() override {
        exchange_from_inboard(bodies_.communicator, group(), bodies_.state.orientation.view(),
                              bodies_.space);
        return potential_of(group(), bodies_.loads.given,
                            bodies_.space.read(bodies_.state.position),
                            bodies_.space.read(bodies_.state.orientation));
    }
    ChainGroup const& group() const override { return bodies_.group; }
    ChainSolver& solver() const override { return *solver_; }

  private:
    /// Runs `action`. On the host it keeps a pivot failure until the next check(); on a GPU the
    /// solver keeps it.
    template <class Action>
    void held(Action const& action) {
        if constexpr (Space::answers_at_once)
            trouble_.hold(action);
        else
            action();
    }
    /// Throws ComputationError if a pivot failure is pending on this rank.
    void check() const {
        solver_->check();
        trouble_.check();
    }

    std::unique_ptr<ChainSolver> solver_;
    RigidBodies<Space> bodies_;
    RigidBeads<Space> beads_;
    DeferredError trouble_;
};

}  // namespace catena
