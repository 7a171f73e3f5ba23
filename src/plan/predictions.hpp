// Predicted times of a scene's evaluation, as `catena plan` prints them.
#pragma once

#include "console/outcome.hpp"
#include "console/text.hpp"
#include "plan/step_work.hpp"

namespace catena::command {

/// Largest sample chain in bodies (Planner) that represents all longer ones: caches are full and
/// threads and GPUs busy at this size.
inline constexpr std::int64_t largest_sample = 262144;

/// The predictions for one scene on this rank's machine.
struct Predictions {
    plan::Choice choice;
    std::vector<plan::Prediction> all;
    /// Cuts of the pairwise tree; empty if there is no GPU.
    std::optional<plan::LevelPlan> levels;
    std::string no_gpu;
    /// Bytes that a rank's GPU would need.
    double gpu_memory = 0;
    /// Work of a step, if steps are predicted.
    plan::StepWork work;
    /// Steps on 1, 2, 4, ... ranks.
    std::vector<plan::StepPrediction> steps;
    std::string machine;
};
/// Predicts the scene on every arrangement of this rank's planner and chooses one.
Predictions predict(plan::Planner&, Scene const&, Axes, int ranks);

/// Returns the prediction of an arrangement; nullptr if there is none.
plan::Prediction const* prediction_of(Predictions const&, plan::Arrangement const&);

/// Returns a time as the cell of a table; "-" for an unknown time.
std::string cell(double seconds);
/// Adds a table of all phases on every arrangement and, if there is a GPU, one of all levels.
void add_predictions(Text&, Json&, Predictions const&);
/// Adds the predicted and the measured times of the chosen arrangement.
void add_measured(Text&, Json&, Predictions const&, plan::PhaseSeconds const& measured);

}  // namespace catena::command
