// RATTLE (constant energy; Andersen 1983) and g-BAOAB (Langevin; Leimkuhler & Matthews, Proc. R.
// Soc. A 472, 20160138, 2016) over chains in absolute coordinates: one force evaluation a step,
// every projection a bias sweep.
//
// Neighbouring projections are combined: P (P v + h f) = P (v + h f). So the half kicks that end
// one step and begin the next are one kick, and between steps velocities stand before it: `pending`
// says how much of a kick is due (1/2 at the very start).
#pragma once

#include <cstdint>
#include <vector>

#include "dynamics/absolute_dynamics.hpp"
#include "dynamics/closing.hpp"

namespace catena {

/// A group's drifts that go on; every one in absolute coordinates has them.
ClosingDrifts& closing_drifts_of(AbsoluteDynamics&);

struct ConstrainedScheme {
    Integrator kind = Integrator::rattle;
    double step = 0, friction = 0, kt = 0;
    std::uint64_t seed = 0;
    double tolerance = 1e-10;
};

class ConstrainedIntegrator {
  public:
    ConstrainedIntegrator(ConstrainedScheme const&, std::vector<AbsoluteDynamics*> const&);

    /// From x_n, where configuration, matrices and forces are ready, to x_n+1, where the
    /// configuration is. `n` counts steps from 0.
    void step(std::int64_t n);
    /// The same with further sweeps in every drift that leaves joints open (Closing). Returns those
    /// of the drift that took most.
    int step_closing(std::int64_t n, double rounding);
    /// The state of now, on this rank, and back to it; configuration is then ready, matrices and
    /// forces are not.
    struct Kept {
        std::vector<std::vector<StateArray>> state;
        double pending = 0;
    };
    Kept keep() const;
    void put_back(Kept const&);
    /// Velocities at x_n as an observer sees them (both half kicks in their places), into the
    /// dynamics' observed state. Before step().
    void observe();
    /// Quasi-Newton sweeps a drift makes from now on: the fewest that reach `early` * `tolerance`,
    /// or rounding, from the present state and, under a thermostat, from thermal velocities.
    /// Configuration, matrices and forces must be ready; the state is put back. Throws
    /// ComputationError when 30 do not suffice.
    void choose_sweeps();

    static constexpr int most_sweeps = 30, most_parts = 64;
    /// Of the tolerance: so many sweeps are chosen that the error is below that, and above it
    /// another one is due.
    static constexpr double early = 0.01;
    int sweeps() const { return sweeps_; }
    void set_sweeps(int sweeps) { sweeps_ = sweeps; }
    double pending() const { return pending_; }
    void set_pending(double pending) { pending_ = pending; }
    /// Parts that each drift is taken in, so that a few sweeps close its joints: with implicit
    /// joints, whose steps are long; else one.
    int parts() const { return parts_; }
    void set_parts(int parts) { parts_ = parts; }
    /// Bias sweeps and matrix sweeps of one step.
    int bias_sweeps_a_step() const { return drifts() * (1 + sweeps_); }
    int matrix_sweeps_a_step() const { return drifts(); }

  private:
    ConstrainedStep step_of(std::int64_t n) const;
    int drifts() const { return (is_langevin(scheme_.kind) ? 2 : 1) * parts_; }
    void begin_trial(AbsoluteDynamics&, int sweeps, bool thermal) const;
    bool choose_sweeps(int most, bool thermal);
    ConstrainedScheme scheme_;
    std::vector<AbsoluteDynamics*> groups_;
    int sweeps_ = 0, parts_ = 1;
    double pending_ = 0.5, last_error_ = 0;
};

}  // namespace catena
