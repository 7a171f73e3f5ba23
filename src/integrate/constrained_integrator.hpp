// RATTLE (constant energy; Andersen 1983) and g-BAOAB (Langevin; Leimkuhler & Matthews, Proc. R.
// Soc. A 472, 20160138, 2016) for chains in absolute coordinates. There is one force evaluation per
// step, and every projection is a bias sweep.
//
// Neighbouring projections are combined: P (P v + h f) = P (v + h f). The half kicks that end one
// step and begin the next are therefore one kick. Between steps, velocities are those before this
// kick. `pending` is the part of a kick that is due, in steps (1/2 at the very start).
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/closing.hpp"

namespace catena {

/// Returns the interface for further sweeps of a group's drifts, which every AbsoluteDynamics
/// implements.
ClosingDrifts& closing_drifts_of(AbsoluteDynamics&);

/// Parameters of the integrator, in the scene's units.
struct ConstrainedScheme {
    Integrator kind = Integrator::rattle;
    // Time step, friction (1/time), and Boltzmann constant times temperature.
    double step = 0, friction = 0, kt = 0;
    // seed of the noise
    std::uint64_t seed = 0;
    // largest relative constraint violation
    double tolerance = 1e-10;
};

/// RATTLE or g-BAOAB on all groups in absolute coordinates.
class ConstrainedIntegrator {
  public:
    ConstrainedIntegrator(ConstrainedScheme const&, std::vector<AbsoluteDynamics*> const&);

    /// Advances from x_n to x_n+1. Precondition: configuration, matrices and forces are ready at
    /// x_n. At x_n+1 only the configuration is ready. `n` counts steps from 0. Collective.
    void step(std::int64_t n);
    /// Advances as step() does, with further sweeps in every drift that leaves joints open
    /// (Closing). Returns the largest number of further sweeps of a drift. Collective.
    int step_closing(std::int64_t n, double rounding);
    /// A state of this rank that can be restored.
    struct Kept {
        std::vector<std::vector<StateArray>> state;
        double pending = 0;
    };
    /// Copies the present state.
    Kept keep() const;
    /// Restores a state. The configuration is then ready, matrices and forces are not.
    void put_back(Kept const&);
    /// Computes the velocities at x_n that observers use, with both half kicks at their places.
    /// They become the observed state of the dynamics. To be called before step(). Collective.
    void observe();
    /// Chooses the number of quasi-Newton sweeps per drift from now on. It is the smallest that
    /// reaches `early` * `tolerance`, or rounding, from the present state. Under a thermostat it
    /// must suffice from thermal velocities too.
    /// Precondition: configuration, matrices and forces are ready; the state is restored. Throws
    /// ComputationError if 30 sweeps do not suffice. Collective.
    void choose_sweeps();

    static constexpr int most_sweeps = 30, most_parts = 64;
    /// Fraction of the tolerance. Sweeps are chosen so that the violation is below it; above it
    /// another sweep is due.
    static constexpr double early = 0.01;
    /// Quasi-Newton sweeps per drift; 0 before choose_sweeps().
    int sweeps() const { return sweeps_; }
    void set_sweeps(int sweeps) { sweeps_ = sweeps; }
    /// Part of a kick that is due, in steps.
    double pending() const { return pending_; }
    void set_pending(double pending) { pending_ = pending; }
    /// Number of parts that each drift is split into, so that a few sweeps close its joints. It
    /// exceeds 1 only for implicit joints, whose steps are long.
    int parts() const { return parts_; }
    void set_parts(int parts) { parts_ = parts; }
    /// Number of bias sweeps of one time step.
    int bias_sweeps_a_step() const { return drifts() * (1 + sweeps_); }
    /// Number of matrix sweeps of one time step.
    int matrix_sweeps_a_step() const { return drifts(); }

  private:
    /// Returns the parameters of step n.
    ConstrainedStep step_of(std::int64_t n) const;
    /// Number of drifts per step.
    int drifts() const { return (is_langevin(scheme_.kind) ? 2 : 1) * parts_; }
    /// Does the first drift of a step for choose_sweeps().
    void begin_trial(AbsoluteDynamics&, int sweeps, bool thermal) const;
    /// Sets the number of sweeps if at most `most` suffice. Returns false otherwise.
    bool choose_sweeps(int most, bool thermal);
    ConstrainedScheme scheme_;
    std::vector<AbsoluteDynamics*> groups_;
    int sweeps_ = 0, parts_ = 1;
    // last_error_: violation after the last trial
    double pending_ = 0.5, last_error_ = 0;
};

}  // namespace catena
