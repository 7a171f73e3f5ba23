// Predicts the time of a step on any number of ranks: the computing of the largest rank, and the
// messages.
#pragma once

#include "mpi/traffic.hpp"
#include "plan/predictions.hpp"

namespace catena::command {

/// Number of projection sweeps per drift, or of corrections of jointed tips, that predictions
/// assume. A run chooses its own number.
int usual_sweeps(DynamicsSpec const&);
/// Returns 1, 2, 4, ... and `most`.
std::vector<int> numbers_of_ranks(std::int64_t most);

/// Predicts what the largest rank computes in a step on 1, 2, 4, ... and `most_ranks` ranks; sets
/// `work` and `steps`. Precondition: the scene has dynamics.
void predict_steps(Predictions&, plan::Planner&, Scene const&, Axes, std::int64_t most_ranks);

/// Messages of one step on a number of ranks.
struct MessagesOnRanks {
    std::int64_t ranks = 1, hosts = 1;
    /// Number of stages of a gather: 1, or 2 if hosts gather first.
    int stages = 1;
    Traffic traffic;
    double seconds = 0;
};
/// Adds json["network"]["predicted"] and ["notes"] and their text. Preconditions:
/// `predictions.steps` are for the same numbers of ranks, and the scene has dynamics.
void add_steps(Text&, Json&, Scene const&, std::vector<MessagesOnRanks> const&, Predictions const&);

}  // namespace catena::command
