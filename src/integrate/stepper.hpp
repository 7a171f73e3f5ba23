// Stepper: one time step of a scene's integrator for all chains of the scene.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "integrate/joint_integrators.hpp"
#include "integrate/sweep_watch.hpp"
#include "io/output.hpp"

namespace catena {

/// Quantities that an observer needs besides positions and velocities. `energies`:
/// ChainSystem::potential_energy().
struct ObservedQuantities {
    bool joint_forces = false, energies = false;
};

/// Names of checkpoint arrays that hold one number. They are the length of a step, the time at step
/// 0 if it is not 0 (branches with another step), and the kick that is due, in steps.
inline constexpr char const *array_of_step = "step_length", *array_of_origin = "time_origin",
                            *array_of_kick = "pending_kick";
/// Returns the number in one of these arrays, or `otherwise` if it is missing.
double number_in(Checkpoint const&, char const* array, double otherwise);

/// Advances a ChainSystem by time steps. Between steps the state is that of a whole step.
class Stepper {
  public:
    virtual ~Stepper() = default;
    /// Computes forces, matrices and whatever else the present step needs. Collective.
    virtual void prepare(StepTimeline*) = 0;
    /// Computes the velocities that observers use, and the other requested quantities.
    /// Precondition: prepare() was called. Collective.
    virtual void observe(ObservedQuantities const&) = 0;
    /// Advances from step n to step n + 1. Precondition: prepare() was called. Collective.
    virtual void step(std::int64_t n, StepTimeline*) = 0;
    /// Returns the largest relative constraint violation at the present state. Collective.
    virtual double constraint_error() = 0;
    /// Records the constraint violation after step n, if that costs next to nothing.
    virtual void note_error(std::int64_t /*n*/) {}
    /// Returns constraint_error() at step n, after prepare(). Steps since the last call that left
    /// joints open beyond the tolerance are first repeated with further sweeps. Collective.
    virtual double look(std::int64_t /*n*/) { return constraint_error(); }
    /// Repeats the steps since the last look() that left joints open, and prepares. To be called
    /// after a prepare() at step n that failed on all ranks. Returns false if there are no such
    /// steps. Collective.
    virtual bool mend(std::int64_t /*n*/) { return false; }
    /// Returns a sentence about repeated steps for the end of the run; empty if there were none.
    virtual std::string note_of_sweeps() const { return ""; }
    /// Adds one projection sweep from now on if `watch` says that one is due and the limit is not
    /// reached. Returns true if one was added.
    bool adapt(SweepWatch& watch, double error, double tolerance);
    /// Projection sweeps per drift; in joint coordinates, corrections of jointed tips and loops per
    /// step.
    virtual int sweeps() const = 0;
    /// Number of parts that every drift is split into.
    virtual int parts() const { return 1; }
    /// Sweeps of the last step, in joint coordinates.
    virtual SweepsAStep solved() const { return {}; }
    /// Returns the counts and lengths of the inner steps of an adaptive run; null for other runs.
    virtual nlohmann::json inner_steps() const;
    /// Saves what a restart needs besides the system's state.
    virtual void save(Checkpoint&) const = 0;
    /// Adds the accelerations that are carried from step to step besides the system's own state.
    virtual void save(OwnState&) const {}
    /// Restores what save() saved, after the system's state was set. Throws InputError. Collective.
    virtual void restore(Checkpoint const&) = 0;
    /// Returns the number of sweeps per step, for the summary.
    virtual nlohmann::json describe() const = 0;
    /// Restores as restore() does, for a run that continues with other settings: how the
    /// checkpoint's run stepped is not kept.
    virtual void branch(Checkpoint const&) = 0;

  protected:
    /// Fraction of the tolerance above which another sweep is due.
    virtual double early() const = 0;
    /// Adds a sweep. Returns false if the limit is reached.
    virtual bool add_sweep() = 0;
};

/// Makes the stepper for the integrator that `dynamics` names. Draws thermal start velocities of
/// chains in absolute coordinates. Collective.
std::unique_ptr<Stepper> make_stepper(ChainSystem&, DynamicsSpec const&);

}  // namespace catena
