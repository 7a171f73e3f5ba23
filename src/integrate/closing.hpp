// Further sweeps of a drift that left its joints open: the number learnt before is a start, not a verdict.
#pragma once

#include <functional>

namespace catena {

/// When sweeps go on and where they end. All ranks see the same errors, so that they do the same.
struct Closing {
    double tolerance = 1e-10;  // sweeps go on where the error exceeds it
    double enough = 1e-12;     // they end below that, or where rounding is all that is left
    int most = 30;             // sweeps of a drift in all

    /// Calls `sweep` while `error()` asks for it, after `done` sweeps. Returns the number of calls. Throws ComputationError where the
    /// joints stay open after `most` sweeps or come apart.
    int close(int done, std::function<double()> const& error, std::function<void()> const& sweep) const;
};

/// Chains in absolute coordinates (AbsoluteDynamics) as ClosedSteps and ConstrainedIntegrator::step_closing() see them.
class ClosingDrifts {
  public:
    virtual ~ClosingDrifts() = default;
    /// As AbsoluteDynamics::drift(), with further sweeps where `closing` asks for them. Returns how many these were. Collective.
    virtual int drift_closing(double h, int sweeps, Closing const& closing) = 0;
    /// AbsoluteDynamics::constraint_error() of this rank's joints, after step(). Collective, without an agreement of the ranks.
    virtual double own_error() = 0;
};

}  // namespace catena
