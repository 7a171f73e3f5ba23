// Agreement of all ranks to stop a run after the same step. Any rank may be asked to stop at any
// moment.
#pragma once

#include <cstdint>
#include <functional>

#include "mpi/communicator.hpp"

namespace catena {

/// Periodic test, by all ranks together, whether one of them was asked to stop.
class StopAgreement {
  public:
    /// Function that is called on every rank: 0 to continue, else a reason to stop, such as a
    /// signal's number. An empty function, on every rank then, means a run that cannot be stopped.
    using Wish = std::function<int()>;
    /// `first_step`: step of the first test.
    StopAgreement(Communicator const&, Wish, std::int64_t first_step);

    /// Returns the reason why all ranks stop at step n, or 0. The ranks test together about ten
    /// times a second, at steps that they agreed on in the preceding test. No messages are sent in
    /// between. Collective, for consecutive steps.
    int reason_at(std::int64_t n);
    /// Returns the number of tests so far. A test costs one round of messages.
    std::int64_t looks() const { return looks_; }

  private:
    Communicator const& communicator_;
    Wish wish_;
    std::int64_t looked_, next_,
        looks_ = 0;     // step of the last and of the next test; number of tests
    double looked_at_;  // time of the last test, s
};

}  // namespace catena
