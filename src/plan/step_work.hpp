// What a rank computes in a step, made up of the parts that a machine is measured by.
#pragma once

#include "plan/choice.hpp"

namespace catena::plan {

/// How often a step does each of them.
struct StepWork {
    // In joint coordinates, loops that move the state not among them.
    int evaluations = 0;  // as one, whose matrices are not kept; the others come beside these
    int kinematics = 0, matrix_sweeps = 0, bias_sweeps = 0;
    // In absolute ones.
    int drifts = 0, closings = 0, noises = 0;

    bool absolute() const { return drifts > 0; }
    double seconds(PhaseSeconds const&) const;
    double seconds(DriftSeconds const&) const;
    bool operator==(StepWork const&) const = default;
};
/// `sweeps`: of each drift, or corrections of jointed tips. Of an adaptive step: of one inner step.
/// Drifts are taken in one part. OpenMM's forces, Fixman's and what refinements look for are not
/// among it. Precondition: the scene has dynamics.
StepWork work_of_step(Scene const&, int sweeps);

struct StepPrediction {
    int ranks = 1;
    std::int64_t bodies = 0;  // of the largest shares
    Arrangement arrangement;  // what `auto` chooses for them, or what the scene asks for
    double seconds = 0;       // not a number: its parts are not measured one by one, or `unusable`
    std::string unusable;     // why the arrangement cannot be used; empty where it can
};
/// Of the largest rank, were every one like that of the planner's machine; no messages.
StepPrediction predict_step(Planner&, Scene const&, Axes, StepWork const&, int ranks);

}  // namespace catena::plan
