// Whether a run is to stop before its last step: any rank may be asked, at any moment; all of them
// stop after the same step.
#pragma once

#include <cstdint>
#include <functional>

#include "mpi/communicator.hpp"

namespace catena {

class StopAgreement {
  public:
    /// Asked on every rank: 0 to go on, else why not, such as a signal's number. Empty (then on
    /// every rank): a run that cannot be stopped.
    using Wish = std::function<int()>;
    StopAgreement(Communicator const&, Wish, std::int64_t first_step);

    /// Why all ranks stop at step n, 0 where they go on. The ranks look together about ten times a
    /// second, at steps that they agreed on when they last looked: between these nothing is sent.
    /// Collective, for every step in turn.
    int reason_at(std::int64_t n);
    /// How often they looked: one message round each.
    std::int64_t looks() const { return looks_; }

  private:
    Communicator const& communicator_;
    Wish wish_;
    std::int64_t looked_, next_, looks_ = 0;
    double looked_at_;
};

}  // namespace catena
