// Further sweeps of a drift that left its joints open: the number learnt before is a start, not a
// verdict.
#pragma once

#include <functional>
#include <string>

#include "error.hpp"

namespace catena {

/// When sweeps go on and where they end. All ranks see the same errors, so that they do the same.
struct Closing {
    double tolerance = 1e-10;  // sweeps go on where the error exceeds it
    double enough = 1e-12;     // they end below that, or where rounding is all that is left
    int most = 30;             // sweeps of a drift in all, or the few that tell rounding
    double rounding = 1e-7;    // the most that coordinates' rounding leaves of an error

    /// Calls `sweep` while `error()` asks for it, after `done` sweeps. Returns the number of calls.
    /// Throws ComputationError where the joints stay open after `most` sweeps or come apart.
    int close(int done, std::function<double()> const& error,
              std::function<void()> const& sweep) const;
};

/// Chains in absolute coordinates (AbsoluteDynamics) as ClosedSteps and
/// ConstrainedIntegrator::step_closing() see them.
class ClosingDrifts {
  public:
    virtual ~ClosingDrifts() = default;
    /// As AbsoluteDynamics::drift(), with further sweeps where `closing` asks for them. Returns how
    /// many these were. Collective.
    virtual int drift_closing(double h, int sweeps, Closing const& closing) = 0;
    /// AbsoluteDynamics::constraint_error() of this rank's joints, after step(). Collective,
    /// without an agreement of the ranks.
    virtual double own_error() = 0;
    /// own_error(), or 0 where it is known to be no more than `tolerance`, which takes less time to
    /// find out. Collective, as own_error().
    virtual double own_error_beyond(double tolerance) = 0;
    /// AbsoluteDynamics::constraint_error() whatever became of matrices: where these are lost on
    /// one rank, all ranks come back. Collective.
    virtual double agreed_error() = 0;
    /// What is wrong with matrices on this rank since the state was set last; empty: nothing.
    virtual std::string trouble() = 0;
};

/// What a rank finds wrong within a step, kept until all ranks look: thrown at once it would leave
/// the others waiting, and no step could be taken again.
class DeferredError {
  public:
    template <class Action>
    void hold(Action const& action) {
        try {
            action();
        } catch (ComputationError const& error) {
            if (text_.empty()) text_ = error.what();
        }
    }
    void check() const {
        if (!text_.empty()) throw ComputationError(text_);
    }
    std::string const& text() const { return text_; }
    void forget() { text_.clear(); }

  private:
    std::string text_;
};

}  // namespace catena
