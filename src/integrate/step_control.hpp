// StepControl: lengths of the inner steps of an adaptive run.
#pragma once

#include <cstdint>

namespace catena {

/// A PI controller (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, II.4;
/// Gustafsson, ACM TOMS 17, 533, 1991) for errors of fifth order.
/// The next step is 0.9 e^(-5/32) f^(1/16) times the last one, at least a fifth and at most five
/// times it. Here e and f are the errors, divided by the allowed error, of this step and of the one
/// before. Only square roots are used, because these round identically on all machines.
class StepControl {
  public:
    /// State that the next time step, and a restart, continue with.
    struct State {
        // Proposed length of the next inner step.
        double length = 0;
        double previous = 1;  // f of the formula above
    };
    /// Counts and extreme lengths of the accepted steps, and count of the rejected ones.
    struct Counts {
        std::int64_t taken = 0, rejected = 0;
        double shortest = 0, longest = 0;
    };

    /// `longest`: largest length of a step.
    explicit StepControl(double longest) : longest_(longest), state_{longest} {}
    /// Returns the length of the next step if `left` remains. The remainder is divided into equal
    /// steps, as few as possible.
    double length(double left) const;
    /// Returns true if a step of this length with this error (divided by the allowed one) is
    /// accepted. Proposes the length of the next step.
    bool accepts(double length, double error);

    State const& state() const { return state_; }
    void restore(State const& state) { state_ = state; }
    Counts const& counts() const { return counts_; }

  private:
    double longest_;
    State state_;
    // true if the last step was rejected: the next one must not grow
    bool after_rejection_ = false;
    Counts counts_;
};

}  // namespace catena
