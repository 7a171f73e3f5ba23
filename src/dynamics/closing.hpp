// Further sweeps of a drift whose joints are still open. The number of sweeps that the integrator
// has learnt is only a starting value.
#pragma once

#include <functional>
#include <string>

#include "error.hpp"

namespace catena {

/// Rules for further sweeps: when to add them and when to stop. All ranks see the same errors and
/// therefore decide alike.
struct Closing {
    /// Sweeps are added if the error (AbsoluteDynamics::constraint_error()) exceeds this.
    double tolerance = 1e-10;
    /// Sweeps stop below this, or when only rounding is left.
    double enough = 1e-12;
    /// Largest number of sweeps of one drift. The few further sweeps that detect rounding are
    /// always permitted.
    int most = 30;
    /// Largest error that rounding of coordinates may explain.
    double rounding = 1e-7;

    /// Calls sweep() while error() requires it; `done` sweeps were made before. Returns the number
    /// of calls. Throws ClosingFailure (a ComputationError) if the joints stay open after `most`
    /// sweeps or the error is not finite.
    int close(int done, std::function<double()> const& error,
              std::function<void()> const& sweep) const;
};

/// Returns "error 3e-08" for messages, or that positions are no longer finite.
std::string closing_error(double error);

/// Interface of chains in absolute coordinates (AbsoluteDynamics) for ClosedSteps and
/// ConstrainedIntegrator::step_closing().
class ClosingDrifts {
  public:
    virtual ~ClosingDrifts() = default;
    /// Drift as AbsoluteDynamics::drift(), with further sweeps as `closing` requires. Returns the
    /// number of further sweeps. Collective.
    virtual int drift_closing(double h, int sweeps, Closing const& closing) = 0;
    /// Constraint error of this rank's joints after step() (AbsoluteDynamics::constraint_error()).
    /// Collective for the exchange of neighbours' ends, but not reduced over ranks.
    virtual double own_error() = 0;
    /// Returns own_error(), or 0 if that is known to be at most `tolerance`, which takes less time
    /// to establish. Collective like own_error().
    virtual double own_error_beyond(double tolerance) = 0;
    /// Constraint error over all ranks, even after a pivot failure. If matrices are invalid on one
    /// rank, the call still returns on all ranks. Collective.
    virtual double agreed_error() = 0;
    /// Text of a pivot failure on this rank since the state was last set; empty if there was none.
    virtual std::string trouble() = 0;
};

/// Keeps an error that one rank finds within a step until all ranks check. If it were thrown at
/// once, the other ranks would wait forever, and the step could not be repeated.
class DeferredError {
  public:
    /// Runs `action` and keeps its ComputationError, unless there is an earlier one.
    template <class Action>
    void hold(Action const& action) {
        try {
            action();
        } catch (ComputationError const& error) {
            if (text_.empty()) text_ = error.what();
        }
    }
    /// Throws the kept error, if any.
    void check() const {
        if (!text_.empty()) throw ComputationError(text_);
    }
    std::string const& text() const { return text_; }
    void forget() { text_.clear(); }

  private:
    std::string text_;
};

}  // namespace catena
