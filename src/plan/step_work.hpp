// The work of one step in units of the parts that a machine is measured by.
#pragma once

#include "plan/choice.hpp"

namespace catena::plan {

/// Number of times that a step does each part.
struct StepWork {
    // The first group is for joint coordinates; loops that update the state are not counted.
    /// Whole evaluations, whose matrices are not kept; the following parts are done in addition to
    /// them.
    int evaluations = 0;
    int kinematics = 0, matrix_sweeps = 0, bias_sweeps = 0;
    // The second group is for absolute coordinates.
    int drifts = 0, closings = 0, noises = 0;

    /// True if the step is in absolute coordinates.
    bool absolute() const { return drifts > 0; }
    /// Seconds of the work in joint coordinates.
    double seconds(PhaseSeconds const&) const;
    /// Seconds of the work in absolute coordinates.
    double seconds(DriftSeconds const&) const;
    bool operator==(StepWork const&) const = default;
};
/// Returns the work of a step. `sweeps` is the number of projection sweeps per drift, or of
/// corrections of jointed tips. For an adaptive integrator it is the work of one inner step. Drifts
/// are counted in one part. Forces of OpenMM and of the Fixman potential and the residuals of
/// refinements are not included. Precondition: the scene has dynamics.
StepWork work_of_step(Scene const&, int sweeps);

/// Predicted computing time of a step on a number of ranks.
struct StepPrediction {
    int ranks = 1;
    /// Number of bodies of the largest shares.
    std::int64_t bodies = 0;
    /// Arrangement that `auto` chooses on these ranks, or that the scene names.
    Arrangement arrangement;
    /// NaN if the parts are not measured separately or the arrangement is `unusable`.
    double seconds = 0;
    /// Reason why the arrangement cannot be used; empty if it can.
    std::string unusable;
};
/// Predicts the largest rank's computing time of a step if every rank were like the planner's
/// machine. Messages are not included.
StepPrediction predict_step(Planner&, Scene const&, Axes, StepWork const&, int ranks);

}  // namespace catena::plan
