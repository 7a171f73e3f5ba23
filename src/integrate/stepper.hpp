// One step of a scene's integrator over everything in the scene.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "integrate/joint_integrators.hpp"
#include "integrate/sweep_watch.hpp"
#include "io/output.hpp"

namespace catena {

/// What an observer asks for beside positions and velocities; `energies`:
/// ChainSystem::potential_energy().
struct ObservedQuantities {
    bool joint_forces = false, energies = false;
};

/// Arrays of one number in checkpoints: the length of a step, the time at step 0 where it is not 0
/// (of branches with another step), and the kick that is due, in steps, where it is no whole number
/// of halves.
inline constexpr char const *array_of_step = "step_length", *array_of_origin = "time_origin",
                            *array_of_kick = "pending_kick";
/// The number in one of them, else `otherwise`.
double number_in(Checkpoint const&, char const* array, double otherwise);

/// One way to take a step. Between steps the state is that of a whole step.
class Stepper {
  public:
    virtual ~Stepper() = default;
    /// Forces, matrices and whatever else is needed at the present step. Collective.
    virtual void prepare(StepTimeline*) = 0;
    /// Velocities as an observer sees them, and what else is asked for; after prepare().
    /// Collective.
    virtual void observe(ObservedQuantities const&) = 0;
    virtual void step(std::int64_t n, StepTimeline*) = 0;
    virtual double constraint_error() = 0;
    /// After step n: how far joints are open is noted where that costs next to nothing.
    virtual void note_error(std::int64_t /*n*/) {}
    /// constraint_error() at step n, after prepare(). Steps since the last call that left joints
    /// open beyond the tolerance are taken again first, with further sweeps. Collective.
    virtual double look(std::int64_t /*n*/) { return constraint_error(); }
    /// After a prepare() at step n that failed on all ranks alike: takes steps since the last
    /// look() that left joints open again, and prepares. False where there are none. Collective.
    virtual bool mend(std::int64_t /*n*/) { return false; }
    /// What there is to say of that in the end; empty: nothing.
    virtual std::string note_of_sweeps() const { return ""; }
    /// One more projection sweep from now on where `watch` says that one is due and there is one to
    /// add. Returns whether it was added.
    bool adapt(SweepWatch& watch, double error, double tolerance);
    /// Of a drift; in joint coordinates corrections of jointed tips.
    virtual int sweeps() const = 0;
    /// That every drift is taken in.
    virtual int parts() const { return 1; }
    /// Of the last step, in joint coordinates.
    virtual SweepsAStep solved() const { return {}; }
    /// How many there were of an adaptive run; null of others.
    virtual nlohmann::json inner_steps() const;
    virtual void save(Checkpoint&) const = 0;
    /// What is carried from step to step beside the system's own state.
    virtual void save(ChainSystem::OwnState&) const {}
    virtual void restore(Checkpoint const&) = 0;
    virtual nlohmann::json describe() const = 0;
    /// As restore(), for a run that goes on from there in another way: nothing of how the
    /// checkpoint's run stepped is kept.
    virtual void branch(Checkpoint const&) = 0;

  protected:
    /// Of the tolerance: above that another sweep is due.
    virtual double early() const = 0;
    /// False where there is none to add.
    virtual bool add_sweep() = 0;
};

std::unique_ptr<Stepper> make_stepper(ChainSystem&, DynamicsSpec const&);

}  // namespace catena
