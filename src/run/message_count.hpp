// Messages of a run's steps, counted by the communicator and predicted from the partition.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "integrate/stepper.hpp"
#include "run/step_messages.hpp"

namespace catena {

/// Sums over the steps that count. Messages that supply OpenMM are left out, for StepMessages does
/// not predict them.
class MessageCount {
  public:
    MessageCount(Scene const&, Communicator const&, ChainSystem const&);
    /// Returns the messages of this rank so far.
    Traffic so_far() const;
    /// Adds a step's messages and their prediction.
    void add(Traffic const& of_step, Stepper const&);
    /// Returns {"counted", "predicted", "ranks_that_differ"} with means per step; null if no step
    /// counted. Collective.
    nlohmann::json json() const;

  private:
    Communicator const& communicator_;
    ChainSystem const& system_;
    std::vector<StepMessages> messages_;  // one per group
    Traffic counted_, predicted_;         // sums over `steps_`, this rank
    std::int64_t steps_ = 0;
};

}  // namespace catena
