// The time of a step on as many ranks as one likes: what the largest of them computes, and the
// messages.
#pragma once

#include "mpi/traffic.hpp"
#include "plan/predictions.hpp"

namespace catena::command {

/// Sweeps of each drift, or corrections of jointed tips, that steps are predicted with; a run
/// chooses its own.
int usual_sweeps(DynamicsSpec const&);
/// 1, 2, 4, ... and `most`.
std::vector<int> numbers_of_ranks(std::int64_t most);

/// What the largest rank computes in a step, on so many ranks each; sets `work` and `steps`.
/// Precondition: dynamics are given.
void predict_steps(Predictions&, plan::Planner&, Scene const&, Axes, std::int64_t most_ranks);

/// Of a step.
struct MessagesOnRanks {
    std::int64_t ranks = 1, hosts = 1;
    int stages = 1;  // of gathers
    Traffic traffic;
    double seconds = 0;
};
/// Adds json["network"]["predicted"] and ["notes"]. Preconditions: `predictions.steps` are of the
/// same ranks, and dynamics are given.
void add_steps(Text&, Json&, Scene const&, std::vector<MessagesOnRanks> const&, Predictions const&);

}  // namespace catena::command
