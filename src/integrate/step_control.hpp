// How long the inner steps of an adaptive run are.
#pragma once

#include <cstdint>

namespace catena {

/// A PI controller (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I, II.4;
/// Gustafsson, ACM TOMS 17, 533, 1991) for errors of fifth order: the next step is the last one's
/// times 0.9 e^(-5/32) f^(1/16), at least a fifth and at most five times it; e, f: the error over
/// what is allowed, of this step and of the one before. Only square roots are taken: these round
/// the same everywhere.
class StepControl {
  public:
    /// Of the next run, and of a restart.
    struct State {
        double length = 0;    // proposed
        double previous = 1;  // f
    };
    /// Of accepted steps, but for `rejected`.
    struct Counts {
        std::int64_t taken = 0, rejected = 0;
        double shortest = 0, longest = 0;
    };

    /// `longest`: of a step.
    explicit StepControl(double longest) : longest_(longest), state_{longest} {}
    /// Of the next step where `left` is left to go: the rest in equal steps, as few as may be.
    double length(double left) const;
    /// What the error of a step of this length says about it, and about the next one.
    bool accepts(double length, double error);

    State const& state() const { return state_; }
    void restore(State const& state) { state_ = state; }
    Counts const& counts() const { return counts_; }

  private:
    double longest_;
    State state_;
    bool after_rejection_ = false;
    Counts counts_;
};

}  // namespace catena
