// Predicted times of a scene's evaluation, as `catena plan` shows them.
#pragma once

#include "console/outcome.hpp"
#include "console/text.hpp"
#include "plan/step_work.hpp"

namespace catena::command {

/// Chains of so many bodies (Planner) stand for all larger ones: caches are full by then, threads
/// and GPUs busy.
inline constexpr std::int64_t largest_sample = 262144;

struct Predictions {
    plan::Choice choice;
    std::vector<plan::Prediction> all;
    std::optional<plan::LevelPlan> levels;  // where there is a GPU
    std::string no_gpu;
    double gpu_memory = 0;                    // bytes that a rank's GPU would need
    plan::StepWork work;                      // of a step, where steps are asked for
    std::vector<plan::StepPrediction> steps;  // on one rank, two, four, ...
    std::string machine;
};
/// What this rank's planner says of the scene, and what it chooses.
Predictions predict(plan::Planner&, Scene const&, Axes, int ranks);

/// The arrangement's prediction; nullptr: none was made.
plan::Prediction const* prediction_of(Predictions const&, plan::Arrangement const&);

/// Phase by phase on every arrangement, and level by level where the tree may be cut.
void add_predictions(Text&, Json&, Predictions const&);
/// Beside what the chosen arrangement took.
void add_measured(Text&, Json&, Predictions const&, plan::PhaseSeconds const& measured);

}  // namespace catena::command
