// The operators of which integrators in joint coordinates consist, as plain data. JointDynamics
// applies them; src/integrate/joint_program.hpp puts them together.
#pragma once

#include <cstdint>

#include "dynamics/constrained_step.hpp"

namespace catena {

/// Effect of an operator on the state of all bodies.
enum class JointOperator : std::uint8_t {
    /// Computes accelerations at the current state; matrices are assembled.
    evaluate,
    /// Computes accelerations with the current velocities, but with the coordinates, forces on
    /// beads and matrices of the last `evaluate`.
    evaluate_again,
    /// Assembles the matrices at the last updated configuration, as part of an evaluation.
    assemble,
    /// Computes the rates of the last solution (JointDynamics::rates()).
    set_rates,
    /// Keeps the accelerations for `kick_saved`, `kick_mean` and `drift_saved`, also in the next
    /// step.
    save,
    /// Sets velocities to those before the last drift plus the accelerations times the duration.
    kick,
    /// Adds the saved accelerations times the duration to the current velocities.
    kick_saved,
    /// Sets velocities to those before the last drift plus the mean of the saved and the current
    /// accelerations times the duration. Saves the current ones.
    kick_mean,
    /// Advances coordinates at the current velocities.
    drift,
    /// Advances coordinates with the saved accelerations as well, and velocities by a first guess.
    drift_saved,
    /// Replaces part of the velocities by random ones (Thermostat).
    noise,
    /// Stage of an explicit Runge-Kutta scheme that keeps one weighted sum of rates.
    accumulate,
    /// Stage of an embedded pair (JointOperation::stage). The start of the step is kept, so that it
    /// can be repeated.
    embedded_stage,
    /// Newton step that closes jointed tips and loops. The correction is the smallest in the metric
    /// of the masses. Precondition: there are some.
    project,
    /// Counterpart of `project` for the velocities of jointed tips and loops.
    project_velocities
};

/// A stage of an embedded Runge-Kutta pair: the rates of stages 0 to `number`, each with a weight,
/// lead from the step's start to the next state. Stage 0 has the saved rates. Lengths of time are
/// in ps.
struct EmbeddedStage {
    static constexpr int stages = 6;
    int number = 0;
    /// True for the first stage of a step that is repeated from its start, whose rates are known.
    bool again = false;
    double weight[stages] = {};
    double time = 0;  // Time of the resulting state.
};
/// Weights of the difference of the pair's two solutions; the last one belongs to the rates after
/// the step.
struct EmbeddedDifference {
    double weight[EmbeddedStage::stages + 1] = {};
};

/// One operator of a step. Durations are the step's length divided by a number.
struct JointOperation {
    JointOperator what = JointOperator::evaluate;
    /// Duration: step / divisor. Of `accumulate`: the weight of the rates in the sum.
    double divisor = 1;
    /// For `accumulate`: the next stage's state is the start's plus step / next times the rates.
    double next = 1;
    /// For `accumulate`: the first stage sets the sum, the last one makes it the state.
    bool first = false, last = false;
    /// For `noise`: the thermostat, and the step that keys the noise.
    Thermostat thermostat = {};
    std::uint64_t number = 0;
    /// Parameters of `embedded_stage`.
    EmbeddedStage stage = {};
};

}  // namespace catena
