// Implements Simulation: the steps of a run without its files.
#include "catena/simulation.hpp"

#include <cmath>
#include <utility>

#include "catena/checkpoint_bytes.hpp"
#include "catena/content.hpp"
#include "catena/own_forces.hpp"
#include "catena/start.hpp"
#include "integrate/checked_steps.hpp"
#include "integrate/checkpoint_values.hpp"
#include "integrate/step_failure.hpp"
#include "integrate/stepper.hpp"
#include "measure/run_start.hpp"
#include "observe/observables.hpp"
#include "run/branch.hpp"
#include "tree/tree.hpp"

namespace catena {
namespace {

/// Place of messages about checkpoints, and names of what one holds.
constexpr char const *restoring = "Simulation::restore", *array_of_watch = "sweep_watch",
                     *note_of_tree = "tree_table", *whether_own_force = "own_force";

/// Returns the scene as `catena run` would begin with. Throws InputError if it has no dynamics.
Scene with_dynamics(Scene scene, Communicator const& alone) {
    if (!scene.dynamics.given)
        throw InputError("the scene has no dynamics section", scene.file,
                         "set `dynamics` to {integrator: ..., step: ...}");
    look_before_run(scene, alone);
    refuse_refinement(scene);
    return scene;
}
Axes axes_of(Scene const& scene) {
    return uses_joint_coordinates(scene.dynamics.integrator) ? Axes::joint : Axes::world;
}
double implicit_step_of(Scene const& scene) {
    return is_implicit(scene.dynamics.integrator) ? scene.dynamics.step : 0.0;
}

/// Returns the start of a scene in memory.
Scene start_in_memory(Scene const& given, bool is_forced, Communicator const& alone) {
    if (is_forced) refuse_own_forces_on_gpu(given);
    Scene const scene = with_dynamics(given, alone);
    return start_of(scene, axes_of(scene), is_forced, alone);
}

/// Appends consecutive bodies of the scene to a state.
void append(SimulationState& state, SceneBodies const& bodies) {
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
    Content(Scene const& scene, OwnForce const& force)
        : Content(start_in_memory(scene, force != nullptr, *serial_communicator()), force, {}) {}

    std::int64_t run(std::int64_t steps, AfterStep const& after_step) {
        if (steps < 0)
            throw InputError("the number of steps is " + std::to_string(steps), "Simulation::run",
                             "give 0 or more");
        std::int64_t const first = step_;
        bool goes_on = true;
        while (goes_on && step_ - first < steps) {
            guarded([&] { take_step(); });
            goes_on = !after_step || after_step(step_);
        }
        guarded([&] { look(); });
        return step_ - first;
    }

    SimulationState state() {
        SimulationState state;
        guarded([&] { state = present(); });
        return state;
    }

    std::string checkpoint() {
        guarded([&] { look(); });  // steps that left joints open are not repeated after a restart
        Checkpoint c;
        c.step = step_;
        c.time = time();
        c.scene_hash = scene_.hash;
        keep_values(scene_, c.notes);
        c.notes[note_of_tree] = std::to_string(dca::tree_table_version);
        c.integers[whether_own_force] = force_ ? 1 : 0;
        c.arrays[array_of_step] = {scene_.dynamics.step};
        c.arrays[array_of_watch] = watch_.state();
        stepper_->save(c);
        CheckpointParts const parts(system_);
        OwnState own = parts.own_state();
        stepper_->save(own);
        c.arrays.merge(parts.gathered(own));
        return bytes_of(c);
    }

    /// Returns a simulation of the same scene at the state of a checkpoint.
    std::unique_ptr<Content> restored(std::string const& bytes) const {
        Checkpoint const c = checkpoint_of(bytes);
        require_own(c, scene_, restoring);
        if (counter_of(c, whether_own_force, 0, 1) != (force_ ? 1 : 0))
            throw InputError("the checkpoint was made with another choice of own force", restoring,
                             "make the Simulation with the same force");
        auto const tree = c.notes.find(note_of_tree);
        if (tree == c.notes.end() || tree->second != std::to_string(dca::tree_table_version))
            throw InputError("the checkpoint was made with another tree table", restoring,
                             "continue with the version that made it");
        return std::unique_ptr<Content>(new Content(scene_, force_, &c));
    }

    std::vector<std::string> notes() const {
        std::vector<std::string> notes = scene_.notes;
        if (std::string const note = stepper_->note_of_sweeps(); !note.empty())
            notes.push_back(note);
        return notes;
    }
    std::int64_t step() const { return step_; }
    double time() const { return static_cast<double>(step_) * scene_.dynamics.step; }

  private:
    /// Begins at a prepared start, or at a checkpoint of the same scene.
    Content(Scene start, OwnForce const& force, Checkpoint const* from)
        : alone_(serial_communicator()),
          scene_(std::move(start)),
          dof_(degrees_of_freedom(scene_)),
          force_(force),
          system_(scene_, axes_of(scene_), *alone_, implicit_step_of(scene_)) {
        if (force_) forces_.emplace(force_, system_);
        stepper_ = make_stepper(system_, scene_.dynamics);
        if (from) restore(*from);
        prepare();
        if (from) {
            look();
        } else {
            if (system_.openmm()) look_at_start(system_);
            check();
        }
    }

    void restore(Checkpoint const& c) {
        system_.set_state(c.arrays);
        stepper_->restore(c);
        if (std::vector<double> const watch = few_numbers_of(c, array_of_watch, 2); !watch.empty())
            watch_.set_state(watch);
        step_ = c.step;
    }
    /// Runs `action`. A failure leaves the state between two steps, where nothing can go on.
    template <class Action>
    void guarded(Action const& action) {
        if (failed_)
            throw ComputationError("the simulation has failed after step " + std::to_string(step_) +
                                   ": restore a checkpoint, or make a new Simulation");
        failed_ = true;
        action();
        failed_ = false;
    }
    void take_step() {
        at_step([&] { stepper_->step(step_, nullptr); });
        stepper_->note_error(step_);
        ++step_;
        prepare();
        check();
    }
    SimulationState present() {
        SimulationState state;
        stepper_->observe({true, true});
        Snapshots const snapshots(system_);
        state.step = step_;
        state.time = time();
        snapshots.pass(snapshots.own(true, true),
                       [&](SceneBodies const& bodies) { append(state, bodies); });
        state.kinetic_energy = kinetic_energy(scene_, system_.snapshot());
        if (has_temperature(scene_) && (!scene_.si || has_thermostat(scene_.dynamics)))
            state.temperature = temperature_of(scene_, dof_, state.kinetic_energy);
        for (EnergyTerm const& term : system_.potential_energy())
            state.potential_energy.emplace_back(term.name, term.value);
        if (forces_ && forces_->energy())
            state.potential_energy.emplace_back("own force", *forces_->energy());
        state.constraint_error = error_;
        return state;
    }
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
    std::int64_t dof_;
    OwnForce force_;  // kept for restored()
    ChainSystem system_;
    std::optional<OwnForces> forces_;
    std::unique_ptr<Stepper> stepper_;
    SweepWatch watch_;
    std::int64_t step_ = 0;
    double error_ = 0;
    bool failed_ = false;
};

Simulation::Simulation(Model const& model, OwnForce force)
    : content_(with_public_errors(
          [&] { return std::make_unique<Content>(model.content().scene(), std::move(force)); })) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

std::int64_t Simulation::run(std::int64_t steps, AfterStep const& after_step) {
    return with_public_errors([&] { return content_->run(steps, after_step); });
}
SimulationState Simulation::state() {
    return with_public_errors([&] { return content_->state(); });
}
std::int64_t Simulation::step() const { return content_->step(); }
double Simulation::time() const { return content_->time(); }
std::vector<std::string> Simulation::notes() const { return content_->notes(); }
std::string Simulation::checkpoint() {
    return with_public_errors([&] { return content_->checkpoint(); });
}
void Simulation::restore(std::string const& checkpoint) {
    content_ = with_public_errors([&] { return content_->restored(checkpoint); });
}

}  // namespace catena
