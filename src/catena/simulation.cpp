// Implements Simulation: the steps of a run without its files.
#include "catena/simulation.hpp"

#include <cmath>
#include <utility>

#include "catena/content.hpp"
#include "catena/own_forces.hpp"
#include "catena/start.hpp"
#include "integrate/checked_steps.hpp"
#include "integrate/step_failure.hpp"
#include "integrate/stepper.hpp"
#include "observe/observables.hpp"

namespace catena {
namespace {

Scene const& with_dynamics(Scene const& scene) {
    if (!scene.dynamics.given)
        throw InputError("the scene has no dynamics section", scene.file,
                         "set `dynamics` to {integrator: ..., step: ...}");
    refuse_refinement(scene);
    return scene;
}
Axes axes_of(Scene const& scene) {
    return uses_joint_coordinates(scene.dynamics.integrator) ? Axes::joint : Axes::world;
}
double implicit_step_of(Scene const& scene) {
    return is_implicit(scene.dynamics.integrator) ? scene.dynamics.step : 0.0;
}

/// Appends consecutive bodies of the scene to a state.
void append(SimulationState& state, ChainSystem::Bodies const& bodies) {
    for (std::size_t k = 0; k < bodies.motion.position.size(); ++k) {
        state.position.push_back(as_triple(bodies.motion.position[k]));
        state.velocity.push_back(as_triple(bodies.motion.velocity[k]));
        state.orientation.push_back(as_unit_quaternion(bodies.motion.orientation[k]));
        state.angular_velocity.push_back(as_triple(bodies.motion.omega[k]));
        state.joint_force.push_back(as_joint_force(bodies.joint_force[k]));
        state.joint_position.push_back(bodies.joint_position[k]);
        state.joint_rate.push_back(as_triple(bodies.joint_rate[k]));
    }
}

}  // namespace

class Simulation::Content {
  public:
    Content(Scene const& scene, OwnForce force)
        : alone_(serial_communicator()),
          scene_(start_of(with_dynamics(scene), axes_of(scene), force != nullptr, *alone_)),
          system_(scene_, axes_of(scene_), *alone_, implicit_step_of(scene_)) {
        if (force) forces_.emplace(std::move(force), system_);
        stepper_ = make_stepper(system_, scene_.dynamics);
        prepare();
        if (system_.openmm()) look_at_start(system_);
        check();
    }

    void run(std::int64_t steps) {
        for (std::int64_t i = 0; i < steps; ++i) {
            at_step([&] { stepper_->step(step_, nullptr); });
            stepper_->note_error(step_);
            ++step_;
            prepare();
            check();
        }
        look();
    }

    SimulationState state() {
        SimulationState state;
        stepper_->observe({true, true});
        state.step = step_;
        state.time = time();
        system_.pass_bodies(system_.own_bodies(true, true),
                            [&](ChainSystem::Bodies const& bodies) { append(state, bodies); });
        state.kinetic_energy = kinetic_energy(scene_, system_.snapshot());
        for (EnergyTerm const& term : system_.potential_energy())
            state.potential_energy.emplace_back(term.name, term.value);
        if (forces_ && forces_->energy())
            state.potential_energy.emplace_back("own force", *forces_->energy());
        state.constraint_error = error_;
        return state;
    }
    std::int64_t step() const { return step_; }
    double time() const { return static_cast<double>(step_) * scene_.dynamics.step; }

  private:
    /// Looks at the steps where a run does, and adds a sweep if one is due.
    void check() {
        if (!is_checked(step_) && step_ % scene_.output.every != 0) return;
        look();
        stepper_->adapt(watch_, error_, scene_.dynamics.constraint_tolerance);
    }
    /// Computes forces and matrices. Steps that tore joints open are repeated.
    void prepare() {
        try {
            at_step([&] { stepper_->prepare(nullptr); });
        } catch (ComputationError const&) {
            if (!stepper_->mend(step_)) throw;
        }
    }
    /// Runs `action` and adds the step to its failures.
    template <class Action>
    void at_step(Action const& action) {
        try {
            action();
        } catch (ComputationError const& error) {
            throw ComputationError(failure_in_step(step_, error.what(), scene_, step_ > 0));
        }
    }
    /// Checks the constraints, and repeats steps that left joints open.
    void look() {
        error_ = stepper_->look(step_);
        if (!std::isfinite(error_))
            throw ComputationError("the state is not finite at step " + std::to_string(step_) +
                                   ": choose a smaller dynamics.step, or look at the start");
    }

    std::unique_ptr<Communicator> alone_;
    Scene scene_;
    ChainSystem system_;
    std::optional<OwnForces> forces_;
    std::unique_ptr<Stepper> stepper_;
    SweepWatch watch_;
    std::int64_t step_ = 0;
    double error_ = 0;
};

Simulation::Simulation(Model const& model, OwnForce force)
    : content_(with_public_errors(
          [&] { return std::make_unique<Content>(model.content().scene(), std::move(force)); })) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

void Simulation::run(std::int64_t steps) {
    with_public_errors([&] { content_->run(steps); });
}
SimulationState Simulation::state() {
    return with_public_errors([&] { return content_->state(); });
}
std::int64_t Simulation::step() const { return content_->step(); }
double Simulation::time() const { return content_->time(); }

}  // namespace catena
